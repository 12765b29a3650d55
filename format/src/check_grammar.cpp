#include <bendy/format/check_grammar.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
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

}  // namespace

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

}  // namespace bendy
