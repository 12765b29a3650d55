#include "optimise/passes/auto_skin.h"

#include "rigging/rig/joint_key.h"
#include "scene/evaluate.h"
#include "scene/failure.h"
#include "scene/space.h"

#include <bendy/format/names.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

/// A line from a joint to a child, in model space.
struct Bone {
    std::uint32_t joint;
    glm::dvec3 start;
    glm::dvec3 along;             ///< from start to end
    double length_squared = 0.0;  ///< of `along`
};

struct Binding {
    Palette palette;
    std::vector<std::uint32_t> bones;  ///< by vertex: palette entry
};

using Flags = std::vector<bool>;  // by joint

Flags joints_of_skins(const Scene& scene) {
    Flags found(scene.joints.size());
    for (std::size_t joint = 0; joint < scene.joints.size(); ++joint) found[joint] = scene.joints[joint].in_skin;
    for (const Mesh& mesh : scene.meshes) {
        for (const std::uint32_t joint : mesh.palette.joints) found[joint] = true;
    }
    return found;
}

/// Joints without a mesh on them or on any descendant.
Flags joints_without_meshes(const Scene& scene) {
    Flags found(scene.joints.size(), true);
    for (const Mesh& mesh : scene.meshes) {
        for (std::uint32_t joint = mesh.joint; joint != kNone && found[joint]; joint = scene.joints[joint].parent)
            found[joint] = false;
    }
    return found;
}

/// The vertices in model space, at rest.
std::vector<glm::dvec3> vertices_at_rest(const Scene& scene, std::size_t mesh, const EvaluatedPose& rest) {
    return evaluate_vertices(scene.meshes[mesh], rest.morph_weights[mesh], rest.joints);
}

/// The paper's hierarchy of part meshes: the topmost joints that carry a mesh and have one below them, with all that is
/// below. None, unless the other meshes, the skin, enclose these parts.
Flags joints_of_parts(const Scene& scene, const EvaluatedPose& rest) {
    const auto count = static_cast<std::uint32_t>(scene.joints.size());
    Flags has_mesh(count);
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.joint != kNone) has_mesh[mesh.joint] = true;
    }
    Flags has_mesh_below(count);
    for (std::uint32_t joint = count; joint-- > 0;) {
        const std::uint32_t parent = scene.joints[joint].parent;
        if (parent != kNone && (has_mesh[joint] || has_mesh_below[joint])) has_mesh_below[parent] = true;
    }
    Flags found(count);
    for (std::uint32_t joint = 0; joint < count; ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        found[joint] = (parent != kNone && found[parent]) || (has_mesh[joint] && has_mesh_below[joint]);
    }
    Box<glm::dvec3> parts;
    Box<glm::dvec3> skin;
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        const std::uint32_t joint = scene.meshes[mesh].joint;
        Box<glm::dvec3>& box = joint != kNone && found[joint] ? parts : skin;
        for (const glm::dvec3& vertex : vertices_at_rest(scene, mesh, rest)) box.add(vertex);
    }
    if (parts.is_empty() || skin.is_empty()) return Flags(count);
    const glm::dvec3 slack(0.01 * glm::length(skin.high - skin.low));
    const bool is_inside = glm::all(glm::lessThanEqual(skin.low - slack, parts.low)) &&
                           glm::all(glm::lessThanEqual(parts.high, skin.high + slack));
    return is_inside ? found : Flags(count);
}

/// The joint that the text names, and its descendants.
Result<Flags, KeyProblem> joints_below(const Scene& scene, const std::string& top) {
    std::vector<std::string_view> names;
    for (const Joint& joint : scene.joints) names.emplace_back(joint.name);
    const auto joint = find_by_key(names, top, "joint");
    if (!joint) return joint.error();
    Flags found(scene.joints.size());
    const auto first = static_cast<std::uint32_t>(*joint);
    std::fill(found.begin() + first, found.begin() + JointIndex(scene).end(first), true);
    return found;
}

bool has_any(const Flags& flags) {
    return std::find(flags.begin(), flags.end(), true) != flags.end();
}

/// A joint without volume cannot carry a vertex.
bool can_carry(const glm::dmat4& matrix) {
    const double volume = glm::determinant(glm::dmat3(matrix));
    return std::isfinite(1.0 / volume);
}

/// The bones of a skeleton, by joint.
std::vector<Bone> find_bones(const Scene& scene, const Flags& skeleton, const std::vector<glm::dmat4>& matrices) {
    const auto place = [&](std::uint32_t joint) { return glm::dvec3(matrices[joint][3]); };
    std::vector<Bone> bones;
    const auto add = [&](std::uint32_t joint, const glm::dvec3& along) {
        if (can_carry(matrices[joint])) bones.push_back({joint, place(joint), along, glm::dot(along, along)});
    };
    Flags has_child(scene.joints.size());
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        if (!skeleton[joint] || parent == kNone || !skeleton[parent]) continue;
        has_child[parent] = true;
        add(parent, place(joint) - place(parent));
    }
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        if (!skeleton[joint] || has_child[joint]) continue;
        const std::uint32_t parent = scene.joints[joint].parent;
        const bool goes_on = parent != kNone && skeleton[parent];
        add(joint, goes_on ? 0.5 * (place(joint) - place(parent)) : glm::dvec3(0.0));
    }
    std::stable_sort(bones.begin(), bones.end(), [](const Bone& a, const Bone& b) { return a.joint < b.joint; });
    return bones;
}

double distance_squared(const glm::dvec3& point, const Bone& bone) {
    const glm::dvec3 from_start = point - bone.start;
    const double share = bone.length_squared > 0.0 ? glm::dot(from_start, bone.along) / bone.length_squared : 0.0;
    const glm::dvec3 apart = from_start - std::clamp(share, 0.0, 1.0) * bone.along;
    return glm::dot(apart, apart);
}

std::uint32_t nearest_joint(const glm::dvec3& point, const std::vector<Bone>& bones) {
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = bones.front().joint;
    for (const Bone& bone : bones) {
        const double distance = distance_squared(point, bone);
        if (distance < least) {
            least = distance;
            nearest = bone.joint;
        }
    }
    return nearest;
}

Binding bind_vertices(const std::vector<glm::dvec3>& vertices, const std::vector<Bone>& bones,
                      const glm::dmat4& mesh_to_model, const std::vector<glm::dmat4>& matrices) {
    Binding binding;
    std::vector<std::uint32_t> joint_of_vertex(vertices.size());
    for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex)
        joint_of_vertex[vertex] = nearest_joint(vertices[vertex], bones);
    std::vector<std::uint32_t>& joints = binding.palette.joints;
    joints = joint_of_vertex;
    std::sort(joints.begin(), joints.end());
    joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
    for (const std::uint32_t joint : joints)
        binding.palette.inverse_bind.emplace_back(glm::inverse(matrices[joint]) * mesh_to_model);
    std::unordered_map<std::uint32_t, std::uint32_t> entry_of;
    for (std::uint32_t entry = 0; entry < joints.size(); ++entry) entry_of[joints[entry]] = entry;
    for (const std::uint32_t joint : joint_of_vertex) binding.bones.push_back(entry_of[joint]);
    return binding;
}

bool is_finite(const Palette& palette) {
    return std::all_of(palette.inverse_bind.begin(), palette.inverse_bind.end(), [](const glm::mat4& matrix) {
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < 4; ++row) {
                if (!std::isfinite(matrix[column][row])) return false;
            }
        }
        return true;
    });
}

/// Joints without meshes; or part meshes, if only these have such joints below them.
Flags skeleton_without_skins(const Scene& scene, const EvaluatedPose& rest, Report& report) {
    Flags bare = joints_without_meshes(scene);
    Flags parts = joints_of_parts(scene, rest);
    const auto bones = static_cast<std::size_t>(std::count(parts.begin(), parts.end(), true));
    const bool are_parts = std::equal(bare.begin(), bare.end(), parts.begin(),
                                      [](bool is_bare, bool is_part) { return !is_bare || is_part; });
    if (bones == 0 || !are_parts) return bare;
    report.warn("the skin is bound to the " + counted(bones, "joint") +
                " whose part meshes lie inside it; --skeleton takes others");
    return parts;
}

/// The meshes that are to be bound.
std::vector<std::size_t> find_free_meshes(const Scene& scene, const Flags& skeleton) {
    Flags carried = skeleton;  // by a joint of the skeleton, or by a descendant of one
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        if (parent != kNone && carried[parent]) carried[joint] = true;
    }
    std::vector<std::size_t> found;
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        const Mesh& candidate = scene.meshes[mesh];
        const bool is_carried = candidate.joint != kNone && carried[candidate.joint];
        if (candidate.influences == 0 && !candidate.positions.empty() && !is_carried) found.push_back(mesh);
    }
    return found;
}

}  // namespace

Result<void, ImportError> auto_skin(Scene& scene, const std::string& skeleton, Report& report) {
    EvaluatedPose pose;
    evaluate_rest(scene, pose);
    Flags joints = joints_of_skins(scene);
    if (!skeleton.empty()) {
        auto below = joints_below(scene, skeleton);
        if (!below) return ImportError{"skeleton", below.error().message};
        joints = *std::move(below);
    } else if (!has_any(joints)) {
        joints = skeleton_without_skins(scene, pose, report);
    }
    const std::vector<Bone> bones = find_bones(scene, joints, pose.joints);
    const std::vector<std::size_t> meshes = find_free_meshes(scene, joints);
    if (bones.empty() || meshes.empty()) {
        report.warn(bones.empty()
                        ? "no vertices bound: the file has no skeleton; --skeleton takes a joint and all below it"
                        : "no vertices bound: every mesh has a skin or hangs on a joint of the skeleton");
        return {};
    }
    constexpr std::uint64_t kMostWork = std::uint64_t{1} << 33;
    std::uint64_t vertices = 0;
    for (const std::size_t mesh : meshes) vertices += scene.meshes[mesh].positions.size();
    if (vertices > kMostWork / bones.size()) {
        return ImportError{{},
                           counted(vertices, "vertex", "vertices") + " and " + counted(bones.size(), "bone") +
                               " are too many to find the nearest"};
    }
    for (const std::size_t number : meshes) {
        Mesh& mesh = scene.meshes[number];
        const glm::dmat4 mesh_to_model = mesh.joint == kNone ? glm::dmat4(1.0) : pose.joints[mesh.joint];
        Binding binding = bind_vertices(vertices_at_rest(scene, number, pose), bones, mesh_to_model, pose.joints);
        const std::string name = mesh.name.empty() ? '#' + std::to_string(number) : quote(mesh.name);
        if (!is_finite(binding.palette)) {
            report.warn("no vertices of mesh " + name + " bound: its joints are too small to hold them");
            continue;
        }
        mesh.influences = 1;
        mesh.palette = std::move(binding.palette);
        mesh.bones = std::move(binding.bones);
        mesh.weights.assign(mesh.bones.size(), 1.0f);
        report.propose({Proposal::Kind::skin, name,
                        "skin of mesh " + name + ": " + counted(mesh.bones.size(), "vertex", "vertices") +
                            " bound to " + counted(mesh.palette.joints.size(), "joint")});
    }
    return {};
}

}  // namespace bendy::converter
