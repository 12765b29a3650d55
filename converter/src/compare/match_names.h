#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace bendy::converter {

/// Which things of two lists are the same by name; of several with one name the first is the first.
struct MatchedNames {
    std::vector<std::uint32_t> b_of;  ///< of each of A's; kNone: has none
    std::vector<std::uint32_t> a_of;  ///< of each of B's
};

MatchedNames match_names(std::span<const std::string> a, std::span<const std::string> b);

/// What is left then goes together in order: things that were renamed, or have lost their names.
void match_the_rest(MatchedNames& names);

/// Joints: by name under parents that go together.
MatchedNames match_joints(std::span<const Joint> a, std::span<const Joint> b);

}  // namespace bendy::converter
