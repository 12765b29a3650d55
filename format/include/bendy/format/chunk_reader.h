#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/chunk.h>
#include <bendy/format/codec.h>
#include <bendy/format/limits.h>
#include <bendy/format/public.h>
#include <bendy/format/result.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// The decoded payload of an encoded leaf, or the reason why it could not be decoded.
struct DecodedLeaf {
    std::uint32_t number = 0;
    std::uint64_t at = 0;  ///< offset in DecodedLeaves::bytes
    std::uint64_t size = 0;
    std::optional<Error> fault;
};

struct DecodedLeaves {
    std::vector<DecodedLeaf> leaves;  ///< by chunk number
    AlignedBytes bytes;               ///< of all leaves, each on a 16-byte boundary
};

/// All chunks of a file, in file order: a parent comes before its children, so the first child of chunk n, if it has
/// one, is n + 1 and its next sibling is chunk(n).end. Refers to the bytes, does not own them.
class ChunkTree {
public:
    /// Iterates over the direct children of a chunk; dereferences to their numbers.
    class ChildIterator {
    public:
        using iterator_category = std::input_iterator_tag;
        using value_type = std::uint32_t;
        using difference_type = std::ptrdiff_t;
        using pointer = const std::uint32_t*;
        using reference = std::uint32_t;

        ChildIterator() = default;
        ChildIterator(const Chunk* chunks, std::uint32_t at) : chunks_(chunks), at_(at) {}
        std::uint32_t operator*() const { return at_; }
        ChildIterator& operator++() {
            at_ = chunks_[at_].end;
            return *this;
        }
        ChildIterator operator++(int) {
            const ChildIterator before = *this;
            ++*this;
            return before;
        }
        friend bool operator==(const ChildIterator& a, const ChildIterator& b) { return a.at_ == b.at_; }

    private:
        const Chunk* chunks_ = nullptr;
        std::uint32_t at_ = 0;
    };
    struct ChildRange {
        ChildIterator first, last;
        [[nodiscard]] ChildIterator begin() const { return first; }
        [[nodiscard]] ChildIterator end() const { return last; }
    };

    ChunkTree() = default;
    ChunkTree(Bytes bytes, std::vector<Chunk> chunks) : bytes_(bytes), chunks_(std::move(chunks)) {}

    [[nodiscard]] Bytes bytes() const { return bytes_; }
    [[nodiscard]] std::span<const Chunk> chunks() const { return chunks_; }
    [[nodiscard]] const Chunk& operator[](std::uint32_t number) const { return chunks_[number]; }

    /// The payload as stored in the file.
    [[nodiscard]] Bytes stored(std::uint32_t number) const {
        const Chunk& chunk = chunks_[number];
        return bytes_.subspan(chunk.payload_offset(), chunk.size);
    }
    /// The payload after decoding, if decode_leaves has been called; otherwise as stored.
    [[nodiscard]] Bytes payload(std::uint32_t number) const {
        const DecodedLeaf* leaf = find_decoded(number);
        return leaf == nullptr ? stored(number) : decoded_.bytes.bytes().subspan(leaf->at, leaf->size);
    }
    /// The reason why `payload` is not the leaf's decoded content, if it is not.
    [[nodiscard]] std::optional<Error> encoding_fault(std::uint32_t number) const {
        const Chunk& chunk = chunks_[number];
        if (chunk.codec() == 0) return std::nullopt;
        const DecodedLeaf* leaf = find_decoded(number);
        if (leaf == nullptr) return Error{ErrorCode::kUnsupportedCodec, chunk.offset, chunk.codec()};
        return leaf->fault;
    }
    void set_decoded(DecodedLeaves decoded) { decoded_ = std::move(decoded); }
    /// Returns the decoded bytes, for an owner of views into them that outlives the tree.
    [[nodiscard]] AlignedBytes take_decoded() && { return std::move(decoded_.bytes); }

    [[nodiscard]] ChildRange children(std::uint32_t number) const {
        const std::uint32_t last = chunks_[number].end;
        return {{chunks_.data(), chunks_[number].is_container() ? number + 1 : last}, {chunks_.data(), last}};
    }
    /// Returns the number of the first direct child with this id, or kNone.
    [[nodiscard]] std::uint32_t find(std::uint32_t number, FourCC id) const {
        for (const std::uint32_t child : children(number)) {
            if (chunks_[child].id == id) return child;
        }
        return kNone;
    }

private:
    [[nodiscard]] const DecodedLeaf* find_decoded(std::uint32_t number) const {
        if (chunks_[number].codec() == 0) return nullptr;
        const auto less = [](const DecodedLeaf& leaf, std::uint32_t wanted) { return leaf.number < wanted; };
        const auto found = std::lower_bound(decoded_.leaves.begin(), decoded_.leaves.end(), number, less);
        return found == decoded_.leaves.end() || found->number != number ? nullptr : &*found;
    }

    Bytes bytes_;
    std::vector<Chunk> chunks_;
    DecodedLeaves decoded_;
};

/// Reads all headers of a file and checks its grammar: every chunk inside its container, sizes, flags, padding, nesting
/// depth. Does not recurse, and allocates about 40 bytes (while growing, up to 120) per chunk header present in the
/// file. `bytes` must start on a 16-byte boundary (mapped files do). Malformed input: returns the first fault, with its
/// offset.
Result<ChunkTree> read_chunk_tree(Bytes bytes);

/// Checks every chunk against the table chunk_ids.def: that a known chunk is in an allowed container, is a leaf or
/// container as required, and occurs as often as allowed. An unknown chunk is skipped with its contents, unless it is
/// marked as required.
void check_grammar(const ChunkTree& tree, Faults& faults);

/// Returns true if this version knows the id.
bool is_known(FourCC id);

// Sums nest. The sum of a leaf is the CRC-32C of its id, its size+flags and its payload; that of a container, of its
// id, its size+flags and its children's stored sums in order. So the root's sum covers the whole file, and any subtree
// can be checked by itself. Sums detect accidental damage, not attacks.

/// Computes the sum that a chunk should have. `chunk` starts at its header, and its sizes have been checked
/// (read_chunk_tree) or have just been written.
std::uint32_t chunk_sum(Bytes chunk);

/// Adds a SUM_MISMATCH for every chunk of the tree whose stored sum is wrong.
void check_sums(const ChunkTree& tree, Faults& faults);

/// Decodes every encoded leaf with a known id, so that ChunkTree::payload returns its content. Makes one allocation for
/// all of them, at most kMaxCodecRatio times the encoded bytes. A leaf that cannot be decoded becomes empty, and
/// ChunkTree::encoding_fault returns the reason.
void decode_leaves(ChunkTree& tree);

}  // namespace bendy
