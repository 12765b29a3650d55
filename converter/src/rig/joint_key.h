#pragma once

#include "failure.h"

#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace bendy::converter {

/// Bounds the work of matching: a small hostile file can set any number of globs against any number of joints.
class WorkBudget {
public:
    static constexpr std::uint64_t kMost = 400'000'000;  ///< steps: a character compared is one

    /// Counts `steps`, or fails with an empty place.
    void take(std::uint64_t steps) {
        if (steps > left_) fail({}, "its keys, chains and weights take too long to match with so many joints");
        left_ -= steps;
    }

private:
    std::uint64_t left_ = kMost;
};

/// The characters of UTF-8 text; a byte that is none counts as one.
std::u32string characters_of(std::string_view text);

/// Which joints a key of a rig means: `#12`, a name, or a glob with `*`, `?` and `[abc]`. `\` takes the special meaning
/// from the character after it. What follows a `=` at the start is a name, whatever is in it.
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
    std::string name;  ///< of a name: what is meant; else as it was written
    std::vector<Step> glob;
};

/// Fails at `place` on a `[` without `]`, on an empty `[]`, and on a `\` at the end.
JointKey parse_joint_key(std::string_view text, const std::string& place);

/// True where all of `name` fits the glob.
bool fits(const std::vector<JointKey::Step>& glob, std::u32string_view name, WorkBudget& budget);

/// The number of `#12`; false for other text.
bool parse_joint_number(std::string_view text, std::uint64_t& number);

/// The name that a key without globs and escapes means, if it is no number: all of it, or what follows `=`.
std::string_view name_of_key(std::string_view key);

/// True if a name is also a key, without globs and escapes, that means it.
bool means_itself(std::string_view name);

/// A name as a key that means it and nothing else.
std::string escape_joint_name(std::string_view name);

/// Finds joints of a scene by name, and tells who is above whom. The scene's joints must stay as they are.
class JointIndex {
public:
    explicit JointIndex(const Scene& scene);

    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(ends_.size()); }
    /// The joints of a name, ascending.
    [[nodiscard]] std::span<const std::uint32_t> named(std::string_view name) const;
    /// The first joint of a name at or below `top` if there is one, else the first of all; kNone if there is none.
    [[nodiscard]] std::uint32_t find(std::string_view name, std::uint32_t top = kNone) const;
    /// The joint that `#12`, `=Hips` or a name means; kNone if there is none.
    [[nodiscard]] std::uint32_t find_key(std::string_view key) const;
    /// `; did you mean "Hips"?` if some name is similar to a key that means no joint; otherwise nothing.
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
