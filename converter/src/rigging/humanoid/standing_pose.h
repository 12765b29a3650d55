#pragma once

#include "humanoid.h"
#include "scene/rest_frames.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <optional>
#include <vector>

// Finds the pose in which a human stands. The rest pose says anything: some rest lying, with all bones along one axis,
// or in the first frame of a walk.
namespace bendy::converter {

/// How well a human stands in a pose, about an axis that points up.
struct Standing {
    double lean = 180.0;    ///< degrees from up to the line from the hip joints to the head
    double legs = 180.0;    ///< degrees from up to the line from the feet to the hip joints
    double knees = 180.0;   ///< degrees by which the more bent knee is off straight
    double feet = 1.0;      ///< how far one foot's lowest joint is above the other's, as a share of the height
    double mirror = 180.0;  ///< degrees by which one thigh is off the other's mirror image
    bool has_head_on_top = false;

    /// Whether trunk and legs are upright, whatever knees and feet do.
    [[nodiscard]] bool is_upright() const;
    /// Whether trunk and legs hardly lean.
    [[nodiscard]] bool is_straight() const;
    /// Whether it stands on both feet.
    [[nodiscard]] bool stands() const;
    /// Whether it does with both sides alike: a walk has frames that stand, too.
    [[nodiscard]] bool is_made_to_stand() const;
    /// 0 for a body that stands perfectly, more for less.
    [[nodiscard]] double flaws() const;
};

/// Nothing if hips, head or the bones of a leg are missing, or have no length.
std::optional<Standing> judge_stand(const RestFrames& pose, const Humanoid& bones, const glm::dvec3& up);

/// A pose in which a body may stand: the transform of each joint relative to its parent.
struct CandidatePose {
    StandingEvidence evidence = StandingEvidence::told;
    std::vector<Transform> locals;
};

/// The poses of the skins' bind matrices, where that is not the rest pose: with the root turned as it is bound, and as
/// it rests. Joints that no skin binds rest.
std::vector<CandidatePose> find_bind_poses(const Scene& scene);

/// The pose turned as a whole.
CandidatePose turned(const Scene& scene, const Rotation& turn, CandidatePose pose);

/// The axis that points up in the scene's motions: the one near which the body's own up stays in its clips; Y if there
/// is none.
glm::dvec3 find_up(const Scene& scene, const Humanoid& bones);

/// The frame of all clips in which the human stands best: as if made to, or else an upright one. Nothing if there are
/// none.
/// \param up  an axis
std::optional<CandidatePose> find_standing_frame(const Scene& scene, const Humanoid& bones, const glm::dvec3& up);

/// The pose turned as a whole so that the body is upright; with Y up it faces Z. A body near an axis is taken for one
/// along it. Nothing if it has no up or no left.
/// \param up  an axis
std::optional<CandidatePose> turn_upright(const Scene& scene, const Humanoid& bones, const glm::dvec3& up,
                                          CandidatePose pose);

/// Turns the scene as asked, or as the body in it says, and reports that. Fails if the clips are packed.
/// \param up      the axis that is up in the source: Y, Z, or the one that find_up finds
/// \param faces_front  the body is to face +Z, up to 45 degrees
void orient(Scene& scene, SourceUp up, bool faces_front, Report& report);

/// Sets Scene::standing_pose for a human whose rest pose is not made to stand. Leaves the one that the scene has. Bind
/// matrices are trusted first, then the rest pose turned upright, then a frame of a clip, if they are made to stand,
/// then a T of the body's bones. Warns if no frame stands either, or if nothing is known.
void find_standing_pose(Scene& scene, Report& report);

}  // namespace bendy::converter
