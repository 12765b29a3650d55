#pragma once

#include <bendy/converter/scene.h>

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/quaternion_double.hpp>
#include <glm/ext/vector_double3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace bendy::converter {

using Rotation = glm::dquat;

/// x y z w as in records.
Rotation to_rotation(const std::array<float, 4>& xyzw);
std::array<float, 4> to_record(const Rotation& rotation);

/// Where a scene's joints are at rest, in model space.
class RestFrames {
public:
    explicit RestFrames(const Scene& scene);

    /// The joint's axes: the rotations on the way from the root, scales left aside; unit.
    [[nodiscard]] const Rotation& orientation(std::uint32_t joint) const { return orientations_[joint]; }
    /// A point of the joint's space; metres.
    [[nodiscard]] glm::dvec3 place(std::uint32_t joint, const glm::dvec3& point = {}) const;

private:
    std::vector<Rotation> orientations_;
    std::vector<glm::dmat4> matrices_;
};

}  // namespace bendy::converter
