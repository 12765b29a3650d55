#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/chunk_writer.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace bendy::edit {

using Buffer = std::vector<std::byte>;

template <class T>
void append(Buffer& payload, const T& value) {
    const Bytes bytes = bytes_of(value);
    payload.insert(payload.end(), bytes.begin(), bytes.end());
}

/// A file with changes: chunks that go, leaves with another payload, chunks that are added. What is not touched is
/// copied byte for byte. Chunks are called by their numbers in the tree, which must outlive this.
class Rewrite {
public:
    explicit Rewrite(const ChunkTree& tree);

    /// The chunk goes with all that is in it, and with all other changes to it.
    void remove(std::uint32_t number);
    /// The leaf means this from now on; it is encoded as it was, if it was and can be. No change if it meant this
    /// before.
    void replace(std::uint32_t number, Bytes payload);
    /// Another chunk, header and all, takes the place.
    void replace_whole(std::uint32_t number, Buffer chunk);
    /// A whole chunk right behind this one, in the same parent; behind those that have been put there before.
    void insert_after(std::uint32_t number, Buffer chunk);
    /// A whole chunk at the start of a container.
    void prepend(std::uint32_t container, Buffer chunk);
    /// A whole chunk at the end of a container.
    void append(std::uint32_t container, Buffer chunk);

    [[nodiscard]] bool is_removed(std::uint32_t number) const { return state_[number] == State::removed; }
    /// The container with its changes, header and all: of 0, the file.
    [[nodiscard]] Buffer write(std::uint32_t root = 0) const;

private:
    enum class State : std::uint8_t { as_it_was, touched, removed };

    /// The containers of a change cannot be copied.
    void touch(std::uint32_t number);

    const ChunkTree& tree_;
    std::vector<State> state_;
    std::map<std::uint32_t, Buffer> replaced_;
    std::map<std::uint32_t, std::vector<Buffer>> after_, prepended_, appended_;
};

/// A whole leaf, header and all.
Buffer whole_leaf(FourCC id, Bytes payload, std::uint16_t flags = 0);

}  // namespace bendy::edit
