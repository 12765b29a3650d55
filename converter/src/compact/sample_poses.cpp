#include "compact/sample_poses.h"

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/matrix_double4x4.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace bendy::converter {
namespace {

constexpr std::size_t kMostPoses = 48;
constexpr std::size_t kMostMatrices = std::size_t{1} << 20U;

/// T R U, see Transform.
glm::dmat4 matrix_of(const Transform& transform) {
    const glm::dvec4 q = transform.rotation;
    const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    const double s = square > 0.0 ? 2.0 / square : 0.0;
    const glm::dmat3 rotation(
        1.0 - s * (q.y * q.y + q.z * q.z), s * (q.x * q.y + q.z * q.w), s * (q.x * q.z - q.y * q.w),
        s * (q.x * q.y - q.z * q.w), 1.0 - s * (q.x * q.x + q.z * q.z), s * (q.y * q.z + q.x * q.w),
        s * (q.x * q.z + q.y * q.w), s * (q.y * q.z - q.x * q.w), 1.0 - s * (q.x * q.x + q.y * q.y));
    const glm::dmat3 upper(transform.scale.x, 0.0, 0.0, transform.shear.x, transform.scale.y, 0.0, transform.shear.y,
                           transform.shear.z, transform.scale.z);
    glm::dmat4 matrix(rotation * upper);
    matrix[3] = glm::dvec4(glm::dvec3(transform.translation), 1.0);
    return matrix;
}

/// The track's value at a time, lines between keys.
glm::vec4 value_at(const Track& track, float time) {
    const auto after = std::upper_bound(track.times.begin(), track.times.end(), time);
    const auto last = track.times.size() - 1;
    const auto to = std::min(static_cast<std::size_t>(after - track.times.begin()), last);
    const std::size_t from = to == 0 ? 0 : (after == track.times.end() ? last : to - 1);
    const bool is_cubic = track.interpolation == Interpolation::cubic;
    const auto key = [&](std::size_t k) {
        const std::size_t width = std::size_t{track.components} * (is_cubic ? 3 : 1);
        glm::vec4 value(0.0f);
        for (std::uint32_t c = 0; c < std::min(track.components, 4u); ++c)
            value[static_cast<int>(c)] = track.values[k * width + (is_cubic ? track.components : 0u) + c];
        return value;
    };
    const glm::vec4 a = key(from);
    glm::vec4 b = key(to);
    if (from == to || track.interpolation == Interpolation::step) return a;
    if (track.path == TrackPath::rotation && a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w < 0.0f) b = -b;
    const float share = (time - track.times[from]) / (track.times[to] - track.times[from]);
    return a + (b - a) * share;
}

std::vector<glm::dmat4> to_model_space(const Scene& scene, const std::vector<Transform>& locals) {
    std::vector<glm::dmat4> matrices(scene.joints.size());
    for (std::size_t joint = 0; joint < matrices.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        const glm::dmat4 local = matrix_of(locals[joint]);
        matrices[joint] = parent == kNone ? local : matrices[parent] * local;
    }
    return matrices;
}

void apply(const Cycle& cycle, float time, std::vector<Transform>& locals) {
    for (const Track& track : cycle.tracks) {
        if (track.path == TrackPath::weights || track.times.empty() || track.target >= locals.size()) continue;
        const glm::vec4 value = value_at(track, time);
        Transform& local = locals[track.target];
        if (track.path == TrackPath::translation) local.translation = glm::vec3(value);
        if (track.path == TrackPath::rotation) local.rotation = value;
        if (track.path == TrackPath::scale) local.scale = glm::vec3(value);
    }
}

}  // namespace

std::vector<std::vector<glm::dmat4>> sample_poses(const Scene& scene) {
    std::vector<Transform> rest;
    for (const Joint& joint : scene.joints) rest.push_back(joint.rest);
    std::vector<std::vector<glm::dmat4>> poses{to_model_space(scene, rest)};
    if (scene.cycles.empty() || scene.joints.empty()) return poses;
    const std::size_t most = std::min(kMostPoses, kMostMatrices / scene.joints.size());
    const std::size_t cycles = std::min(scene.cycles.size(), most);
    for (std::size_t c = 0; c < cycles; ++c) {
        const Cycle& cycle = scene.cycles[c];
        float start = 0.0f;
        float end = 0.0f;
        bool is_first = true;
        for (const Track& track : cycle.tracks) {
            if (track.times.empty()) continue;
            start = is_first ? track.times.front() : std::min(start, track.times.front());
            end = is_first ? track.times.back() : std::max(end, track.times.back());
            is_first = false;
        }
        const std::size_t count = std::max<std::size_t>(1, most / cycles);
        for (std::size_t k = 0; k < count; ++k) {
            std::vector<Transform> locals = rest;
            const float share = count == 1 ? 0.5f : static_cast<float>(k) / static_cast<float>(count - 1);
            apply(cycle, start + (end - start) * share, locals);
            poses.push_back(to_model_space(scene, locals));
        }
    }
    return poses;
}

double largest_stretch(const glm::dmat4& matrix) {
    // Power iteration on M^T M from three starts; each gives a lower bound that soon is tight.
    const glm::dmat3 linear(matrix);
    const glm::dmat3 square = glm::transpose(linear) * linear;
    double largest = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 v(0.3, 0.4, 0.5);
        v[axis] = 1.0;
        double length = 0.0;
        for (int turn = 0; turn < 24; ++turn) {
            v /= std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
            v = square * v;
            length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
            if (!(length > 0.0) || !std::isfinite(length)) break;
        }
        largest = std::max(largest, length);
    }
    constexpr double kSpare = 1.001;
    return std::sqrt(largest) * kSpare;
}

}  // namespace bendy::converter
