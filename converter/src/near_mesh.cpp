#include "near_mesh.h"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace bendy::converter {
namespace {

/// At least the largest stretch: the length of all its numbers.
double length_of_all(const glm::dmat3& m) {
    return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

/// The palette of a mesh; a rigid one has a single bone. False if a matrix is none of an Affine.
bool take_palette(const Mesh& mesh, std::vector<std::uint32_t>& joints, std::vector<Affine>& binds) {
    if (mesh.influences == 0) {
        joints = {mesh.joint};
        binds = {Affine()};
        return mesh.joint != kNone;
    }
    joints = mesh.palette.joints;
    bool is_affine = true;
    for (const glm::mat4& bind : mesh.palette.inverse_bind) {
        binds.emplace_back(glm::dmat4(bind));
        is_affine = is_affine && glm::vec4(bind[0][3], bind[1][3], bind[2][3], bind[3][3]) == glm::vec4(0, 0, 0, 1);
    }
    return is_affine && std::find(joints.begin(), joints.end(), kNone) == joints.end();
}

/// Calls `visit` with each bone of a vertex and its weight, where that is not 0.
template <class Visit>
void for_each_influence(const Mesh& mesh, std::size_t vertex, Visit visit) {
    if (mesh.influences == 0) visit(std::uint32_t{0}, 1.0);
    for (std::size_t at = vertex * mesh.influences; at < (vertex + 1) * mesh.influences; ++at) {
        if (mesh.weights[at] != 0.0f) visit(mesh.bones[at], double{mesh.weights[at]});
    }
}

}  // namespace

NearMesh::NearMesh(const Mesh& exact, const Mesh& decoded, const std::vector<std::uint32_t>* map)
    : exact_(exact), decoded_(decoded) {
    can_tell_ = take_palette(exact, exact_joints_, exact_binds_) &&
                take_palette(decoded, decoded_joints_, decoded_binds_) && exact_joints_ == decoded_joints_;
    if (!can_tell_) return;
    bones_.resize(exact_joints_.size());
    std::map<std::vector<std::uint32_t>, std::size_t> group_of;
    std::vector<std::uint32_t> key;
    for (std::uint32_t v = 0; v < exact.positions.size(); ++v) {
        const std::uint32_t there = map == nullptr ? v : (v < map->size() ? (*map)[v] : kNone);
        if (there >= decoded.positions.size()) continue;
        key.clear();
        const auto add = [&](std::uint32_t bone, double) { key.push_back(bone); };
        for_each_influence(exact, v, add);
        for_each_influence(decoded, there, add);
        if (!std::all_of(key.begin(), key.end(), [&](std::uint32_t bone) { return bone < bones_.size(); })) {
            can_tell_ = false;
            return;
        }
        std::sort(key.begin(), key.end());
        key.erase(std::unique(key.begin(), key.end()), key.end());
        const auto [known, is_new] = group_of.try_emplace(key, groups_.size());
        if (is_new) groups_.emplace_back().bones = key;
        Group& group = groups_[known->second];
        group.changes.resize(key.size());
        std::vector<double> changes(key.size());
        double exact_total = 0.0;
        double decoded_total = 0.0;
        const auto at = [&](std::uint32_t bone) {
            return static_cast<std::size_t>(std::lower_bound(key.begin(), key.end(), bone) - key.begin());
        };
        for_each_influence(exact, v, [&](std::uint32_t bone, double weight) {
            changes[at(bone)] += weight;
            exact_total += std::abs(weight);
        });
        for_each_influence(decoded, there, [&](std::uint32_t bone, double weight) {
            changes[at(bone)] -= weight;
            decoded_total += std::abs(weight);
        });
        double total_change = 0.0;
        for (std::size_t k = 0; k < key.size(); ++k) {
            total_change += changes[k];
            group.changes[k] = std::max(group.changes[k], std::abs(changes[k]));
        }
        const glm::dvec3 place(exact.positions[v]);
        const glm::dvec3 place_there(decoded.positions[there]);
        group.vertices.push_back({v, there});
        group.box.add(place);
        group.place = std::max(group.place, glm::distance(place, place_there));
        group.exact_total = std::max(group.exact_total, exact_total);
        group.decoded_total = std::max(group.decoded_total, decoded_total);
        group.total_change = std::max(group.total_change, std::abs(total_change));
        reach_ = std::max({reach_, glm::length(place), glm::length(place_there)});
        can_tell_ = can_tell_ && std::isfinite(reach_ + exact_total + decoded_total);
    }
}

void NearMesh::set_bones(const NearPoses& poses, const std::vector<std::uint32_t>& joints,
                         const std::vector<Affine>& binds, Affine Bone::*place, double Bone::*doubt) {
    for (std::size_t k = 0; k < bones_.size(); ++k) {
        const Affine& joint = poses.places()[joints[k]];
        const Affine& bind = binds[k];
        const Doubt& of_joint = poses.doubts()[joints[k]];
        bones_[k].*place = joint * bind;
        const double above = of_joint.linear + kRotationDoubt * length_of_all(joint.linear);  // and what is rounded
        bones_[k].*doubt = above * (length_of_all(bind.linear) * reach_ + glm::length(bind.origin)) + of_joint.origin +
                           kRotationDoubt * glm::length(joint.origin);
    }
}

/// With P and Q the bones' matrices, p and p' the places, w and w' the weights of the exact and of the decoded scene,
/// and B one of the Q, a vertex is displaced by
///     sum w (P - Q) p + sum w' Q (p - p') + sum (w - w') (Q - B) p + (sum of w - w') B p
/// and the length of a matrix times p is at most that times the middle of the group, and what it stretches half the
/// group by.
double NearMesh::bound_of(const Group& group) const {
    const glm::dvec3 middle = 0.5 * (group.box.low + group.box.high);
    const double radius = 0.5 * glm::length(group.box.high - group.box.low);
    const Bone& base = bones_[group.bones.front()];
    double off = 0.0;
    double stretch = 0.0;
    double by_weights = 0.0;
    double doubt = 0.0;
    for (std::size_t k = 0; k < group.bones.size(); ++k) {
        const Bone& bone = bones_[group.bones[k]];
        const glm::dvec3 there = bone.decoded(middle);
        off = std::max(off, glm::distance(bone.exact(middle), there) +
                                length_of_all(bone.exact.linear - bone.decoded.linear) * radius);
        stretch = std::max(stretch, bone.stretch);
        doubt = std::max(doubt, bone.exact_doubt + 2.0 * bone.decoded_doubt);
        if (group.changes[k] == 0.0) continue;
        by_weights += group.changes[k] * (glm::distance(there, base.decoded(middle)) +
                                          length_of_all(bone.decoded.linear - base.decoded.linear) * radius);
    }
    by_weights +=
        group.total_change * (glm::length(base.decoded(middle)) + length_of_all(base.decoded.linear) * radius);
    constexpr double kRounding = 1.0 + 1e-9;
    return kRounding * (group.exact_total * off + group.decoded_total * stretch * group.place + by_weights +
                        (group.exact_total + group.decoded_total) * doubt);
}

bool NearMesh::is_farther(const Vertex& vertex, double metres) const {
    const glm::dvec3 here(exact_.positions[vertex.number]);
    const glm::dvec3 there(decoded_.positions[vertex.there]);
    glm::dvec3 off(0.0);
    double doubt = 0.0;
    for_each_influence(exact_, vertex.number, [&](std::uint32_t bone, double weight) {
        off += weight * bones_[bone].exact(here);
        doubt += std::abs(weight) * bones_[bone].exact_doubt;
    });
    for_each_influence(decoded_, vertex.there, [&](std::uint32_t bone, double weight) {
        off -= weight * bones_[bone].decoded(there);
        doubt += std::abs(weight) * bones_[bone].decoded_doubt;
    });
    return !(glm::length(off) + 2.0 * doubt <= metres);
}

bool NearMesh::may_be_farther(const NearPoses& exact, const NearPoses& decoded, double metres) {
    if (!can_tell_) return true;
    set_bones(exact, exact_joints_, exact_binds_, &Bone::exact, &Bone::exact_doubt);
    set_bones(decoded, decoded_joints_, decoded_binds_, &Bone::decoded, &Bone::decoded_doubt);
    double all = 0.0;  // of what must be finite: a maximum passes over what is no number
    for (Bone& bone : bones_) {
        bone.stretch = largest_stretch_of(bone.decoded.linear);
        all += bone.exact_doubt + bone.decoded_doubt + length_of_all(bone.exact.linear) +
               length_of_all(bone.decoded.linear) + glm::length(bone.exact.origin) + glm::length(bone.decoded.origin);
    }
    if (!std::isfinite(all)) return true;
    return std::any_of(groups_.begin(), groups_.end(), [&](const Group& group) {
        return !(bound_of(group) <= metres) &&
               std::any_of(group.vertices.begin(), group.vertices.end(),
                           [&](const Vertex& vertex) { return is_farther(vertex, metres); });
    });
}

}  // namespace bendy::converter
