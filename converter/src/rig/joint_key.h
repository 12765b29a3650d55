#pragma once

#include "effort.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter {

/// The characters of UTF-8 text; a byte that is none counts as one.
std::u32string characters_of(std::string_view text);

/// Which joints a key of a rig means: `#12`, a name, or a glob with `*`, `?` and `[abc]`. `\` takes the special meaning
/// from the character after it.
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
bool fits(const std::vector<JointKey::Step>& glob, std::u32string_view name, Effort& effort);

/// The number of `#12`; false for other text.
bool parse_joint_number(std::string_view text, std::uint64_t& number);

/// A name as a key that means it and nothing else.
std::string escape_joint_name(std::string_view name);

}  // namespace bendy::converter
