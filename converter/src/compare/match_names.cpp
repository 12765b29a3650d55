#include "compare/match_names.h"

#include <cstddef>
#include <map>
#include <string_view>
#include <utility>

namespace bendy::converter {
namespace {

/// Under one parent, of one name.
using Key = std::pair<std::uint32_t, std::string_view>;

/// Numbers under each key, in order, and how many are taken.
struct Waiting {
    std::vector<std::uint32_t> numbers;
    std::size_t taken = 0;
};

std::uint32_t take(std::map<Key, Waiting>& waiting, const Key& key) {
    const auto found = waiting.find(key);
    if (found == waiting.end() || found->second.taken == found->second.numbers.size()) return kNone;
    return found->second.numbers[found->second.taken++];
}

}  // namespace

MatchedNames match_names(std::span<const std::string> a, std::span<const std::string> b) {
    MatchedNames matched{std::vector<std::uint32_t>(a.size(), kNone), std::vector<std::uint32_t>(b.size(), kNone)};
    std::map<Key, Waiting> waiting;
    for (std::uint32_t number = 0; number < b.size(); ++number) waiting[{kNone, b[number]}].numbers.push_back(number);
    for (std::uint32_t number = 0; number < a.size(); ++number) {
        const std::uint32_t other = take(waiting, {kNone, a[number]});
        matched.b_of[number] = other;
        if (other != kNone) matched.a_of[other] = number;
    }
    return matched;
}

void match_the_rest(MatchedNames& names) {
    std::size_t other = 0;
    for (std::uint32_t number = 0; number < names.b_of.size(); ++number) {
        if (names.b_of[number] != kNone) continue;
        while (other < names.a_of.size() && names.a_of[other] != kNone) ++other;
        if (other == names.a_of.size()) return;
        names.b_of[number] = static_cast<std::uint32_t>(other);
        names.a_of[other] = number;
    }
}

MatchedNames match_joints(std::span<const Joint> a, std::span<const Joint> b) {
    MatchedNames matched{std::vector<std::uint32_t>(a.size(), kNone), std::vector<std::uint32_t>(b.size(), kNone)};
    std::map<Key, Waiting> waiting;
    for (std::uint32_t number = 0; number < b.size(); ++number)
        waiting[{b[number].parent, b[number].name}].numbers.push_back(number);
    for (std::uint32_t number = 0; number < a.size(); ++number) {
        const std::uint32_t parent = a[number].parent == kNone ? kNone : matched.b_of[a[number].parent];
        if (parent == kNone && a[number].parent != kNone) continue;
        const std::uint32_t other = take(waiting, {parent, a[number].name});
        matched.b_of[number] = other;
        if (other != kNone) matched.a_of[other] = number;
    }
    return matched;
}

}  // namespace bendy::converter
