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

/// A file with changes: chunks that are removed, leaves with a new payload, chunks that are added. Everything else is
/// copied byte for byte. Chunks are identified by their numbers in the tree, which must outlive this.
class Rewrite {
public:
    explicit Rewrite(const ChunkTree& tree);

    /// Removes the chunk with everything in it, and all other changes to it.
    void remove(std::uint32_t number);
    /// Replaces a leaf's decoded payload; it is encoded as before, if it was and can be. No change if the payload is
    /// the same.
    void replace(std::uint32_t number, Bytes payload);
    /// Replaces the whole chunk, including its header.
    void replace_whole(std::uint32_t number, Buffer chunk);
    /// Inserts a whole chunk directly after this one, in the same parent; after those inserted there before.
    void insert_after(std::uint32_t number, Buffer chunk);
    /// Inserts a whole chunk at the start of a container.
    void prepend(std::uint32_t container, Buffer chunk);
    /// Inserts a whole chunk at the end of a container.
    void append(std::uint32_t container, Buffer chunk);

    [[nodiscard]] bool is_removed(std::uint32_t number) const { return state_[number] == State::removed; }
    /// Returns the container with its changes, including its header; for 0, the file.
    [[nodiscard]] Buffer write(std::uint32_t root = 0) const;

private:
    enum class State : std::uint8_t { as_it_was, touched, removed };

    /// Marks the containers of a change: they cannot be copied.
    void touch(std::uint32_t number);

    const ChunkTree& tree_;
    std::vector<State> state_;
    std::map<std::uint32_t, Buffer> replaced_;
    std::map<std::uint32_t, std::vector<Buffer>> after_, prepended_, appended_;
};

/// Returns a whole leaf, including its header.
Buffer whole_leaf(FourCC id, Bytes payload, std::uint16_t flags = 0);

}  // namespace bendy::edit
