#pragma once

#include <cstddef>

// Input and output of the kernels for limbs that reach: plain data only, as in skin_block.h.
namespace bendy {

/// Limbs of two bones and their targets: of each number, one for each limb. Flags are 0 or 1.
template <std::size_t limbs>
struct alignas(8 * limbs) TwoBoneLimbs {
    double base_x[3][limbs], base_y[3][limbs], base_z[3][limbs];  ///< axes of the start's parent, in model space
    double base_origin[3][limbs];
    double target[3][limbs];       ///< in model space
    double pole[3][limbs];         ///< in model space if is_pole_point, otherwise a direction in the parent's space
    double upper[4][limbs];        ///< local rotation of the start: x y z w
    double lower[4][limbs];        ///< of the middle joint
    double origin[3][limbs];       ///< local translation of the start
    double middle[3][limbs];       ///< of the middle joint
    double tip[3][limbs];          ///< of the tip
    double upper_scale[3][limbs];  ///< local scale of the start
    double lower_scale[3][limbs];  ///< of the middle joint
    double axis[3][limbs];  ///< if is_fixed: the only axis about which the middle joint bends, in the start's space
    double same_scale[1][limbs];  ///< how far the scales of a joint's axes may differ, as a share of them
    double tolerance[1][limbs];   ///< metres; 0: a share of the limb's length
    double roll[2][limbs];        ///< cosine and sine of the angle from the pole to the bend
    double has_pole[1][limbs], is_pole_point[1][limbs], is_rolled[1][limbs];
    double has_limits[1][limbs];
    double is_fixed[1][limbs];
    double prefers_back[1][limbs];  ///< bends against the axis, where both ways are the same turn
};

struct TwoBoneBlock {
    static constexpr std::size_t kLimbs = 4;

    TwoBoneLimbs<kLimbs> limbs;  ///< any numbers where there is none
    double upper[4][kLimbs];     ///< solved, of nearly unit length
    double lower[4][kLimbs];
    double distance[kLimbs];  ///< metres between tip and target; negative: not solved
};

}  // namespace bendy
