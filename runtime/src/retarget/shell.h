#pragma once

#include <bendy/runtime/model.h>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace bendy {

/// Unit vectors to the sides, edges and corners of a cube from its middle, 0 to 26; the one in the middle is zero.
inline constexpr std::size_t kDirections = 27;
glm::dvec3 direction(std::size_t number);

/// A part of a body, or a prop, as planes around its skin, which move with a joint; in the body's axes as it stands,
/// metres.
struct Shell {
    std::uint32_t joint = kNone;              ///< kNone: the body lacks this part
    std::uint32_t held_by = kNone;            ///< of a prop: the hand below which it is, 0 or 1
    glm::dmat4 to_body{1.0}, from_body{1.0};  ///< from the space of the joint, and back to it
    glm::dvec3 middle{0.0};                   ///< of the box along the axes
    glm::dvec3 half{0.0};                     ///< of the box: half of its edges
    std::array<double, kDirections> reach{};  ///< of the planes from the middle

    /// Grows until the planes are around a place.
    void take(const glm::dvec3& place);
    /// Makes `middle` and `half` of what has been taken. Returns false if the part has no volume.
    bool finish();
    /// Returns how far a place is from the planes; negative between them. \param way  to it from the middle
    [[nodiscard]] double gap(const glm::dvec3& way) const;
    /// Returns how far from the middle the gap is that wide. \param side  unit
    [[nodiscard]] double radius(const glm::dvec3& side, double gap) const;

private:
    bool is_empty_ = true;
};

}  // namespace bendy
