#pragma once

#include <bendy/format/public.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <concepts>
#include <cstddef>
#include <span>

namespace BENDY_PUBLIC bendy {

/// One attribute in a layout of the caller's: vertex v's numbers are floats[v * stride] and those after it. What lies
/// between is neither read nor written. Empty: not wanted.
struct StridedFloats {
    std::span<float> floats;  ///< from the first vertex' first number; the last vertex needs no whole stride
    std::size_t stride = 0;   ///< floats from vertex to vertex, at least the attribute's own

    StridedFloats() = default;
    StridedFloats(std::span<float> numbers, std::size_t floats_each) : floats(numbers), stride(floats_each) {}
    // NOLINTBEGIN(google-explicit-constructor,bugprone-forwarding-reference-overload): such vectors are one
    /// All of an array, a vector or a span of vec3 or vec4.
    template <class Vectors>
    requires std::constructible_from<std::span<glm::vec3>, Vectors&> StridedFloats(Vectors&& vectors)
        : StridedFloats(without_gaps(std::span<glm::vec3>(vectors))) {}
    template <class Vectors>
    requires std::constructible_from<std::span<glm::vec4>, Vectors&> StridedFloats(Vectors&& vectors)
        : StridedFloats(without_gaps(std::span<glm::vec4>(vectors))) {}
    // NOLINTEND(google-explicit-constructor,bugprone-forwarding-reference-overload)

private:
    template <class Vector>
    static StridedFloats without_gaps(std::span<Vector> vectors) {
        constexpr std::size_t kFloats = sizeof(Vector) / sizeof(float);
        if (vectors.empty()) return {};
        return {{&vectors.front().x, vectors.size() * kFloats}, kFloats};
    }
};

/// The caller's memory for posed vertices, in model space, interleaved or not. It is only written, so it may be a
/// mapped graphics buffer.
struct VertexBuffer {
    StridedFloats positions{};  ///< x y z
    StridedFloats normals{};    ///< x y z: unit; zero where the source has none
    StridedFloats tangents{};   ///< x y z, unit, and w, the handedness +-1; zero where the source has none
};

/// The same without gaps. An empty span means: not wanted.
struct Vertices {
    std::span<glm::vec3> positions;
    std::span<glm::vec3> normals;
    std::span<glm::vec4> tangents;

    // NOLINTNEXTLINE(google-explicit-constructor): it is one
    operator VertexBuffer() const { return {positions, normals, tangents}; }
};

}  // namespace bendy
