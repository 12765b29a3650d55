#include "scene/evaluate.h"

#include "scene/frame_shapes.h"
#include "scene/space.h"

#include <bendy/format/trig.h>

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace bendy::converter {
namespace {

using Quaternion = std::array<double, 4>;  // x y z w

double length_of(const double* numbers, std::size_t count) {
    double square = 0.0;
    for (std::size_t c = 0; c < count; ++c) square += numbers[c] * numbers[c];
    return std::sqrt(square);
}

void scale_to(double length, double* numbers, std::size_t count) {
    const double present = length_of(numbers, count);
    if (!(present > 0.0)) return;
    for (std::size_t c = 0; c < count; ++c) numbers[c] *= length / present;
}

/// Great-arc interpolation. Lengths near 1 are interpolated as well.
Quaternion slerp(Quaternion a, Quaternion b, double u) {
    if (a == b) return a;
    const double length = (1.0 - u) * length_of(a.data(), 4) + u * length_of(b.data(), 4);
    double dot = 0.0;
    for (std::size_t c = 0; c < 4; ++c) dot += a[c] * b[c];
    if (dot < 0.0) {
        for (double& number : b) number = -number;
    }
    scale_to(1.0, a.data(), 4);
    scale_to(1.0, b.data(), 4);
    Quaternion sum{};
    Quaternion difference{};
    for (std::size_t c = 0; c < 4; ++c) {
        sum[c] = a[c] + b[c];
        difference[c] = b[c] - a[c];
    }
    const double cosine = length_of(sum.data(), 4);       // twice the cosine of half the angle
    const double sine = length_of(difference.data(), 4);  // twice its sine
    double of_a = 1.0 - u;
    double of_b = u;
    constexpr double kShort = 1e-8;  // below this the chord replaces the arc
    if (sine > kShort) {
        const trig::SinCos part = trig::sin_cos(u * 2.0 * trig::atan2(sine, cosine));
        of_b = part.sin / (0.5 * sine * cosine);
        of_a = part.cos - 0.25 * (cosine * cosine - sine * sine) * of_b;
    }
    Quaternion result{};
    for (std::size_t c = 0; c < 4; ++c) result[c] = of_a * a[c] + of_b * b[c];
    scale_to(length, result.data(), 4);
    return result;
}

/// glTF's cubic spline between two keys `seconds` apart; a key is in-tangent, value, out-tangent.
double hermite(double value, double out_tangent, double in_tangent, double next, double u, double seconds) {
    const double rest = 1.0 - u;
    return rest * rest * (1.0 + 2.0 * u) * value + u * rest * rest * seconds * out_tangent +
           u * u * (3.0 - 2.0 * u) * next - u * u * rest * seconds * in_tangent;
}

struct Placement {
    glm::dvec3 translation;
    Quaternion rotation;
    glm::dvec3 scale;
};

/// T * R * U, see Transform.
glm::dmat4 to_matrix(const Placement& local, const glm::dvec3& shear) {
    const auto [x, y, z, w] = local.rotation;
    const glm::dvec3 r0(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y));
    const glm::dvec3 r1(2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x));
    const glm::dvec3 r2(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y));
    return {glm::dvec4(local.scale.x * r0, 0.0), glm::dvec4(shear.x * r0 + local.scale.y * r1, 0.0),
            glm::dvec4(shear.y * r0 + shear.z * r1 + local.scale.z * r2, 0.0), glm::dvec4(local.translation, 1.0)};
}

std::vector<Placement> rest_locals(const Scene& scene) {
    std::vector<Placement> locals;
    locals.reserve(scene.joints.size());
    for (const Joint& joint : scene.joints) {
        const glm::vec4& r = joint.rest.rotation;
        locals.push_back({glm::dvec3(joint.rest.translation), {r.x, r.y, r.z, r.w}, glm::dvec3(joint.rest.scale)});
    }
    return locals;
}

void rest_weights(const Scene& scene, EvaluatedPose& pose) {
    pose.morph_weights.resize(scene.meshes.size());
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        std::vector<double>& weights = pose.morph_weights[mesh];
        weights.clear();
        for (const MorphTarget& target : scene.meshes[mesh].targets) weights.push_back(target.rest_weight);
    }
}

/// The product of two matrices whose last rows are 0, 0, 0, 1.
glm::dmat4 product(const glm::dmat4& a, const glm::dmat4& b) {
    glm::dmat4 result;
    for (int c = 0; c < 3; ++c) result[c] = a[0] * b[c].x + a[1] * b[c].y + a[2] * b[c].z;
    result[3] = a[0] * b[3].x + a[1] * b[3].y + a[2] * b[3].z + a[3];
    return result;
}

void to_model_space(const Scene& scene, const std::vector<Placement>& locals, EvaluatedPose& pose) {
    pose.joints.resize(scene.joints.size());
    for (std::size_t joint = 0; joint < locals.size(); ++joint) {
        const glm::dmat4 local = to_matrix(locals[joint], glm::dvec3(scene.joints[joint].rest.shear));
        const std::uint32_t parent = scene.joints[joint].parent;
        pose.joints[joint] = parent == kNone ? local : product(pose.joints[parent], local);
    }
}

/// The number of the first key after a time. \param near  the key before it or the one before that, if known
std::size_t first_after(std::span<const float> times, double seconds, std::size_t near) {
    for (std::size_t key = near; key < times.size() && key <= near + 1; ++key) {
        if (!(times[key] <= seconds)) break;
        if (key + 1 == times.size() || seconds < times[key + 1]) return key + 1;
    }
    return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), seconds) - times.begin());
}

}  // namespace

void evaluate_track(const Track& track, double seconds, std::vector<double>& value) {
    std::size_t near_key = 0;
    evaluate_track(track, seconds, value, near_key);
}

void evaluate_track(const Track& track, double seconds, std::vector<double>& value, std::size_t& near_key) {
    const std::size_t n = track.components;
    const bool cubic = track.interpolation == Interpolation::cubic;
    const std::size_t per_key = cubic ? 3 * n : n;
    const auto at = [&](std::size_t key, std::size_t part, std::size_t c) {
        return double{track.values[key * per_key + part * n + c]};
    };
    const std::size_t middle = cubic ? 1 : 0;  // offset of the value within a key
    value.resize(n);

    const std::size_t after = first_after(track.times, seconds, near_key);
    const std::size_t left = after == 0 ? 0 : after - 1;
    near_key = left;
    const bool holds = after == 0 || after == track.times.size() || track.times[left] == seconds;
    if (holds || track.interpolation == Interpolation::step) {
        for (std::size_t c = 0; c < n; ++c) value[c] = at(left, middle, c);
        if (cubic && track.path == TrackPath::rotation) scale_to(1.0, value.data(), n);
        return;
    }
    const double length = double{track.times[left + 1]} - track.times[left];
    const double u = (seconds - track.times[left]) / length;
    if (cubic) {
        for (std::size_t c = 0; c < n; ++c)
            value[c] = hermite(at(left, 1, c), at(left, 2, c), at(left + 1, 0, c), at(left + 1, 1, c), u, length);
        if (track.path == TrackPath::rotation) scale_to(1.0, value.data(), n);
        return;
    }
    if (track.path == TrackPath::rotation) {
        const Quaternion result =
            slerp({at(left, 0, 0), at(left, 0, 1), at(left, 0, 2), at(left, 0, 3)},
                  {at(left + 1, 0, 0), at(left + 1, 0, 1), at(left + 1, 0, 2), at(left + 1, 0, 3)}, u);
        std::copy(result.begin(), result.end(), value.begin());
        return;
    }
    for (std::size_t c = 0; c < n; ++c) value[c] = (1.0 - u) * at(left, 0, c) + u * at(left + 1, 0, c);
}

void evaluate_rest(const Scene& scene, EvaluatedPose& pose) {
    rest_weights(scene, pose);
    to_model_space(scene, rest_locals(scene), pose);
}

void evaluate(const Scene& scene, const Clip& clip, double seconds, EvaluatedPose& pose) {
    rest_weights(scene, pose);
    std::vector<Placement> locals = rest_locals(scene);
    std::vector<double> value;
    pose.near_keys.resize(clip.tracks.size());
    for (std::size_t number = 0; number < clip.tracks.size(); ++number) {
        const Track& track = clip.tracks[number];
        evaluate_track(track, seconds, value, pose.near_keys[number]);
        switch (track.path) {
            case TrackPath::translation:
                locals[track.target].translation = {value[0], value[1], value[2]};
                break;
            case TrackPath::rotation:
                locals[track.target].rotation = {value[0], value[1], value[2], value[3]};
                break;
            case TrackPath::scale:
                locals[track.target].scale = {value[0], value[1], value[2]};
                break;
            case TrackPath::weights:
                pose.morph_weights[track.target] = value;
                break;
        }
    }
    for (const Play& play : clip.plays) {
        const FramePair pair = frames_at(clip, play, seconds);
        std::vector<double>& weights = pose.morph_weights[play.mesh];
        const auto add = [&](std::uint32_t frame, double weight) {
            if (frame != 0) weights[first_frame(scene.meshes[play.mesh]) + frame - 1] += weight;
        };
        add(pair.left, 1.0 - pair.fraction);
        add(pair.right, pair.fraction);
    }
    to_model_space(scene, locals, pose);
}

std::vector<glm::dvec3> evaluate_vertices(const Mesh& mesh, const std::vector<double>& morph_weights,
                                          const std::vector<glm::dmat4>& joints) {
    std::vector<glm::dvec3> vertices(mesh.positions.begin(), mesh.positions.end());
    for (std::size_t number = 0; number < morph_weights.size(); ++number) {
        if (morph_weights[number] == 0.0) continue;
        const MorphTarget& target = mesh.targets[number];
        for (std::size_t vertex = 0; vertex < target.positions.size(); ++vertex)
            vertices[vertex] += morph_weights[number] * shift_of(target, target.positions, mesh.positions, vertex);
    }
    std::vector<glm::dmat4> palette;
    for (std::size_t entry = 0; entry < mesh.palette.joints.size(); ++entry)
        palette.push_back(joints[mesh.palette.joints[entry]] * glm::dmat4(mesh.palette.inverse_bind[entry]));
    for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
        const glm::dvec4 point(vertices[vertex], 1.0);
        if (mesh.influences == 0) {
            if (mesh.joint != kNone) vertices[vertex] = glm::dvec3(joints[mesh.joint] * point);
            continue;
        }
        glm::dvec4 sum(0.0);
        for (std::size_t place = vertex * mesh.influences; place < (vertex + 1) * mesh.influences; ++place) {
            if (mesh.weights[place] == 0.0f) continue;
            sum += double{mesh.weights[place]} * (palette[mesh.bones[place]] * point);
        }
        vertices[vertex] = glm::dvec3(sum);
    }
    return vertices;
}

std::vector<EvaluatedPose> sample_poses(const Scene& scene, std::size_t most, std::size_t most_of_clip) {
    constexpr std::size_t kMostMatrices = std::size_t{1} << 18U;
    std::vector<EvaluatedPose> poses(1);
    evaluate_rest(scene, poses.front());
    most = std::min(most, kMostMatrices / std::max<std::size_t>(scene.joints.size(), 1));
    const std::size_t clips = std::min(scene.clips.size(), most);
    for (std::size_t c = 0; c < clips; ++c) {
        const ClipSpan span = span_of(scene.clips[c]);
        const std::size_t count = std::clamp<std::size_t>(most / clips, 1, most_of_clip);
        for (std::size_t k = 0; k < count; ++k) {
            const double share = count == 1 ? 0.5 : static_cast<double>(k) / static_cast<double>(count - 1);
            evaluate(scene, scene.clips[c], span.at(share), poses.emplace_back());
        }
    }
    return poses;
}

namespace {

/// The box's height, or its largest side if it is flat; 0 if empty.
double height_of(const Box<glm::dvec3>& box) {
    if (box.is_empty()) return 0.0;
    constexpr double kFlat = 1e-3;  // of the largest side
    const glm::dvec3 size = box.high - box.low;
    const double largest = std::max({size.x, size.y, size.z});
    return size.y > kFlat * largest ? size.y : largest;
}

void add_origins(const EvaluatedPose& pose, Box<glm::dvec3>& box) {
    for (const glm::dmat4& joint : pose.joints) box.add(glm::dvec3(joint[3]));
}

double height_of_joints(const Scene& scene, EvaluatedPose& pose) {
    if (scene.joints.empty()) return 0.0;
    Box<glm::dvec3> box;
    add_origins(pose, box);
    if (height_of(box) > 0.0) return height_of(box);
    constexpr int kSamples = 32;  // of a clip
    for (const Clip& clip : scene.clips) {
        const ClipSpan span = span_of(clip);
        for (int k = 0; k <= kSamples; ++k) {
            evaluate(scene, clip, span.at(static_cast<double>(k) / kSamples), pose);
            add_origins(pose, box);
        }
    }
    return height_of(box) > 0.0 ? height_of(box) : 1.0;
}

}  // namespace

double height_at_rest(const Scene& scene) {
    EvaluatedPose rest;
    evaluate_rest(scene, rest);
    Box<glm::dvec3> box;
    for (const Mesh& mesh : scene.meshes) {
        for (const glm::dvec3& posed : evaluate_vertices(mesh, {}, rest.joints)) box.add(posed);
    }
    return box.is_empty() ? height_of_joints(scene, rest) : height_of(box);
}

}  // namespace bendy::converter
