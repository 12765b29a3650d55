#include "scene/turn_roots.h"

#include "scene/failure.h"
#include "scene/rest_frames.h"

#include <bendy/format/standing_pose.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace bendy::converter {
namespace {

class Turner {
public:
    explicit Turner(const glm::dmat3& turn) : matrix_(turn), turn_(rotation_of_axes(turn)) {}

    void vector(std::span<float> v) const {
        const glm::dvec3 turned = matrix_ * glm::dvec3(v[0], v[1], v[2]);
        for (int k = 0; k < 3; ++k) v[static_cast<std::size_t>(k)] = static_cast<float>(turned[k]);
    }
    /// Its length need not be 1: tangents of rotations have any.
    void quaternion(std::span<float> xyzw) const {
        const Rotation turned = turn_ * Rotation(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
        xyzw[0] = static_cast<float>(turned.x);
        xyzw[1] = static_cast<float>(turned.y);
        xyzw[2] = static_cast<float>(turned.z);
        xyzw[3] = static_cast<float>(turned.w);
    }

private:
    glm::dmat3 matrix_;
    Rotation turn_;
};

void turn_clip(const Scene& scene, const Turner& turner, Clip& clip) {
    if (!clip.packed.empty())
        fail({}, "the tracks of clip " + quote(clip.name) + " are packed: make an exact file of it first");
    for (Track& track : clip.tracks) {
        if (track.path == TrackPath::weights || scene.joints[track.target].parent != kNone) continue;
        for (std::size_t at = 0; at < track.values.size(); at += track.components) {
            const auto value = std::span(track.values).subspan(at, track.components);
            if (track.path == TrackPath::translation) turner.vector(value);
            if (track.path == TrackPath::rotation) turner.quaternion(value);
        }
    }
}

}  // namespace

void turn_roots(Scene& scene, const glm::dmat3& turn) {
    const Turner turner(turn);
    for (Clip& clip : scene.clips) turn_clip(scene, turner, clip);
    for (Joint& joint : scene.joints) {
        if (joint.parent != kNone) continue;
        turner.vector({&joint.rest.translation.x, 3});
        turner.quaternion({&joint.rest.rotation.x, 4});
    }
    for (Chain& chain : scene.chains) {
        if (scene.joints[chain.record.start].parent == kNone) turner.vector(chain.record.pole_vector);
    }
    if (!scene.standing_pose) return;
    turner.quaternion(scene.standing_pose->pose.axes);
    for (StandingRotationRecord& record : scene.standing_pose->rotations) {
        std::array<float, 4> rotation = rotation_of(record);
        turner.quaternion(rotation);
        record = standing_rotation(record.joint, rotation);
    }
}

}  // namespace bendy::converter
