#pragma once

#include <bendy/format/public.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

namespace BENDY_PUBLIC bendy {

/// A joint's transform relative to its parent.
struct JointTransform {
    glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  ///< unit; glm's constructor takes w first
    glm::vec3 translation{0.0f};                 ///< metres, in the parent's space
    glm::vec3 scale{1.0f};                       ///< along the joint's axes; may be negative or zero
};

/// The transforms of eight neighbouring joints as a Pose stores them: an array for each number, so that an instruction
/// deals with several joints. Lanes without a joint hold the identity.
struct alignas(64) JointBlock {
    static constexpr std::uint32_t kJoints = 8;

    float rotation[4][kJoints]{{}, {}, {}, {1, 1, 1, 1, 1, 1, 1, 1}};  ///< x, y, z, w
    float translation[3][kJoints]{};
    float scale[3][kJoints]{{1, 1, 1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1, 1, 1}};

    /// \param lane  less than kJoints
    [[nodiscard]] JointTransform joint(std::uint32_t lane) const {
        return {glm::quat(rotation[3][lane], rotation[0][lane], rotation[1][lane], rotation[2][lane]),
                glm::vec3(translation[0][lane], translation[1][lane], translation[2][lane]),
                glm::vec3(scale[0][lane], scale[1][lane], scale[2][lane])};
    }
    void set_joint(std::uint32_t lane, const JointTransform& transform) {
        set_rotation(lane, transform.rotation);
        set_translation(lane, transform.translation);
        set_scale(lane, transform.scale);
    }
    void set_rotation(std::uint32_t lane, const glm::quat& value) {
        rotation[0][lane] = value.x;
        rotation[1][lane] = value.y;
        rotation[2][lane] = value.z;
        rotation[3][lane] = value.w;
    }
    void set_translation(std::uint32_t lane, const glm::vec3& value) {
        for (int c = 0; c < 3; ++c) translation[c][lane] = value[c];
    }
    void set_scale(std::uint32_t lane, const glm::vec3& value) {
        for (int c = 0; c < 3; ++c) scale[c][lane] = value[c];
    }
};

/// Returns T * R * U; U is upper triangular with the scale on its diagonal and `shear` (xy, xz, yz) above it.
[[nodiscard]] glm::dmat4 to_matrix(const JointTransform& transform, const glm::vec3& shear);

}  // namespace bendy
