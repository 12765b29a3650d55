#include "sides.h"

#include "rewrite.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>

namespace bendy::edit {
namespace {

bool is_lower(char c) {
    return c >= 'a' && c <= 'z';
}
bool is_upper(char c) {
    return c >= 'A' && c <= 'Z';
}
bool is_letter(char c) {
    return is_lower(c) || is_upper(c);
}
char lower(char c) {
    return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
}

bool has_word(std::string_view name, std::size_t at, std::string_view word) {
    if (name.size() - at < word.size()) return false;
    for (std::size_t k = 0; k < word.size(); ++k) {
        if (lower(name[at + k]) != word[k]) return false;
    }
    return true;
}

/// Returns true if a word starts here: after something else than a letter, or as in `upperLeft`.
bool starts_word(std::string_view name, std::size_t at) {
    return at == 0 || !is_letter(name[at - 1]) || (is_lower(name[at - 1]) && is_upper(name[at]));
}

/// Returns true if the letter is a word by itself: `arm.L`, `ArmL`, `lArm`, `LArm`.
bool is_single(std::string_view name, std::size_t at) {
    if (!starts_word(name, at)) return false;
    if (at + 1 == name.size() || !is_letter(name[at + 1])) return true;
    if (is_lower(name[at])) return is_upper(name[at + 1]);
    return is_upper(name[at + 1]) && at + 2 < name.size() && is_lower(name[at + 2]);
}

/// Writes a word in the case of the one that it replaces.
std::string in_case_of(std::string_view before, std::string_view word) {
    std::string text(word);
    for (std::size_t k = 0; k < text.size(); ++k) {
        if (is_upper(before[std::min<std::size_t>(k, 1)])) text[k] = static_cast<char>(text[k] - 'a' + 'A');
    }
    return text;
}

struct SideWord {
    std::string_view here, there;
};
constexpr std::array kSideWords{SideWord{"left", "right"}, SideWord{"right", "left"}};
constexpr std::array kSideSigns{SideWord{"左", "右"}, SideWord{"右", "左"}};

/// Returns the text here and what replaces it; nothing if no side is told here.
std::pair<std::size_t, std::string> replaced_at(std::string_view name, std::size_t at) {
    for (const SideWord& sign : kSideSigns) {
        if (name.substr(at).starts_with(sign.here)) return {sign.here.size(), std::string(sign.there)};
    }
    if (!is_letter(name[at])) return {};
    for (const SideWord& word : kSideWords) {
        if (!has_word(name, at, word.here) || !starts_word(name, at)) continue;
        return {word.here.size(), in_case_of(name.substr(at, word.here.size()), word.there)};
    }
    const char letter = lower(name[at]);
    if ((letter != 'l' && letter != 'r') || !is_single(name, at)) return {};
    return {1, in_case_of(std::string{name[at], name[at]}, letter == 'l' ? "r" : "l")};
}

/// Returns for each role the one of the other side; a role in the middle is its own.
Role other_role(Role role) {
    const auto& words = kValueNames<Role>;
    const std::string other = other_side(words.at(static_cast<std::size_t>(role)));
    const auto* const found = std::find(words.begin(), words.end(), other);
    return static_cast<Role>(found - words.begin());
}

/// Returns for each joint the one whose role is that of the other side; its own number if there is none.
void pair_roles(const ObjectView& object, std::vector<std::uint32_t>& other) {
    std::map<std::pair<Role, std::uint16_t>, std::uint32_t> joints;
    for (const RoleRecord& record : object.roles) joints[{static_cast<Role>(record.role), record.place}] = record.joint;
    for (const RoleRecord& record : object.roles) {
        const auto found = joints.find({other_role(static_cast<Role>(record.role)), record.place});
        if (found != joints.end()) other[record.joint] = found->second;
    }
}

/// Returns true for the text of a name that tells the left side.
bool tells_left(std::string_view name) {
    for (std::size_t at = 0; at < name.size(); ++at) {
        const auto [size, text] = replaced_at(name, at);
        if (size != 0) return text == "右" || lower(text.front()) == 'r';
    }
    return false;
}

}  // namespace

std::string other_side(std::string_view name) {
    std::string other;
    for (std::size_t at = 0; at < name.size();) {
        const auto [size, text] = replaced_at(name, at);
        other += size == 0 ? std::string{name[at]} : text;
        at += std::max<std::size_t>(size, 1);
    }
    return other;
}

std::vector<std::uint32_t> pair_sides(std::span<const std::string_view> names) {
    std::map<std::string_view, std::vector<std::uint32_t>> by_name;
    std::vector<std::size_t> places;
    for (std::uint32_t k = 0; k < names.size(); ++k) {
        std::vector<std::uint32_t>& same = by_name[names[k]];
        places.push_back(same.size());
        same.push_back(k);
    }
    std::vector<std::uint32_t> other;
    for (std::uint32_t k = 0; k < names.size(); ++k) {
        const std::string name = other_side(names[k]);
        const auto found = name == names[k] ? by_name.end() : by_name.find(name);
        const bool is_there = found != by_name.end() && places[k] < found->second.size();
        other.push_back(is_there ? found->second[places[k]] : k);
    }
    return other;
}

JointSides pair_joints(const ObjectView& object) {
    const auto names = names_of(object.skeleton.joints);
    const std::size_t count = names.size();
    std::vector<std::uint32_t> by_role(count, kNone);
    pair_roles(object, by_role);
    std::vector<std::uint32_t> wanted = pair_sides(names);
    for (std::uint32_t joint = 0; joint < count; ++joint) {
        if (by_role[joint] == kNone) continue;
        // A pair by name that roles contradict is none.
        const std::uint32_t by_name = wanted[joint];
        if (by_name != by_role[joint] && by_name != joint) wanted[by_name] = by_name;
        wanted[joint] = by_role[joint];
    }
    std::vector<bool> is_left(count);
    for (const RoleRecord& record : object.roles) {
        const auto& word = kValueNames<Role>.at(record.role);
        if (by_role[record.joint] != kNone) is_left[record.joint] = word.starts_with("left");
    }
    JointSides sides;
    sides.is_left.resize(count);
    sides.is_kept.resize(count);
    sides.other.resize(count);
    for (std::uint32_t joint = 0; joint < count; ++joint) sides.other[joint] = joint;
    for (std::uint32_t joint = 0; joint < count; ++joint) {
        const std::uint32_t other = wanted[joint];
        const std::uint32_t parent = object.skeleton.joints[joint].parent;
        const bool is_below = parent != kNone && (sides.other[parent] != parent || sides.is_kept[parent]);
        if (sides.other[joint] != joint) continue;  // the second of a pair
        const std::uint32_t parent_there = object.skeleton.joints[other].parent;
        const bool is_pair =
            other > joint && wanted[other] == joint &&
            (parent == kNone ? parent_there == kNone : sides.other[parent] == parent_there && !sides.is_kept[parent]);
        if (!is_pair) {
            sides.is_kept[joint] = is_below;
            continue;
        }
        sides.other[joint] = other;
        sides.other[other] = joint;
        const bool has_left_role = by_role[joint] != kNone;
        const bool first_is_left = has_left_role ? is_left[joint] : tells_left(names[joint]);
        sides.is_left[first_is_left ? joint : other] = true;
        ++sides.pairs;
    }
    return sides;
}

}  // namespace bendy::edit
