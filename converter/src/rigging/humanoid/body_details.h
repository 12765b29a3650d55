#pragma once

#include "humanoid.h"
#include "scene/rest_frames.h"

#include <bendy/converter/scene.h>

#include <cstdint>
#include <string>
#include <vector>

namespace bendy::converter {

/// Adds fingers, eyes and jaw by the joints' names: fingers below the forearms, the rest below the head. A finger's
/// joints are numbered from the palm; those beyond the third, and metacarpals other than the thumb's, have no role.
void add_details(const Scene& scene, const RestFrames& rest, Humanoid& bones);

/// Whether the name is that of a finger's joint.
bool is_finger(const std::string& name);

/// The joint that stands for a hand of several joints that branch from the forearm: the one that carries the middle
/// finger, else the ring or index finger; where all branches are fingers themselves, that finger. kNone if there is
/// none.
std::uint32_t find_split_hand(const Scene& scene, const RestFrames& rest, std::uint32_t forearm);

/// The joints named as a tail, from the body outwards, whose first one hangs from one of `bases`; empty if there is
/// none.
std::vector<std::uint32_t> find_tail(const Scene& scene, const std::vector<std::uint32_t>& bases);

/// The joints named as a wing of that side, from the body outwards; empty if there is none.
std::vector<std::uint32_t> find_wing(const Scene& scene, BodySide side);

}  // namespace bendy::converter
