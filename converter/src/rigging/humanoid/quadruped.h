#pragma once

#include "anatomy.h"
#include "limb_chains.h"
#include "scene/rest_frames.h"

#include <bendy/converter/scene.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

/// A four-legged animal found in a skeleton.
struct Quadruped {
    enum Leg : std::size_t { left_front, right_front, left_hind, right_hind };

    Stance stance;
    std::array<std::vector<std::uint32_t>, 4> legs;  ///< by Leg; at least three joints each, the foot last
    std::array<std::vector<std::uint32_t>, 4> paws;  ///< joints below the foot; may be empty
    std::array<std::uint32_t, 4> targets{kNone, kNone, kNone,
                                         kNone};  ///< controls of an IK rig that move the feet; may be kNone
    std::vector<std::uint32_t> spine;             ///< between hind and front legs; may be empty, as may the next two
    std::vector<std::uint32_t> neck;              ///< the head last
    std::vector<std::uint32_t> tail;
};

/// Looks for two pairs of mirrored limbs that stand on the same ground, with a trunk between them; nothing if more than
/// two pairs stand. The front is the end with a joint named `head`, otherwise where the feet point and the head is
/// higher than the tail. Left and right follow from front and up.
/// \param chosen  by joint: only these are considered, and leaves below them, where legs may end
std::optional<Quadruped> find_quadruped(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen);

/// LeftFrontLeg, RightFrontLeg, LeftHindLeg, RightHindLeg, Spine, Neck and Tail, if they have two bones or more (spine,
/// neck and tail: one). Legs of two bones use the two-bone solver, other legs any; the other chains use CCD.
std::vector<Chain> make_quadruped_chains(const Scene& scene, const RestFrames& rest, const Quadruped& found,
                                         std::uint8_t flags);

/// The ranges of its joints, as listed in spec/rig.md.
std::vector<JointAnatomy> find_anatomy(const RestFrames& rest, const Quadruped& found);

}  // namespace bendy::converter
