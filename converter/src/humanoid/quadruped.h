#pragma once

#include "anatomy.h"
#include "limb_chains.h"
#include "rest_frames.h"

#include <bendy/converter/scene.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

/// An animal on four legs, found in a skeleton.
struct Quadruped {
    enum Leg : std::size_t { left_front, right_front, left_hind, right_hind };

    Stance stance;
    std::array<std::vector<std::uint32_t>, 4> legs;  ///< by Leg; at least three joints each, the foot last
    std::array<std::uint32_t, 4> targets{kNone, kNone, kNone,
                                         kNone};  ///< what an IK rig moves the feet by; may be kNone
    std::vector<std::uint32_t> spine;             ///< between hind and front legs; may be empty, as the next two
    std::vector<std::uint32_t> neck;              ///< the head last
    std::vector<std::uint32_t> tail;
};

/// Looks for two pairs of limbs that are each other's mirror images and stand on one ground, on a trunk that lies
/// between them; nothing where more than two pairs stand. Its front is where names say `head`, else where the feet
/// point and the head is higher than the tail. Left and right follow from front and up.
/// \param chosen  by joint: only these are looked at, and leaves below them, where legs may end
std::optional<Quadruped> find_quadruped(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen);

/// LeftFrontLeg, RightFrontLeg, LeftHindLeg, RightHindLeg, Spine, Neck and Tail, those that have two bones or more
/// (spine, neck and tail: one). Legs of two bones get the two-bone solver, others any; the rest of the chains CCD.
std::vector<Chain> make_quadruped_chains(const Scene& scene, const RestFrames& rest, const Quadruped& found,
                                         std::uint8_t flags);

/// Ranges of its joints; spec/rig.md has them.
std::vector<JointAnatomy> find_anatomy(const RestFrames& rest, const Quadruped& found);

}  // namespace bendy::converter
