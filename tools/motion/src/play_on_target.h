#pragma once

#include "bone_comparison.h"
#include "pops.h"

#include <bendy/format/packed_clip.h>
#include <bendy/runtime/model.h>
#include <bendy/runtime/retarget.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace bendy::motion {

/// A curve of contact, by its number in ContactWeights.
struct ContactCurve {
    std::size_t contact = 0;
    std::vector<float> times, values;
};

/// What a limit did to a joint in a clip.
struct Held {
    double angle = 0.0;  ///< radians, most
    float seconds = 0.0f;
};

/// The bone that is farthest off the source's direction, of those for the same cause.
struct FarthestOff {
    std::uint32_t joint = kNone;  ///< of the target, where the bone begins; kNone: none is far off
    double angle = 0.0;           ///< radians
    float seconds = 0.0f;
};

/// A clip as it is on the target.
struct Followed {
    std::vector<bool> kept;             ///< by joint of the source: the target's has its numbers in every frame
    std::vector<UnpackedTrack> tracks;  ///< of all that is not kept and not at rest
    std::vector<ContactCurve> contacts;
    bool has_contacts = false;    ///< they came with the clip
    std::vector<bool> moves;      ///< by joint of the source: it turns or moves at all
    std::vector<bool> stretches;  ///< it changes its length or its scale, and the target's does not

    std::size_t frames = 0, limited = 0;    ///< limited: frames in which a limit acted
    std::map<std::uint32_t, Held> held;     ///< by joint of the target; each frame counts for its worst joint
    float missed = 0.0f, missed_at = 0.0f;  ///< metres, seconds: see Retargeted
    std::uint32_t missed_joint = kNone;
    float lowered = 0.0f;
    /// Metres: how far the joint that is farthest off is from where Retarget has it, at the frames and between them.
    double error = 0.0, mean_error = 0.0;
    float error_at = 0.0f;  ///< seconds
    /// Against the source: between directions of bones that both bodies have, all of them, at the frames.
    FarthestOff farthest_off;
    double mean_off = 0.0;  ///< radians
    std::vector<JointPop> pops;
    std::array<FarthestOff, kCauses> far_off{};  ///< by Cause: bones that are farther off than SharedBone::far
};

/// Plays the clip on the target. Nothing, if a number is not finite.
/// \param options         those of `retarget`
/// \param sampled_meshes  meshes of the target whose weights become tracks
std::optional<Followed> play_on_target(Retarget& retarget, BoneComparison& comparison, const Clip& clip,
                                       const RetargetOptions& options,
                                       const std::vector<std::uint32_t>& sampled_meshes);

inline constexpr const char* kContactNames[kContacts] = {"left_heel_contact",
                                                         "left_toes_contact",
                                                         "right_heel_contact",
                                                         "right_toes_contact",
                                                         "left_front_heel_contact",
                                                         "left_front_toes_contact",
                                                         "right_front_heel_contact",
                                                         "right_front_toes_contact",
                                                         "left_hand_contact",
                                                         "right_hand_contact",
                                                         "body_contact",
                                                         "hands_contact",
                                                         "left_hand_body_contact",
                                                         "right_hand_body_contact"};

}  // namespace bendy::motion
