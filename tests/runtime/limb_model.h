#pragma once

#include "runtime/build_model.h"
#include "runtime/local_joints.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace bendy::test {

/// Limbs as characters have them: chains of bones from a trunk, a cylinder of vertices about each chain with weights
/// that go over from bone to bone, in u8, u16 or floats; targets on some of them, dense and sparse; a rigid thing in a
/// hand, and one that nothing moves. Other numbers with another seed.
class LimbModel {
public:
    static constexpr std::uint32_t kBones = 5;   // of a limb
    static constexpr std::uint32_t kRings = 24;  // of its cylinder
    static constexpr std::uint32_t kSides = 10;
    static constexpr int kStill = 5;      // vertices that nothing moves: the last ones
    static constexpr float kBone = 0.3f;  // metres
    static constexpr float kRadius = 0.08f;

    explicit LimbModel(unsigned seed) : random_(seed) {
        spec.joints.push_back({kNone, moved(0.5f * number(), 1, 0.5f * number()), {}, "trunk"});
        places_.emplace_back(vec(spec.joints[0].rest.translation));
        turns_.emplace_back(1.0, 0.0, 0.0, 0.0);
        for (std::uint32_t limb = 0; limb < 4; ++limb) add_limb(limb);
        MeshSpec thing;
        thing.joint = kBones;  // the first limb's last
        for (int k = 0; k < 8; ++k) thing.positions.emplace_back(0.1f * number(), 0.5f * number(), 0.1f * number());
        thing.more = {target(8, {}, 0.2f)};
        spec.meshes.push_back(thing);
        MeshSpec still;
        for (int k = 0; k < kStill; ++k) still.positions.emplace_back(number(), 0.0f, number());
        spec.meshes.push_back(still);
    }

    float number() { return std::uniform_real_distribution<float>(-1.0f, 1.0f)(random_); }

    /// Joints turned anyhow about where they are at rest.
    void pose_at_random(Pose& pose, bool is_scaled, bool has_targets) {
        pose.set_rest();
        test::change_locals(pose, [&](JointTransform& local) {
            local.rotation =
                glm::normalize(local.rotation * glm::quat(1.0f, 0.8f * number(), 0.8f * number(), 0.8f * number()));
            if (is_scaled) local.scale = {1.0f + 0.4f * number(), 1.0f + 0.4f * number(), 1.2f * number()};
            if (is_scaled) local.translation += 0.2f * glm::vec3(number(), number(), number());
        });
        if (!has_targets) return;
        for (float& weight : pose.change_morph_weights()) weight = 1.5f * number();
    }

    ModelSpec spec;

private:
    static glm::vec3 vec(const std::array<float, 3>& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

    Node target(std::uint32_t vertices, const std::vector<std::uint16_t>& touched, float size) {
        MorphTargetRecord info;
        info.rest_weight = 0.0f;
        std::vector<float> shifts;
        const std::size_t count = touched.empty() ? vertices : touched.size();
        for (std::size_t k = 0; k < 3 * count; ++k) shifts.push_back(size * number());
        std::vector<Node> children{make_leaf(FourCC("TINF"), bytes_of(info))};
        if (!touched.empty()) children.push_back(make_leaf(FourCC("INDX"), stream_payload<std::uint16_t>(1, touched)));
        children.push_back(make_leaf(FourCC("POSI"), stream_payload<float>(3, shifts)));
        return make_container(FourCC("TARG"), children);
    }

    void add_limb(std::uint32_t limb) {
        const auto first = static_cast<std::uint32_t>(spec.joints.size());
        for (std::uint32_t bone = 0; bone < kBones; ++bone) {
            RestRecord rest;
            const glm::quat turn = glm::normalize(glm::quat(1.0f, 0.2f * number(), 0.2f * number(), 0.2f * number()));
            const std::uint32_t parent = bone == 0 ? 0 : first + bone - 1;
            rest.rotation = {turn.x, turn.y, turn.z, turn.w};
            rest.translation = {bone == 0 ? 0.3f * number() : 0.0f, kBone, bone == 0 ? 0.3f * number() : 0.0f};
            spec.joints.push_back({parent, rest, {}, ""});
            places_.push_back(places_[parent] + turns_[parent] * glm::dvec3(vec(rest.translation)));
            turns_.push_back(turns_[parent] * glm::dquat(turn));
        }
        spec.meshes.push_back(cylinder(first, limb));
    }

    /// About the bones where they rest, in model space.
    MeshSpec cylinder(std::uint32_t first, std::uint32_t limb) {
        MeshSpec mesh;
        std::vector<std::uint8_t> bones;
        std::vector<float> weights;
        for (std::uint32_t ring = 0; ring < kRings; ++ring) {
            const float along = static_cast<float>(ring) / static_cast<float>(kRings) * static_cast<float>(kBones);
            const auto bone = static_cast<std::uint32_t>(along);
            const float part = along - static_cast<float>(bone);
            for (std::uint32_t side = 0; side < kSides; ++side) {
                const double angle = 2.0 * M_PI * side / kSides;
                const glm::dvec3 local(kRadius * std::cos(angle), part * kBone, kRadius * std::sin(angle));
                mesh.positions.emplace_back(places_[first + bone] + turns_[first + bone] * local);
                const float next = bone + 1 < kBones ? std::max(0.0f, part - 0.5f) : 0.0f;
                const float before = bone > 0 ? std::max(0.0f, 0.5f - part) : 0.0f;
                bones.insert(bones.end(), {static_cast<std::uint8_t>(bone),
                                           static_cast<std::uint8_t>(bone + 1 < kBones ? bone + 1 : bone),
                                           static_cast<std::uint8_t>(bone > 0 ? bone - 1 : 0)});
                weights.insert(weights.end(), {1.0f - next - before, next, before});
            }
        }
        std::vector<std::uint32_t> joints;
        std::vector<glm::mat4> binds;
        for (std::uint32_t bone = 0; bone < kBones; ++bone) {
            joints.push_back(first + bone);
            glm::dmat4 place(glm::mat3_cast(turns_[first + bone]));
            place[3] = glm::dvec4(places_[first + bone], 1.0);
            binds.emplace_back(glm::inverse(place));
        }
        mesh.more = {make_leaf(FourCC("BONE"), stream_payload<std::uint8_t>(3, bones)), weight_leaf(weights, limb),
                     palette_leaf(joints, binds)};
        if (limb % 2 == 0) mesh.more.push_back(target(kRings * kSides, {}, 0.05f));
        if (limb == 2) mesh.more.push_back(target(kRings * kSides, {3, 50, 51, 120, 239}, 0.3f));
        return mesh;
    }

    static Node weight_leaf(const std::vector<float>& weights, std::uint32_t limb) {
        if (limb == 0) return make_leaf(FourCC("WGHT"), stream_payload<float>(3, weights));
        return limb == 1 ? integers<std::uint8_t>(weights, 255) : integers<std::uint16_t>(weights, 65535);
    }

    template <class T>
    static Node integers(const std::vector<float>& weights, int most) {
        std::vector<T> steps;
        for (std::size_t at = 0; at < weights.size(); at += 3) {
            const int second = static_cast<int>(weights[at + 1] * static_cast<float>(most));
            const int third = static_cast<int>(weights[at + 2] * static_cast<float>(most));
            for (const int part : {most - second - third, second, third}) steps.push_back(static_cast<T>(part));
        }
        return make_leaf(FourCC("WGHT"), stream_payload<T>(3, steps, true));
    }

    std::mt19937 random_;
    std::vector<glm::dvec3> places_;  // of joints at rest, model space
    std::vector<glm::dquat> turns_;
};

}  // namespace bendy::test
