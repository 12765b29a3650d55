#pragma once

#include "scene/failure.h"

#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace bendy::converter {

/// Bounds the work of matching: a small hostile file can match many globs against many joints.
class WorkBudget {
public:
    static constexpr std::uint64_t kMost = 400'000'000;  ///< steps: one per character comparison

    /// Uses up `steps`, or fails with an empty place.
    void take(std::uint64_t steps) {
        if (steps > left_) fail({}, "its keys, chains and weights take too long to match with so many joints");
        left_ -= steps;
    }

private:
    std::uint64_t left_ = kMost;
};

/// The characters of UTF-8 text; an invalid byte counts as one.
std::u32string characters_of(std::string_view text);

/// A joint key in a rig: `#12`, a name, or a glob with `*`, `?` and `[abc]`. `\` escapes the character after it. Text
/// after a leading `=` is a literal name.
struct JointKey {
    enum class Kind : std::uint8_t { number, name, glob };
    /// One step of a glob.
    struct Step {
        enum class Kind : std::uint8_t { one_of, any_one, any_run };
        Kind kind = Kind::one_of;
        std::u32string characters;  ///< one_of: sorted
    };
    Kind kind = Kind::name;
    std::uint64_t number = 0;
    std::string name;  ///< the name that it means; otherwise the key as written
    std::vector<Step> glob;
};

/// Fails at `place` on a `[` without `]`, on an empty `[]`, and on a `\` at the end.
JointKey parse_joint_key(std::string_view text, const std::string& place);

/// True if the glob matches all of `name`.
bool fits(const std::vector<JointKey::Step>& glob, std::u32string_view name, WorkBudget& budget);

/// Parses the number of `#12`; false for other text.
bool parse_joint_number(std::string_view text, std::uint64_t& number);

/// The name that a key without globs and escapes stands for, unless it is a number: the whole key, or the text after
/// `=`.
std::string_view name_of_key(std::string_view key);

/// True if a name can be used as a key for itself, without globs and escapes.
bool means_itself(std::string_view name);

/// Escapes a name as a key that matches only this name.
std::string escape_joint_name(std::string_view name);

/// Finds joints of a scene by name, and answers ancestor queries. The scene's joints must not change.
class JointIndex {
public:
    explicit JointIndex(const Scene& scene);

    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(ends_.size()); }
    /// The joints with a name, ascending.
    [[nodiscard]] std::span<const std::uint32_t> named(std::string_view name) const;
    /// The first joint with a name at or below `top`, or else the first of all; kNone if there is none.
    [[nodiscard]] std::uint32_t find(std::string_view name, std::uint32_t top = kNone) const;
    /// The joint for `#12`, `=Hips` or a name; kNone if there is none.
    [[nodiscard]] std::uint32_t find_key(std::string_view key) const;
    /// `; did you mean "Hips"?` if a name is similar to a key without a match; otherwise empty.
    [[nodiscard]] std::string suggest(std::string_view key) const;
    /// In pre-order a joint's descendants are [joint, end).
    [[nodiscard]] std::uint32_t end(std::uint32_t joint) const { return ends_[joint]; }
    [[nodiscard]] bool is_above(std::uint32_t joint, std::uint32_t other) const {
        return joint <= other && other < ends_[joint];
    }

private:
    std::unordered_map<std::string_view, std::vector<std::uint32_t>> by_name_;
    std::vector<std::uint32_t> ends_;
};

}  // namespace bendy::converter
