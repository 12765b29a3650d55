#pragma once

#include <bendy/converter/scene.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace bendy::converter::test {

/// Numbers that are the same on every machine.
class Numbers {
public:
    explicit Numbers(std::uint32_t seed) : engine_(seed) {}
    float between(float low, float high) {
        return low + (high - low) * static_cast<float>(engine_() % 10'001) / 10'000.0f;
    }
    std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(engine_() % count); }
    glm::vec3 vector(float size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
    glm::vec4 rotation() {
        const glm::vec4 q(vector(1.0f), between(0.2f, 1.0f));
        return q / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    }

private:
    std::mt19937 engine_;
};

inline void put(std::vector<float>& values, const glm::vec3& v) {
    values.insert(values.end(), {v.x, v.y, v.z});
}

inline void put(std::vector<float>& values, const glm::vec4& v) {
    values.insert(values.end(), {v.x, v.y, v.z, v.w});
}

inline Track random_track(Numbers& numbers, TrackPath path, Interpolation interpolation, std::uint32_t target) {
    Track track;
    track.path = path;
    track.interpolation = interpolation;
    track.target = target;
    track.components = path == TrackPath::rotation ? 4 : 3;
    const std::uint32_t keys = 1 + numbers.below(6);
    for (std::uint32_t key = 0; key < keys; ++key) {
        track.times.push_back((track.times.empty() ? 0.0f : track.times.back()) + numbers.between(0.05f, 0.3f));
        for (unsigned part = 0; part < (interpolation == Interpolation::cubic ? 3u : 1u); ++part) {
            const bool is_tangent = interpolation == Interpolation::cubic && part != 1;
            if (path == TrackPath::rotation) {
                put(track.values, is_tangent ? glm::vec4(numbers.vector(1.0f), 0.1f) : numbers.rotation());
            } else if (path == TrackPath::scale && !is_tangent) {
                put(track.values, glm::vec3(1.0f) + numbers.vector(0.3f));
            } else {
                put(track.values, numbers.vector(0.5f));
            }
        }
    }
    return track;
}

/// Joints in a few branches with shear, a skinned mesh with two targets, a rigid one, two clips with every path and
/// interpolation.
inline Scene random_scene(std::uint32_t seed) {
    Numbers numbers(seed);
    Scene scene;
    constexpr std::uint32_t kJoints = 8;
    for (std::uint32_t number = 0; number < kJoints; ++number) {
        Joint joint;
        joint.parent = number == 0 ? kNone : number == 5 ? 2 : number - 1;
        joint.rest.translation = numbers.vector(1.0f);
        joint.rest.rotation = numbers.rotation();
        joint.rest.scale = glm::vec3(1.0f) + numbers.vector(0.4f);
        if (number % 3 == 1) joint.rest.shear = numbers.vector(0.2f);
        scene.joints.push_back(joint);
    }
    Mesh skin;
    constexpr std::uint32_t kVertices = 60;
    skin.joint = 0;
    skin.influences = 3;
    skin.palette.joints = {1, 3, 4, 6};
    for (std::size_t entry = 0; entry < skin.palette.joints.size(); ++entry) {
        glm::mat4 matrix(1.0f);
        for (int column = 0; column < 4; ++column) matrix[column] += glm::vec4(numbers.vector(0.3f), 0.0f);
        skin.palette.inverse_bind.push_back(matrix);
    }
    for (std::uint32_t vertex = 0; vertex < kVertices; ++vertex) {
        skin.positions.push_back(numbers.vector(1.0f));
        const std::uint32_t first = numbers.below(4);
        const float weight = 0.25f * static_cast<float>(numbers.below(5));
        for (const std::uint32_t bone : {first, (first + 1) % 4, (first + 2) % 4}) skin.bones.push_back(bone);
        for (const float w : {weight, 1.0f - weight, 0.0f}) skin.weights.push_back(w);
    }
    skin.targets.resize(2);
    skin.targets[0].rest_weight = 0.25f;
    for (MorphTarget& target : skin.targets) {
        target.positions.resize(kVertices, glm::vec3(0.0f));
        for (std::uint32_t k = 0; k < kVertices / 3; ++k)
            target.positions[numbers.below(kVertices)] = numbers.vector(0.2f);
    }
    skin.submeshes = {{Topology::triangles, kNone, {0, 1, 2, 3, 4, 5}}};
    scene.meshes.push_back(skin);
    Mesh hat;
    hat.joint = 7;
    hat.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    hat.submeshes = {{Topology::triangles, kNone, {0, 1, 2}}};
    scene.meshes.push_back(hat);
    for (unsigned number = 0; number < 2; ++number) {
        Clip clip;
        for (std::uint32_t joint = 0; joint < kJoints; ++joint) {
            for (const TrackPath path : {TrackPath::translation, TrackPath::rotation, TrackPath::scale}) {
                if (numbers.below(3) == 0) continue;
                const auto interpolation = static_cast<Interpolation>(numbers.below(3));
                clip.tracks.push_back(random_track(numbers, path, interpolation, joint));
            }
        }
        Track weights{TrackPath::weights,    Interpolation::linear,    0, 2,
                      {0.125f, 0.5f, 0.75f}, {0, 0, 1, 0.5f, 0, 0.25f}};
        if (number == 0) clip.tracks.push_back(weights);
        scene.clips.push_back(clip);
    }
    return scene;
}

}  // namespace bendy::converter::test
