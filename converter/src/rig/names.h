#pragma once

#include <bendy/format/records.h>

#include <array>
#include <string_view>

namespace bendy::converter {

// The words of rig files for the records' enumerations, in the enumerations' order.

inline constexpr std::array<std::string_view, kLimitModels> kModelNames{
    "free", "locked", "hinge", "swing_twist_ellipse", "swing_twist_pyramid", "euler_box", "largest_angle"};
inline constexpr std::array<std::string_view, kEulerOrders> kOrderNames{"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"};
inline constexpr std::array<std::string_view, kLimitScopes> kScopeNames{"every_pose", "ik_only", "all_but_ik"};
inline constexpr std::array<std::string_view, kSolvers> kSolverNames{"any",    "pull", "two_bone",     "ccd",
                                                                     "fabrik", "aim",  "least_squares"};
inline constexpr std::array<const char*, 3> kAxisNames{"x", "y", "z"};

}  // namespace bendy::converter
