#pragma once

#include "anatomy.h"
#include "limb_chains.h"
#include "scene/rest_frames.h"

#include <bendy/converter/scene.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

inline constexpr std::size_t kFourLegs = 4;

/// An animal of four legs or more found in a skeleton.
struct Animal {
    /// The legs of one that has four.
    enum Leg : std::size_t { left_front, right_front, left_hind, right_hind };

    Stance stance;
    /// In pairs from the front, the left one first; at least three joints each, the foot last.
    std::vector<std::vector<std::uint32_t>> legs;
    std::vector<std::vector<std::uint32_t>> paws;  ///< by leg: joints below the foot; may be empty
    std::vector<std::uint32_t> targets;            ///< by leg: control of an IK rig that moves the foot; may be kNone
    std::vector<std::uint32_t> spine;              ///< between hind and front legs; may be empty, as may the next two
    std::vector<std::uint32_t> neck;               ///< the head last
    std::vector<std::uint32_t> tail;
};

/// Looks for two pairs of mirrored limbs that stand on the same ground, with a trunk between them, and further pairs
/// beside them. The front is the end with a joint named `head`, otherwise where the feet point and the head is higher
/// than the tail. Left and right follow from front and up.
/// \param chosen  by joint: only these are considered, and leaves below them, where legs may end
std::optional<Animal> find_animal(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen);

/// LeftFrontLeg, RightFrontLeg, LeftHindLeg, RightHindLeg, or, of more than four legs, LeftLeg1, RightLeg1 and so on
/// from the front; Spine, Neck and Tail, if they have two bones or more (spine, neck and tail: one). Legs of two bones
/// use the two-bone solver, other legs any; the other chains use CCD.
std::vector<Chain> make_animal_chains(const Scene& scene, const RestFrames& rest, const Animal& found,
                                      std::uint8_t flags);

/// The ranges of the joints of an animal on four legs, as listed in spec/rig.md.
std::vector<JointAnatomy> find_anatomy(const RestFrames& rest, const Animal& found);

}  // namespace bendy::converter
