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

/// The rotations of joints in a scene's clips.
class ClipRotations {
public:
    /// The scene must outlive this.
    explicit ClipRotations(const Scene& scene);

    /// The rotations of one joint in the clips.
    struct OfJoint {
        std::vector<glm::dquat> rotations;  ///< conj(rest) * q: unit, w >= 0
        std::uint32_t clips = 0;            ///< number with a rotation track for it
    };
    /// Every key, with intermediate rotations where keys are more than 5 degrees apart, so that neighbours are not.
    [[nodiscard]] OfJoint of(std::uint32_t joint) const;

    /// The clip whose keys turn one of the joints farthest from rest; nothing if none does.
    [[nodiscard]] std::optional<std::size_t> farthest_clip(const std::vector<std::uint32_t>& joints) const;

    /// Two bones: `start`, `middle` below it, and a tip fixed to `end`, which is `middle` or below it.
    struct Limb {
        std::uint32_t start = kNone;
        std::uint32_t middle = kNone;
        std::uint32_t end = kNone;
        glm::dvec3 tip{0.0};  ///< in the space of `end`
    };
    /// The side of the line from start to tip to which the clips bend the limb.
    struct Bend {
        glm::dvec3 direction{0.0};  ///< unit, in the space of start's parent: the mean, weighted by the amount of bend
        double agreement = 0.0;     ///< 0 to 1: how one-sided they are
        std::uint32_t clips = 0;    ///< number of clips that move the limb
    };
    /// Nothing if no clip moves the limb, or none bends it by more than 10 degrees.
    [[nodiscard]] std::optional<Bend> bend_of(const Limb& limb) const;

private:
    struct Placed {
        std::size_t clip = 0;
        const Track* track = nullptr;
    };

    const Scene& scene_;
    std::vector<std::vector<Placed>> tracks_;  ///< rotation tracks, by joint, in the clips' order
};

/// Unit quaternions with w >= 0.
using Rotations = std::vector<glm::dquat>;

/// R = swing * twist about X, as defined in spec/constraints.md.
struct SwingTwist {
    double twist = 0.0;     ///< degrees, -180 to 180
    glm::dvec2 swing{0.0};  ///< the axis' Y and Z, times the sine of half the angle
    double cosine = 1.0;    ///< of half the swing's angle
};

SwingTwist decompose(const glm::dquat& r);

/// The sine of half an angle of 0 to 180 degrees.
double half_sine_of(double degrees);
/// The inverse: the angle in degrees.
double degrees_of(double half_sine);

/// The angle of a rotation about an axis that is almost its own; degrees.
double angle_about(const glm::dquat& r, const glm::dvec3& axis);

/// The largest angle of rotation; degrees.
double largest_angle(const Rotations& rotations);

/// The largest deviation of the rotations from turns about the axis alone; degrees.
double wobble_about(const Rotations& rotations, const glm::dvec3& axis);

/// The axis about which the rotations turn most.
glm::dvec3 fit_axis(const Rotations& rotations);

/// As above for the swings alone: at right angles to X.
glm::dvec3 fit_swing_axis(const Rotations& rotations);

}  // namespace bendy::converter
