#include "walk_chunks.h"

#include <bendy/format/codec.h>
#include <bendy/format/crc32c.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace bendy {
namespace {

struct RawHeader {
    std::uint32_t id = 0;
    std::uint32_t sum = 0;
    std::uint64_t size_and_flags = 0;
};
static_assert(sizeof(RawHeader) == kChunkHeaderSize);

Chunk read_header(Bytes bytes, std::uint64_t offset) {
    RawHeader raw;
    copy_at(bytes, offset, raw);
    Chunk chunk;
    chunk.id = FourCC(raw.id);
    chunk.sum = raw.sum;
    chunk.offset = offset;
    chunk.size = raw.size_and_flags & kMaxPayload;
    chunk.flags = static_cast<std::uint16_t>(raw.size_and_flags >> 48);
    return chunk;
}

/// Chunks to reserve room for at the start; files with one character rarely hold more.
constexpr std::uint64_t kUsualChunks = 256;

/// Checks a header by itself, regardless of what follows.
Result<void> check_header(const Chunk& chunk) {
    if (!chunk.id.is_readable()) return Error{ErrorCode::kChunkIdNotLetters, chunk.offset};
    if ((chunk.flags & kReservedFlags) != 0) {
        return Error{ErrorCode::kReservedFlags, chunk.offset, static_cast<std::uint64_t>(chunk.flags & kReservedFlags)};
    }
    if (chunk.is_container()) {
        if (chunk.codec() != 0) return Error{ErrorCode::kContainerCodec, chunk.offset, chunk.codec()};
        if (chunk.size % kChunkAlignment != 0) return Error{ErrorCode::kContainerSize, chunk.offset, chunk.size};
    }
    return {};
}

enum class Shape : std::uint8_t { container, leaf };
enum class Times : std::uint8_t { one, optional, many };

struct Rule {
    FourCC id;
    Shape shape;
    std::string_view parents;
    Times times;
};

constexpr Rule kRules[] = {
#define BENDY_CHUNK(id, shape, parents, times, what) {FourCC(#id), Shape::shape, parents, Times::times},
#include <bendy/format/chunk_ids.def>
#undef BENDY_CHUNK
};
constexpr std::size_t kRuleCount = std::size(kRules);

static_assert(kRuleCount <= 64, "sets of rules are the bits of a number");

/// A set of rules; bit k is rule k.
using RuleSet = std::uint64_t;
constexpr RuleSet only(std::size_t rule) {
    return RuleSet{1} << rule;
}

/// The first slot to search for an id.
constexpr std::size_t kSlots = 256;
constexpr std::size_t slot_of(FourCC id) {
    return id.value * 0x9e3779b1u >> 24;
}

/// The rules by id, and which may or must be contained in which; computed at compile time.
struct Grammar {
    std::array<std::uint8_t, kSlots> rule_at{};  // open addressing; kRuleCount: none
    std::array<RuleSet, kRuleCount> may_hold{};  // of each container
    std::array<RuleSet, kRuleCount> must_hold{};
    RuleSet may_repeat = 0;

    constexpr Grammar() {
        rule_at.fill(kRuleCount);
        for (std::size_t rule = 0; rule < kRuleCount; ++rule) {
            if (kRules[rule].times == Times::many) may_repeat |= only(rule);
            std::size_t slot = slot_of(kRules[rule].id);
            while (rule_at[slot] != kRuleCount) slot = (slot + 1) % kSlots;
            rule_at[slot] = static_cast<std::uint8_t>(rule);
        }
        for (std::size_t rule = 0; rule < kRuleCount; ++rule) {
            for (std::size_t parent = 0; parent < kRuleCount; ++parent) {
                const auto letters = kRules[parent].id.letters();
                if (kRules[rule].parents.find(std::string_view(letters.data(), 4)) == std::string_view::npos) continue;
                may_hold[parent] |= only(rule);
                if (kRules[rule].times == Times::one) must_hold[parent] |= only(rule);
            }
        }
    }
};

constexpr Grammar kGrammar;

/// Returns the number of the id's rule, or kRuleCount if this version does not know it.
std::size_t find_rule(FourCC id) {
    for (std::size_t slot = slot_of(id);; slot = (slot + 1) % kSlots) {
        const std::size_t rule = kGrammar.rule_at[slot];
        if (rule == kRuleCount || kRules[rule].id == id) return rule;
    }
}

/// Checks the children of a container whose rule is known, and adds all faults.
void check_children(const ChunkTree& tree, std::uint32_t container, std::size_t container_rule, Faults& faults) {
    RuleSet seen = 0;
    for (const std::uint32_t number : tree.children(container)) {
        const Chunk& chunk = tree[number];
        const std::size_t rule = find_rule(chunk.id);
        if (rule == kRuleCount) {
            if (chunk.is_required()) faults.add({ErrorCode::kRequiredChunkUnknown, chunk.offset});
            continue;
        }
        if ((kGrammar.may_hold[container_rule] & only(rule)) == 0) {
            faults.add({ErrorCode::kChunkMisplaced, chunk.offset});
        } else if ((seen & ~kGrammar.may_repeat & only(rule)) != 0) {
            faults.add({ErrorCode::kChunkRepeated, chunk.offset});
        }
        seen |= only(rule);
        const Shape shape = kRules[rule].shape;
        if (shape == Shape::container && !chunk.is_container()) faults.add({ErrorCode::kNotAContainer, chunk.offset});
        if (shape == Shape::leaf && chunk.is_container()) faults.add({ErrorCode::kNotALeaf, chunk.offset});
    }
    for (RuleSet missing = kGrammar.must_hold[container_rule] & ~seen; missing != 0; missing &= missing - 1) {
        const auto rule = static_cast<std::size_t>(std::countr_zero(missing));
        faults.add({ErrorCode::kChunkMissing, tree[container].offset, kRules[rule].id.value});
    }
}

/// Adds the stored sums of a container's children, in blocks.
std::uint32_t add_children(Bytes payload, std::uint32_t sum) {
    std::array<std::uint32_t, 64> sums;  // NOLINT(*-member-init): only those that are set are used
    std::size_t count = 0;
    for (std::uint64_t at = 0; at < payload.size();) {
        copy_at(payload, at + kChunkSumAt, sums[count++]);
        std::uint64_t child = 0;
        copy_at(payload, at + kChunkSizeAt, child);
        at += kChunkHeaderSize + padded(child & kMaxPayload);
        if (count < sums.size() && at < payload.size()) continue;
        sum = crc32c(std::as_bytes(std::span(sums).first(count)), sum);
        count = 0;
    }
    return sum;
}

}  // namespace

Result<ChunkTree> walk_chunks(Bytes bytes, std::uint64_t most_chunks) {
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % kChunkAlignment != 0)
        return Error{ErrorCode::kUnalignedBuffer};
    if (bytes.size() < kChunkHeaderSize) return Error{ErrorCode::kNotABendyFile};

    Chunk root = read_header(bytes, 0);
    if (root.id != FourCC("HEAD")) return Error{ErrorCode::kNotABendyFile};
    if (const auto good = check_header(root); !good) return good.error();
    if (!root.is_container()) return Error{ErrorCode::kNotAContainer};
    const std::uint64_t available = bytes.size() - kChunkHeaderSize;
    if (root.size > available) return Error{ErrorCode::kTruncated, 0, root.size, available};
    if (root.size < available)
        return Error{ErrorCode::kTrailingBytes, root.size + kChunkHeaderSize, available - root.size};

    std::vector<Chunk> chunks;
    chunks.reserve(std::min<std::uint64_t>(bytes.size() / kChunkHeaderSize, kUsualChunks));
    chunks.push_back(root);
    std::vector<std::uint32_t> open{0};  // the containers around `at`, outermost first
    std::uint64_t at = kChunkHeaderSize;
    while (!open.empty()) {
        const std::uint32_t parent = open.back();
        const std::uint64_t parent_end = chunks[parent].payload_offset() + chunks[parent].size;
        if (at == parent_end) {
            chunks[parent].end = static_cast<std::uint32_t>(chunks.size());
            open.pop_back();
            continue;
        }
        const std::uint64_t left = parent_end - at;  // a multiple of 16, as all sizes so far
        assert(left >= kChunkHeaderSize);
        if (chunks.size() >= most_chunks) return Error{ErrorCode::kTooManyChunks, at, 0, most_chunks};

        Chunk chunk = read_header(bytes, at);
        if (const auto good = check_header(chunk); !good) return good.error();
        const std::uint64_t room = left - kChunkHeaderSize;
        // Containers end on boundaries, so room is a multiple of 16 and a payload that fits has room for its padding.
        if (chunk.size > room) return Error{ErrorCode::kChunkTooLong, at, chunk.size, room};
        chunk.parent = parent;
        at += kChunkHeaderSize;

        const auto number = static_cast<std::uint32_t>(chunks.size());
        chunk.end = number + 1;
        if (chunk.is_container()) {
            if (open.size() >= kMaxDepth) return Error{ErrorCode::kTooDeep, chunk.offset, 0, kMaxDepth};
            open.push_back(number);
        } else {
            const Bytes padding = bytes.subspan(at + chunk.size, padded(chunk.size) - chunk.size);
            if (std::any_of(padding.begin(), padding.end(), [](std::byte b) { return b != std::byte{0}; })) {
                return Error{ErrorCode::kPaddingNotZero, at + chunk.size};
            }
            at += padded(chunk.size);
        }
        chunks.push_back(chunk);
    }
    return ChunkTree(bytes, std::move(chunks));
}

Result<ChunkTree> read_chunk_tree(Bytes bytes) {
    return walk_chunks(bytes, kMaxChunks);
}

bool is_known(FourCC id) {
    return find_rule(id) != kRuleCount;
}

void check_grammar(const ChunkTree& tree, Faults& faults) {
    const auto chunks = tree.chunks();
    for (std::uint32_t number = 0; number < chunks.size();) {
        const Chunk& chunk = chunks[number];
        if (!chunk.is_container()) {
            ++number;
            continue;
        }
        const std::size_t rule = find_rule(chunk.id);
        if (rule == kRuleCount) {
            number = chunk.end;  // reported with its parent
            continue;
        }
        check_children(tree, number, rule, faults);
        ++number;
    }
}

std::uint32_t chunk_sum(Bytes chunk) {
    std::uint64_t size_and_flags = 0;
    copy_at(chunk, kChunkSizeAt, size_and_flags);
    const std::uint64_t size = size_and_flags & kMaxPayload;
    const bool is_container = (size_and_flags >> 48 & kContainerFlag) != 0;

    // The id and the fields after the sum, contiguously.
    std::array<std::byte, sizeof(std::uint32_t) + sizeof size_and_flags> head;
    std::memcpy(head.data(), chunk.data(), sizeof(std::uint32_t));
    std::memcpy(head.data() + sizeof(std::uint32_t), &size_and_flags, sizeof size_and_flags);
    const std::uint32_t sum = crc32c(head);
    const Bytes payload = chunk.subspan(kChunkHeaderSize, size);
    return is_container ? add_children(payload, sum) : crc32c(payload, sum);
}

void check_sums(const ChunkTree& tree, Faults& faults) {
    for (const Chunk& chunk : tree.chunks()) {
        const std::uint32_t sum = chunk_sum(tree.bytes().subspan(chunk.offset));
        if (sum != chunk.sum) faults.add({ErrorCode::kSumMismatch, chunk.offset, sum, chunk.sum});
    }
}

void decode_leaves(ChunkTree& tree) {
    DecodedLeaves decoded;
    std::uint64_t size = 0;
    for (std::uint32_t number = 0; number < tree.chunks().size(); ++number) {
        const Chunk& chunk = tree[number];
        if (chunk.codec() == 0 || !is_known(chunk.id)) continue;
        DecodedLeaf leaf{number, size, 0, std::nullopt};
        CodecHeader header;
        leaf.fault = check_encoded(chunk.codec(), tree.stored(number), header);
        if (leaf.fault) {
            leaf.fault->offset = chunk.offset;
        } else {
            leaf.size = header.size;
            size += padded(header.size);
        }
        decoded.leaves.push_back(leaf);
    }
    if (decoded.leaves.empty()) return;
    decoded.bytes = AlignedBytes(size);
    for (DecodedLeaf& leaf : decoded.leaves) {
        if (leaf.fault) continue;
        const Chunk& chunk = tree[leaf.number];
        const auto out = decoded.bytes.span().subspan(leaf.at, leaf.size);
        if (decode_payload(static_cast<Codec>(chunk.codec()), tree.stored(leaf.number), out)) continue;
        leaf.fault = Error{ErrorCode::kCodecData, chunk.offset, chunk.codec()};
        leaf.size = 0;
    }
    tree.set_decoded(std::move(decoded));
}

}  // namespace bendy
