#pragma once

#include "humanoid.h"
#include "rest_frames.h"

#include <bendy/converter/scene.h>

#include <array>
#include <cstdint>

namespace bendy::converter {

/// A humanoid found by its joints' names.
struct NamedHumanoid {
    Humanoid bones;
    /// Hands and feet that are not below their limb, as those that an IK rig moves: left and right hand, left and right
    /// foot; kNone where the limb has its end or none is found.
    std::array<std::uint32_t, 4> loose_ends{kNone, kNone, kNone, kNone};
    /// The hand's joint is one of several that spread from the forearm: no wrist turns them all.
    bool has_split_hands = false;
};

/// Looks for limbs, spine and head by name among the joints that meshes are bound to and those above them; among all
/// where no mesh is bound. A limb's bones lie below one another, other joints may be between. Of several fitting joints
/// the one nearest the root counts.
NamedHumanoid find_humanoid(const Scene& scene, const RestFrames& rest);

}  // namespace bendy::converter
