#pragma once

#include "../gltf/build_gltf.h"
#include "scene/rest_frames.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter::test {

inline constexpr double kTestDegree = std::numbers::pi / 180.0;

/// A human in a T-pose, metres, looking along +Z, as joints without a mesh. Every joint's axes are turned by something
/// of its own: nothing may hang on them. Bones have VRM's names until they are renamed.
class HumanoidGltf {
public:
    struct Bone {
        std::string name;
        std::string parent;
        glm::dvec3 position;
    };

    HumanoidGltf() {
        add("hips", "", {0, 1, 0});
        add("spine", "hips", {0, 1.1, 0});
        add("chest", "spine", {0, 1.25, 0});
        add("neck", "chest", {0, 1.5, 0});
        add("head", "neck", {0, 1.6, 0});
        for (const double side : {1.0, -1.0}) {
            const std::string s = side > 0 ? "left" : "right";
            add(s + "Shoulder", "chest", {side * 0.05, 1.45, 0});
            add(s + "UpperArm", s + "Shoulder", {side * 0.2, 1.45, 0});
            add(s + "LowerArm", s + "UpperArm", {side * 0.5, 1.45, 0});
            add(s + "Hand", s + "LowerArm", {side * 0.75, 1.45, 0});
            add(s + "UpperLeg", "hips", {side * 0.1, 0.95, 0});
            add(s + "LowerLeg", s + "UpperLeg", {side * 0.1, 0.5, 0});
            add(s + "Foot", s + "LowerLeg", {side * 0.1, 0.1, 0});
            add(s + "Toes", s + "Foot", {side * 0.1, 0.02, 0.15});
        }
    }

    void add(const std::string& name, const std::string& parent, glm::dvec3 position) {
        bones.push_back({name, parent, position});
    }
    Bone& operator[](const std::string& name) {
        for (Bone& bone : bones) {
            if (bone.name == name) return bone;
        }
        ADD_FAILURE() << "no bone " << name;
        return bones.front();
    }
    /// Turns the whole character about the Y axis, or moves and turns what `place` says.
    template <class Place>
    void move(Place place) {
        for (Bone& bone : bones) bone.position = place(bone.position);
    }

    /// Nodes in the order of `bones`, behind one that is in no scene: node numbers are not joint numbers.
    [[nodiscard]] Gltf build() const {
        Gltf gltf;
        gltf.add_node({{"name", "elsewhere"}});
        std::map<std::string, std::size_t> number;
        for (std::size_t i = 0; i < bones.size(); ++i) number[bones[i].name] = i;
        Json roots = Json::array();
        for (std::size_t i = 0; i < bones.size(); ++i) {
            glm::dquat parent_axes(1, 0, 0, 0);
            glm::dvec3 parent_position(0);
            if (bones[i].parent.empty()) {
                roots.push_back(i + 1);
            } else {
                const std::size_t parent = number.at(bones[i].parent);
                parent_axes = axes_of(parent);
                parent_position = bones[parent].position;
            }
            const glm::dvec3 t = glm::conjugate(parent_axes) * (bones[i].position - parent_position);
            const glm::dquat q = glm::conjugate(parent_axes) * axes_of(i);
            const auto renamed = names.find(bones[i].name);
            Json node = {{"name", renamed == names.end() ? bones[i].name : renamed->second},
                         {"translation", {t.x, t.y, t.z}},
                         {"rotation", {q.x, q.y, q.z, q.w}}};
            for (std::size_t c = 0; c < bones.size(); ++c) {
                if (bones[c].parent == bones[i].name) node["children"].push_back(c + 1);
            }
            gltf.add_node(std::move(node));
        }
        gltf.json["scenes"] = {{{"nodes", roots}}};
        return gltf;
    }

    /// With the humanoid of VRM 1.0, or of 0.x, of the bones that it knows.
    [[nodiscard]] Gltf build_vrm(bool is_old = false) const {
        Gltf gltf = build();
        for (std::size_t i = 0; i < bones.size(); ++i) {
            if (is_old) {
                gltf.json["extensions"]["VRM"]["humanoid"]["humanBones"].push_back(
                    {{"bone", bones[i].name}, {"node", i + 1}, {"useDefaultValues", true}});
            } else {
                gltf.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"][bones[i].name] = {{"node", i + 1}};
            }
        }
        return gltf;
    }

    /// Axes of a bone in model space.
    [[nodiscard]] static glm::dquat axes_of(std::size_t bone) {
        const auto angle = static_cast<double>(bone);
        return glm::normalize(glm::dquat(std::cos(angle), std::sin(angle), std::cos(2 * angle), std::sin(3 * angle)));
    }

    std::vector<Bone> bones;
    std::map<std::string, std::string> names;  ///< other names, by the bones' own
};

inline std::uint32_t joint_named(const Scene& scene, const std::string& name) {
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        if (scene.joints[joint].name == name) return joint;
    }
    ADD_FAILURE() << "no joint " << name;
    return 0;
}

/// Adds a mesh of one vertex that all joints are bound to where they rest.
inline void bind_at_rest(Scene& scene) {
    Mesh mesh;
    mesh.influences = 1;
    mesh.positions.resize(3);
    mesh.bones.assign(3, 0);
    mesh.weights.assign(3, 1.0f);
    const RestFrames frames(scene);
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        mesh.palette.joints.push_back(joint);
        const glm::dmat4 bind =
            glm::translate(glm::dmat4(1.0), frames.position(joint)) * glm::mat4_cast(frames.turn(joint));
        mesh.palette.inverse_bind.emplace_back(glm::inverse(bind));
    }
    scene.meshes.push_back(mesh);
}

inline const Chain* find_chain(const Scene& scene, const std::string& name) {
    for (const Chain& chain : scene.chains) {
        if (chain.name == name) return &chain;
    }
    return nullptr;
}

inline std::uint64_t warned(const Report& report, std::string_view text) {
    std::uint64_t count = 0;
    for (const Warning& warning : report.warnings()) {
        if (warning.message.find(text) != std::string::npos || warning.first_place.find(text) != std::string::npos)
            count += warning.count;
    }
    return count;
}

/// Where a joint is in model space if another one's R (see LIMT) is a rotation by this angle, radians, about axis 0, 1
/// or 2 of its first limit's frame.
inline glm::dvec3 moved(const Scene& scene, std::uint32_t joint, std::uint32_t turned, int axis, double angle) {
    const auto quaternion = [](const auto& q) { return glm::dquat(q[3], q[0], q[1], q[2]); };
    glm::dvec3 point(0);
    for (std::uint32_t j = joint; j != kNone; j = scene.joints[j].parent) {
        const Joint& at = scene.joints[j];
        glm::dquat q = quaternion(at.rest.rotation);
        if (j == turned) {
            const glm::dquat frame = quaternion(at.constraints.at(0).frame);
            glm::dvec3 about(0);
            about[axis] = 1;
            q = q * frame * glm::angleAxis(angle, about) * glm::conjugate(frame);
        }
        point = glm::dvec3(at.rest.translation) + q * point;
    }
    return point;
}

/// A character that walks on all fours, with a human's names.
inline HumanoidGltf make_quadruped() {
    HumanoidGltf animal;
    animal["hips"].position = {0, 0.6, -0.4};
    animal["spine"].position = {0, 0.62, -0.2};
    animal["chest"].position = {0, 0.62, 0.2};
    animal["neck"].position = {0, 0.7, 0.4};
    animal["head"].position = {0, 0.8, 0.5};
    for (const double side : {1.0, -1.0}) {
        const std::string s = side > 0 ? "left" : "right";
        animal[s + "Shoulder"].position = {side * 0.05, 0.6, 0.25};
        animal[s + "UpperArm"].position = {side * 0.1, 0.55, 0.3};
        animal[s + "LowerArm"].position = {side * 0.1, 0.3, 0.25};
        animal[s + "Hand"].position = {side * 0.1, 0.05, 0.3};
        animal[s + "UpperLeg"].position = {side * 0.1, 0.55, -0.4};
        animal[s + "LowerLeg"].position = {side * 0.1, 0.3, -0.3};
        animal[s + "Foot"].position = {side * 0.1, 0.1, -0.45};
        animal[s + "Toes"].position = {side * 0.1, 0.02, -0.38};
    }
    return animal;
}

}  // namespace bendy::converter::test
