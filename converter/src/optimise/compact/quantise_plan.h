#pragma once

#include <bendy/converter/scene.h>
#include <bendy/format/packed_clip.h>

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

// How a clip is quantised: for each property of each joint, whether it changes, and the steps of its components.

namespace bendy::converter {

inline constexpr std::size_t kPaths = 3;  // translation, rotation, scale: in TrackPath's order

inline std::size_t index(TrackPath path) {
    return static_cast<std::size_t>(path);
}

enum class PropertyState : std::uint8_t {
    unpacked,  ///< PACK has no track: another track of the clip animates it, or it rests
    rest,      ///< PACK leaves it at rest
    constant,
    animated
};

/// Translation and scale: the difference from rest. Rotation: the rotation vector from rest.
struct Property {
    PropertyState state = PropertyState::unpacked;
    std::uint32_t components = 3;
    std::array<std::uint8_t, 3> steps{160, 160, 160};  // codes
    glm::dvec3 middle{0.0};                            // halfway between its extremes
    glm::dvec3 half{0.0};                              // from the middle to either extreme
    glm::dvec3 reach{0.0};  // the most metres by which a unit of each component moves a probe

    [[nodiscard]] bool is_stored() const {
        return state == PropertyState::animated || state == PropertyState::constant;
    }
};

using JointPlan = std::array<Property, kPaths>;

/// packed_step of every code, in a table: computing a power of two takes longer than using it.
inline double step_size(std::uint8_t code) {
    static const std::array<float, 256> all = [] {
        std::array<float, 256> steps{};
        for (std::size_t k = 0; k < steps.size(); ++k) steps.at(k) = packed_step(static_cast<std::uint8_t>(k));
        return steps;
    }();
    return all.at(code);
}

/// The code of the largest step that is at most `step`.
inline std::uint8_t step_code(double step) {
    const double exact = std::clamp(step, 1e-12, 1e7);
    int exponent = 0;
    const double mantissa = std::frexp(exact, &exponent);  // [0.5, 1)
    constexpr std::array<double, 3> kRoots{0.5946035575013605, 0.7071067811865476, 0.8408964152537145};
    int quarter = 0;
    while (quarter < 3 && mantissa >= kRoots.at(static_cast<std::size_t>(quarter))) ++quarter;
    return static_cast<std::uint8_t>(std::clamp((exponent - 1) * 4 + quarter + 160, 0, 255));
}

}  // namespace bendy::converter
