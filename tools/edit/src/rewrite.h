#pragma once

#include <bendy/edit/edit.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/chunk_writer.h>
#include <bendy/format/document.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

namespace bendy::edit {

/// A whole file, checked as by `bendy validate`, and read.
struct Source {
    ChunkTree tree;
    Document document;
};

Result<Source, Problem> open_source(Bytes file);

/// Returns the names of joints, clips, ..., as they are in the file.
template <class Things>
std::vector<std::string_view> names_of(const Things& things) {
    std::vector<std::string_view> names;
    names.reserve(things.size());
    for (const auto& thing : things) names.push_back(thing.name);
    return names;
}

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
    /// The same for a part of the payload, from `at` on; bytes beyond its end are left out.
    void overwrite(std::uint32_t number, std::size_t at, Bytes bytes);
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

/// The same, encoded: with this codec if that makes it smaller and is exactly reversible, otherwise with zstd,
/// otherwise raw.
Buffer encode_leaf(FourCC id, std::uint16_t flags, Codec codec, std::uint16_t head, std::uint16_t stride,
                   Bytes payload);

/// Gives a container's leaf this payload: replaces it, encoded as before, or adds one at the end, with zstd; removes it
/// if the payload is empty.
void put_leaf(const ChunkTree& tree, std::uint32_t container, FourCC id, Bytes payload, Rewrite& rewrite);

/// Returns the file with its changes and with the counts in VERS updated; a problem if it would not be valid.
Edited finish(const Rewrite& rewrite);

}  // namespace bendy::edit
