#pragma once

#include <bendy/converter/scene.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

/// How a scene's clips turn its joints.
class ClipRotations {
public:
    /// The scene must outlive this.
    explicit ClipRotations(const Scene& scene);

    /// What the clips do to one joint.
    struct OfJoint {
        std::vector<glm::dquat> rotations;  ///< conj(rest) * q: unit, w >= 0
        std::uint32_t clips = 0;            ///< that have a rotation track for it
    };
    /// Every key, and between keys that are more than 5 degrees apart as many more as bring neighbours so near.
    [[nodiscard]] OfJoint of(std::uint32_t joint) const;

    /// Two bones with a joint in the middle: `start`, `middle` below it, and a tip fixed to `end`, which is `middle`
    /// or below it.
    struct Limb {
        std::uint32_t start = kNone;
        std::uint32_t middle = kNone;
        std::uint32_t end = kNone;
        glm::dvec3 tip{0.0};  ///< in the space of `end`
    };
    /// To which side of the line from start to tip the clips take the middle joint.
    struct Bend {
        glm::dvec3 direction{0.0};  ///< unit, in the space of start's parent: the mean, weighted by how bent it is
        double agreement = 0.0;     ///< 0 to 1: how one-sided they are
        std::uint32_t clips = 0;    ///< that move the limb
    };
    /// Nothing where no clip moves the limb, or none bends it by more than 10 degrees.
    [[nodiscard]] std::optional<Bend> bend_of(const Limb& limb) const;

private:
    struct Placed {
        std::size_t clip = 0;
        const Track* track = nullptr;
    };

    const Scene& scene_;
    std::vector<std::vector<Placed>> tracks_;  ///< rotation tracks, by joint, in the clips' order
};

/// Unit, w >= 0.
using Rotations = std::vector<glm::dquat>;

/// R = swing * twist about X, as spec/constraints.md has it.
struct SwingTwist {
    double twist = 0.0;     ///< degrees, -180 to 180
    glm::dvec2 swing{0.0};  ///< Y and Z: the sine of half its angle
    double cosine = 1.0;    ///< of half its angle
};

SwingTwist decompose(const glm::dquat& r);

/// The sine of half an angle of 0 to 180 degrees.
double half_sine_of(double degrees);
/// The angle again.
double degrees_of(double half_sine);

/// The angle of a rotation about an axis that is nearly its own; degrees.
double angle_about(const glm::dquat& r, const glm::dvec3& axis);

/// The largest angle of rotation; degrees.
double largest_angle(const Rotations& rotations);

/// How far the rotations are from turning about the axis alone, at most; degrees.
double wobble_about(const Rotations& rotations, const glm::dvec3& axis);

/// The axis about which the rotations turn most.
glm::dvec3 fit_axis(const Rotations& rotations);

/// The same for their swings alone: at right angles to X.
glm::dvec3 fit_swing_axis(const Rotations& rotations);

}  // namespace bendy::converter
