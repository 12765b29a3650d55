#include "joint_key.h"

#include <bendy/format/charconv.h>
#include <bendy/format/names.h>
#include <utf8cpp/utf8.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace bendy::converter {
namespace {

constexpr std::string_view kSpecial = "*?[\\";

/// Reads the character at `at` and advances past it. An invalid byte of UTF-8 counts as one character.
char32_t next_character(const char*& at, const char* end) {
    constexpr std::ptrdiff_t kLongest = 4;
    if (utf8::find_invalid(at, at + std::min(kLongest, end - at)) == at) return static_cast<unsigned char>(*at++);
    return utf8::unchecked::next(at);
}

/// Reads a key character by character.
class KeyReader {
public:
    KeyReader(std::string_view text, const std::string& place)
        : at_(text.data()), end_(text.data() + text.size()), place_(place) {}

    [[nodiscard]] bool at_end() const { return at_ == end_; }

    /// The next character; `is_plain` is true if a backslash escapes it.
    char32_t next(bool& is_plain) {
        is_plain = *at_ == '\\';
        if (is_plain && ++at_ == end_) fail(place_, "it ends in a backslash that escapes nothing");
        return next_character(at_, end_);
    }

    /// The characters between [ and ].
    std::u32string next_set() {
        std::u32string characters;
        while (!at_end()) {
            bool is_plain = false;
            const char32_t character = next(is_plain);
            if (character != U']' || is_plain) {
                characters += character;
                continue;
            }
            if (characters.empty()) fail(place_, "it has an empty []");
            std::sort(characters.begin(), characters.end());
            return characters;
        }
        fail(place_, "it has a [ without a ]");
    }

private:
    const char* at_;
    const char* end_;
    const std::string& place_;
};

}  // namespace

std::u32string characters_of(std::string_view text) {
    std::u32string characters;
    const char* const end = text.data() + text.size();
    for (const char* at = text.data(); at != end;) characters += next_character(at, end);
    return characters;
}

bool parse_joint_number(std::string_view text, std::uint64_t& number) {
    if (text.size() < 2 || text.front() != '#') return false;
    const char* end = text.data() + text.size();
    if (!std::all_of(text.begin() + 1, text.end(), [](char c) { return c >= '0' && c <= '9'; })) return false;
    if (from_chars(text.data() + 1, end, number).ec != std::errc()) number = UINT64_MAX;
    return true;
}

std::string_view name_of_key(std::string_view key) {
    return key.starts_with('=') ? key.substr(1) : key;
}

bool means_itself(std::string_view name) {
    std::uint64_t number = 0;
    return !name.starts_with('=') && !parse_joint_number(name, number);
}

JointKey parse_joint_key(std::string_view text, const std::string& place) {
    JointKey key;
    key.name = text;
    if (parse_joint_number(text, key.number)) {
        key.kind = JointKey::Kind::number;
        return key;
    }
    if (text.starts_with('=')) {
        key.name = name_of_key(text);
        return key;
    }
    KeyReader reader(text, place);
    while (!reader.at_end()) {
        bool is_plain = false;
        const char32_t character = reader.next(is_plain);
        JointKey::Step step{JointKey::Step::Kind::one_of, {character}};
        if (!is_plain && character == U'*') step = {JointKey::Step::Kind::any_run, {}};
        if (!is_plain && character == U'?') step = {JointKey::Step::Kind::any_one, {}};
        const bool is_set = !is_plain && character == U'[';
        if (is_set) step.characters = reader.next_set();
        if (is_set || step.kind != JointKey::Step::Kind::one_of) key.kind = JointKey::Kind::glob;
        key.glob.push_back(std::move(step));
    }
    if (key.kind == JointKey::Kind::glob) return key;
    key.glob.clear();
    key.name.clear();
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] == '\\') ++at;  // never the last: next() has checked that
        key.name += text[at];
    }
    return key;
}

bool fits(const std::vector<JointKey::Step>& glob, std::u32string_view name, WorkBudget& budget) {
    using Kind = JointKey::Step::Kind;
    constexpr std::uint64_t kStart = 8;  // a glob that fails at once takes time too
    budget.take(kStart);
    std::size_t step = 0;
    std::size_t at = 0;
    // The index of the last *, and the end of its match: on a mismatch it matches one more character.
    std::size_t run = glob.size();
    std::size_t run_end = 0;
    while (at < name.size()) {
        budget.take(1);
        const bool is_left = step < glob.size();
        if (is_left && glob[step].kind == Kind::any_run) {
            run = step++;
            run_end = at;
        } else if (is_left &&
                   (glob[step].kind == Kind::any_one ||
                    std::binary_search(glob[step].characters.begin(), glob[step].characters.end(), name[at]))) {
            ++step;
            ++at;
        } else if (run != glob.size()) {
            step = run + 1;
            at = ++run_end;
        } else {
            return false;
        }
    }
    while (step < glob.size() && glob[step].kind == Kind::any_run) ++step;
    return step == glob.size();
}

std::string escape_joint_name(std::string_view name) {
    std::string key(means_itself(name) ? "" : "\\");
    for (const char c : name) {
        if (kSpecial.find(c) != std::string_view::npos) key += '\\';
        key += c;
    }
    return key;
}

JointIndex::JointIndex(const Scene& scene) : ends_(scene.joints.size()) {
    for (std::uint32_t joint = 0; joint < size(); ++joint) by_name_[scene.joints[joint].name].push_back(joint);
    for (std::uint32_t joint = size(); joint-- > 0;) {
        ends_[joint] = std::max(ends_[joint], joint + 1);
        const std::uint32_t parent = scene.joints[joint].parent;
        if (parent != kNone) ends_[parent] = std::max(ends_[parent], ends_[joint]);
    }
}

std::span<const std::uint32_t> JointIndex::named(std::string_view name) const {
    const auto found = by_name_.find(name);
    if (found == by_name_.end()) return {};
    return found->second;
}

std::uint32_t JointIndex::find(std::string_view name, std::uint32_t top) const {
    const auto joints = named(name);
    if (joints.empty()) return kNone;
    if (top != kNone) {
        const auto below = std::lower_bound(joints.begin(), joints.end(), top);
        if (below != joints.end() && *below < end(top)) return *below;
    }
    return joints.front();
}

std::uint32_t JointIndex::find_key(std::string_view key) const {
    std::uint64_t number = 0;
    if (!parse_joint_number(key, number)) return find(name_of_key(key));
    return number < size() ? static_cast<std::uint32_t>(number) : kNone;
}

std::string JointIndex::suggest(std::string_view key) const {
    std::vector<std::pair<std::uint32_t, std::string_view>> firsts;
    for (const auto& [name, joints] : by_name_) firsts.emplace_back(joints.front(), name);
    std::sort(firsts.begin(), firsts.end());
    std::vector<std::string_view> names;
    names.reserve(firsts.size());
    for (const auto& [joint, name] : firsts) names.push_back(name);
    return did_you_mean(names, key);
}

}  // namespace bendy::converter
