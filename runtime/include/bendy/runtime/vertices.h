#pragma once

#include <bendy/format/public.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <concepts>
#include <cstddef>
#include <span>

namespace BENDY_PUBLIC bendy {

/// One vertex attribute in the caller's layout: the numbers of vertex v start at floats[v * stride]. Gaps are neither
/// read nor written. Empty: not wanted.
struct StridedFloats {
    std::span<float> floats;  ///< starts with the first vertex; the last vertex needs no padding to the stride
    std::size_t stride = 0;   ///< floats from one vertex to the next, at least the number of components

    StridedFloats() = default;
    StridedFloats(std::span<float> numbers, std::size_t floats_each) : floats(numbers), stride(floats_each) {}
    // NOLINTBEGIN(google-explicit-constructor,bugprone-forwarding-reference-overload): converts implicitly by design
    /// All elements of an array, a vector or a span of vec3 or vec4.
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

/// The caller's memory for posed vertices, in model space, interleaved or not. It is only written to, so it may be a
/// mapped graphics buffer.
struct VertexBuffer {
    StridedFloats positions{};  ///< x y z
    StridedFloats normals{};    ///< x y z, unit length; zero where the source has none
    StridedFloats tangents{};   ///< x y z, unit length, and w, the handedness +-1; zero where the source has none
};

/// The same, tightly packed. An empty span means: not wanted.
struct Vertices {
    std::span<glm::vec3> positions;
    std::span<glm::vec3> normals;
    std::span<glm::vec4> tangents;

    // NOLINTNEXTLINE(google-explicit-constructor): converts implicitly by design
    operator VertexBuffer() const { return {positions, normals, tangents}; }
};

}  // namespace bendy
