#pragma once

#include <string>
#include <string_view>

namespace bendy {

/// Returns how a morph target's name is compared: the same for "eyeBlinkLeft", "EyeBlink_L" and "eye blink.l", and,
/// for the 52 names of ARKit, for "Head.eyeBlinkLeft" too.
std::string target_key(std::string_view name);

}  // namespace bendy
