#pragma once

#include <bendy/converter/scene.h>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace bendy::converter {

inline bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The first N components as an array, as in records.
template <std::size_t N, class Vector>
std::array<float, N> to_array(const Vector& v) {
    std::array<float, N> a{};
    for (std::size_t i = 0; i < N; ++i) a[i] = static_cast<float>(v[static_cast<int>(i)]);
    return a;
}

/// x -> linear * x + origin, in double precision.
struct Affine {
    glm::dmat3 linear{1.0};
    glm::dvec3 origin{0.0};

    Affine() = default;
    Affine(const glm::dmat3& linear_part, const glm::dvec3& shift) : linear(linear_part), origin(shift) {}
    /// From a matrix whose fourth row is 0 0 0 1.
    explicit Affine(const glm::dmat4& matrix) : linear(matrix), origin(matrix[3]) {}

    [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& point) const { return linear * point + origin; }
    friend bool operator==(const Affine& a, const Affine& b) { return a.linear == b.linear && a.origin == b.origin; }
    /// Column by column, as in glTF and X-files.
    [[nodiscard]] std::array<double, 16> columns() const {
        const glm::dmat3& m = linear;
        return {m[0].x, m[0].y, m[0].z, 0.0, m[1].x,   m[1].y,   m[1].z,   0.0,
                m[2].x, m[2].y, m[2].z, 0.0, origin.x, origin.y, origin.z, 1.0};
    }
};

inline Affine operator*(const Affine& a, const Affine& b) {
    return {a.linear * b.linear, a.linear * b.origin + a.origin};
}

/// A joint's transform relative to its parent, at one time.
struct Local {
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 translation{0.0};
    glm::dvec3 scale{1.0};
};

/// Sets the property that a track animates to a value from evaluate_track. Not for weights.
inline void set_property(TrackPath path, const std::vector<double>& value, Local& local) {
    switch (path) {
        case TrackPath::translation:
            local.translation = {value[0], value[1], value[2]};
            break;
        case TrackPath::rotation: {
            const double length =
                std::sqrt(value[0] * value[0] + value[1] * value[1] + value[2] * value[2] + value[3] * value[3]);
            if (length > 0.0) local.rotation = glm::dquat(value[3], value[0], value[1], value[2]) / length;
            break;
        }
        case TrackPath::scale:
            local.scale = {value[0], value[1], value[2]};
            break;
        case TrackPath::weights:
            break;
    }
}

inline Local local_of(const Transform& rest) {
    const glm::vec4& q = rest.rotation;
    return {glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)), glm::dvec3(rest.translation), glm::dvec3(rest.scale)};
}

/// The matrix of scale and shear: see Transform.
inline glm::dmat3 stretch(const glm::dvec3& scale, const glm::vec3& shear) {
    return {{scale.x, 0.0, 0.0}, {shear.x, scale.y, 0.0}, {shear.y, shear.z, scale.z}};
}

inline Affine to_affine(const Local& local, const glm::vec3& shear) {
    return {glm::mat3_cast(local.rotation) * stretch(local.scale, shear), local.translation};
}

/// The joint-to-model transforms of all joints; parents come first.
/// \param locals, places  one per joint
inline void place_joints(std::span<const Joint> joints, std::span<const Local> locals, std::span<Affine> places) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const Affine at = to_affine(locals[j], joints[j].rest.shear);
        places[j] = joints[j].parent == kNone ? at : places[joints[j].parent] * at;
    }
}

/// The axis-aligned bounding box of points.
template <class Vector>
struct Box {
    Vector low{std::numeric_limits<typename Vector::value_type>::max()};
    Vector high{std::numeric_limits<typename Vector::value_type>::lowest()};

    void add(const Vector& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    [[nodiscard]] bool is_empty() const { return !(low.x <= high.x); }
    [[nodiscard]] std::array<Vector, 8> corners() const {
        std::array<Vector, 8> all{};
        for (unsigned i = 0; i < 8; ++i)
            all[i] = {(i & 1u) != 0 ? high.x : low.x, (i & 2u) != 0 ? high.y : low.y, (i & 4u) != 0 ? high.z : low.z};
        return all;
    }
};

/// The bounding box of points; the origin if there are none.
inline Box<glm::vec3> box_of(std::span<const glm::vec3> points) {
    if (points.empty()) return {glm::vec3(0.0f), glm::vec3(0.0f)};
    Box<glm::vec3> box;
    for (const glm::vec3& point : points) box.add(point);
    return box;
}

}  // namespace bendy::converter
