#include <bendy/format/check_grammar.h>

#include <array>
#include <string_view>

namespace bendy {
namespace {

enum class Shape : std::uint8_t { container, leaf };
enum class Times : std::uint8_t { one, optional, many };

struct Rule {
    FourCC id;
    Shape shape;
    std::string_view parents;
    Times times;
    bool is_reserved;  // a later version's: to this one, unknown
};

constexpr Rule kRules[] = {
#define BENDY_CHUNK(id, shape, parents, times, what) \
    {FourCC(#id), Shape::shape, parents, Times::times, std::string_view(what).ends_with("(reserved)")},
#include <bendy/format/chunk_ids.def>
#undef BENDY_CHUNK
};
constexpr std::size_t kRuleCount = std::size(kRules);

/// Number of the id's rule, or kRuleCount if this version does not know it.
std::size_t find_rule(FourCC id) {
    std::size_t rule = 0;
    while (rule < kRuleCount && !(kRules[rule].id == id)) ++rule;
    return rule < kRuleCount && !kRules[rule].is_reserved ? rule : kRuleCount;
}

bool may_stand_in(const Rule& rule, FourCC parent) {
    const auto letters = parent.letters();
    return rule.parents.find(std::string_view(letters.data(), 4)) != std::string_view::npos;
}

/// Checks a known container's children; returns nothing, faults say it all.
void check_children(const ChunkTree& tree, std::uint32_t container, Faults& faults) {
    std::array<bool, kRuleCount> seen{};
    for (const std::uint32_t number : tree.children(container)) {
        const Chunk& chunk = tree[number];
        const std::size_t index = find_rule(chunk.id);
        if (index == kRuleCount) {
            if (chunk.is_required()) faults.add({ErrorCode::kRequiredChunkUnknown, chunk.offset});
            continue;
        }
        const Rule& rule = kRules[index];
        if (!may_stand_in(rule, tree[container].id)) {
            faults.add({ErrorCode::kChunkMisplaced, chunk.offset});
        } else if (rule.times != Times::many && seen[index]) {
            faults.add({ErrorCode::kChunkRepeated, chunk.offset});
        }
        seen[index] = true;
        if (rule.shape == Shape::container && !chunk.is_container())
            faults.add({ErrorCode::kNotAContainer, chunk.offset});
        if (rule.shape == Shape::leaf && chunk.is_container()) faults.add({ErrorCode::kNotALeaf, chunk.offset});
    }
    for (std::size_t index = 0; index < kRuleCount; ++index) {
        const Rule& rule = kRules[index];
        if (rule.times == Times::one && !seen[index] && may_stand_in(rule, tree[container].id)) {
            faults.add({ErrorCode::kChunkMissing, tree[container].offset, rule.id.value});
        }
    }
}

}  // namespace

bool is_known(FourCC id) {
    return find_rule(id) != kRuleCount;
}

void check_grammar(const ChunkTree& tree, Faults& faults) {
    const auto chunks = tree.chunks();
    for (std::uint32_t number = 0; number < chunks.size();) {
        const Chunk& chunk = chunks[number];
        if (!is_known(chunk.id)) {
            number = chunk.end;  // its parent has said what there is to say of it
            continue;
        }
        if (chunk.is_container()) check_children(tree, number, faults);
        ++number;
    }
}

}  // namespace bendy
