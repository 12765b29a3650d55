#include "overlay.h"

#include "camera.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace bendy::viewer {
namespace {

constexpr glm::vec3 kBoneColour{0.55f, 0.75f, 0.95f};
constexpr glm::vec3 kEndColour{0.9f, 0.95f, 1.0f};
constexpr glm::vec4 kTargetColour{1.0f, 0.12f, 0.1f, 1.0f};
constexpr glm::vec4 kIdleColour{0.6f, 0.25f, 0.22f, 1.0f};
constexpr glm::vec3 kMarkColour{1.0f, 0.72f, 0.1f};
constexpr glm::vec4 kPointerColour{1.0f, 0.95f, 0.6f, 1.0f};

glm::vec3 place(Pose& pose, std::uint32_t joint) {
    return {pose.model_space()[joint][3]};
}

bool is_finite(const glm::vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// Shades a face by its direction, so that solids look three-dimensional.
glm::vec4 shaded(const glm::vec3& colour, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 n = glm::cross(b - a, c - a);
    const float length = glm::length(n);
    const float light = length > 0.0f ? glm::dot(n / length, glm::vec3(0.36f, 0.86f, 0.36f)) : 0.0f;
    return {colour * (0.55f + 0.45f * light), 1.0f};
}

/// Adds two pyramids that share their square base, at `waist`.
void add_octahedron(const glm::vec3& from, const glm::vec3& to, float waist, float width, const glm::vec3& colour,
                    OverlayList& list) {
    const glm::vec3 along = to - from;
    const float length = glm::length(along);
    if (!(length > 0.0f) || !is_finite(from) || !is_finite(to)) return;
    const glm::vec3 unit = along / length;
    const glm::vec3 side =
        glm::normalize(glm::cross(unit, std::abs(unit.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    const glm::vec3 other = glm::cross(unit, side);
    const glm::vec3 middle = from + waist * along;
    const std::array<glm::vec3, 4> corners{middle + width * side, middle + width * other, middle - width * side,
                                           middle - width * other};
    for (std::size_t k = 0; k < 4; ++k) {
        const glm::vec3& a = corners[k];
        const glm::vec3& b = corners[(k + 1) % 4];
        OverlayList::triangle(list.solid, a, b, to, shaded(colour, a, b, to));
        OverlayList::triangle(list.solid, b, a, from, shaded(colour, b, a, from));
    }
}

void add_diamond(const glm::vec3& centre, float radius, const glm::vec3& colour, OverlayList& list) {
    const glm::vec3 up(0.0f, radius, 0.0f);
    add_octahedron(centre - up, centre + up, 0.5f, radius, colour, list);
}

/// Returns for each joint whether it moves a vertex or belongs to a chain; a file's other nodes are not bones. Without
/// a surface, all joints except the controls are bones.
std::vector<bool> find_bones(const Model& model) {
    std::vector<bool> is_bone(model.joints().size());
    if (!has_surface(model)) {
        is_bone = find_controls(model);
        is_bone.flip();
    }
    for (std::uint32_t number = 0; number < model.meshes().size(); ++number) {
        const Mesh& mesh = model.meshes()[number];
        for (std::uint32_t v = 0; v < mesh.vertices; ++v) {
            if (mesh.is_rigid()) {
                const std::uint32_t joint = model.rigid_mover(number, v);
                if (joint != kNone) is_bone[joint] = true;
                continue;
            }
            for (std::uint32_t k = 0; k < mesh.weights->components; ++k) {
                if (mesh.weights->number(v, k) != 0.0f) is_bone[mesh.palette.joints[mesh.bones->index(v, k)]] = true;
            }
        }
    }
    for (const Chain& chain : model.chains()) {
        for (const std::uint32_t joint : links_of(model, chain)) is_bone[joint] = true;
    }
    return is_bone;
}

}  // namespace

void OverlayList::clear() {
    solid.clear();
    translucent.clear();
    lines.clear();
}

void OverlayList::line(const glm::vec3& a, const glm::vec3& b, const glm::vec4& colour, float pixels) {
    if (!is_finite(a) || !is_finite(b)) return;
    // Seen from b, left and right are exchanged.
    const OverlayVertex left{a, b, colour, pixels};
    const OverlayVertex right{a, b, colour, -pixels};
    const OverlayVertex far_left{b, a, colour, -pixels};
    const OverlayVertex far_right{b, a, colour, pixels};
    lines.insert(lines.end(), {left, right, far_left, far_left, right, far_right});
}

void OverlayList::triangle(std::vector<OverlayVertex>& list, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                           const glm::vec4& colour) {
    if (!is_finite(a) || !is_finite(b) || !is_finite(c)) return;
    list.insert(list.end(), {{a, a, colour}, {b, b, colour}, {c, c, colour}});
}

float Overlay::length_of(std::uint32_t joint) const {
    constexpr float kDefaultLength = 0.06f;  // of the character's size
    return lengths_[joint] > 0.0f ? lengths_[joint] : kDefaultLength * size_;
}

Overlay::Overlay(const Model& model) : model_(&model) {
    std::vector<bool> is_bone = find_bones(model);
    const std::vector<bool> is_control = find_controls(model);
    Pose rest(model);
    lengths_.assign(is_bone.size(), 0.0f);
    std::vector<std::uint32_t> child(is_bone.size(), kNone);  // at the end of each joint's longest bone
    std::vector<bool> is_end(is_bone.size());
    for (std::uint32_t joint = 0; joint < is_bone.size(); ++joint) {
        const std::uint32_t parent = model.joints()[joint].parent;
        if (is_bone[joint]) is_end[joint] = true;
        if (parent == kNone || !is_bone[parent] || is_control[joint]) continue;
        const float length = glm::length(place(rest, joint) - place(rest, parent));
        if (!(length > 0.0f)) continue;
        bones_.push_back({parent, joint});
        is_end[joint] = true;
        if (length > lengths_[parent]) {
            lengths_[parent] = length;
            child[parent] = joint;
        }
    }
    for (std::uint32_t joint = 0; joint < is_bone.size(); ++joint) {
        if (is_end[joint]) ends_.push_back(joint);
    }
    for (const Constraint& constraint : model.constraints()) {
        const Constraint* in_poses = model.constraint(constraint.joint);
        if (&constraint != (in_poses != nullptr ? in_poses : model.ik_constraint(constraint.joint))) continue;
        constraints_.push_back(&constraint);
        const std::uint32_t next = child[constraint.joint];
        // A joint without a bone continues its parent's direction.
        const JointTransform& own = model.joints()[constraint.joint].rest;
        const glm::vec3 bone =
            next == kNone ? glm::conjugate(own.rotation) * own.translation : model.joints()[next].rest.translation;
        limits_.push_back(
            make_constraint_drawing(constraint, glm::vec3(glm::conjugate(constraint.frame) * glm::dvec3(bone))));
    }
}

void Overlay::add_bones(Pose& pose, OverlayList& list) const {
    constexpr float kWaist = 0.15f;
    constexpr float kWidth = 0.09f;
    const float widest = 0.025f * size_;
    for (const Bone& bone : bones_) {
        const glm::vec3 from = place(pose, bone.from);
        const glm::vec3 to = place(pose, bone.to);
        add_octahedron(from, to, kWaist, std::min(kWidth * glm::length(to - from), widest), kBoneColour, list);
    }
    for (const std::uint32_t joint : ends_)
        add_diamond(place(pose, joint), std::min(0.06f * length_of(joint), 0.008f * size_), kEndColour, list);
}

void Overlay::add_thin_bones(Pose& pose, OverlayList& list) const {
    constexpr float kPixels = 0.75f;
    for (const Bone& bone : bones_)
        list.line(place(pose, bone.from), place(pose, bone.to), glm::vec4(kBoneColour, 1.0f), kPixels);
}

void Overlay::add_axes(Pose& pose, OverlayList& list) const {
    for (const std::uint32_t joint : ends_)
        add_axes_of(pose, joint, std::min(0.35f * length_of(joint), 0.06f * size_), 1.5f, list);
}

void Overlay::add_axes_of(Pose& pose, std::uint32_t joint, float length, float pixels, OverlayList& list) {
    const glm::mat4& matrix = pose.model_space()[joint];
    const glm::vec3 origin(matrix[3]);
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec4 colour(0.05f, 0.05f, 0.05f, 1.0f);
        colour[axis] = 0.9f;
        const glm::vec3 direction(matrix[axis]);
        const float scale = glm::length(direction);
        if (scale > 0.0f) list.line(origin, origin + direction * (length / scale), colour, pixels);
    }
}

void Overlay::add_mark(Pose& pose, std::uint32_t joint, OverlayList& list) const {
    const glm::vec3 here = place(pose, joint);
    for (const Bone& bone : bones_) {
        if (bone.from != joint) continue;
        const glm::vec3 to = place(pose, bone.to);
        add_octahedron(here, to, 0.15f, std::min(0.12f * glm::length(to - here), 0.03f * size_), kMarkColour, list);
    }
    add_diamond(here, 0.016f * size_, kMarkColour, list);
    add_axes_of(pose, joint, 0.1f * size_, 2.5f, list);
}

void Overlay::add_constraint(const Constraint& constraint, const ConstraintDrawing& drawing, Pose& pose,
                             OverlayList& list) const {
    const Joint& joint = model_->joints()[drawing.joint];
    // The constraint is fixed in the parent's space: rest * C. Scale is removed, mirroring is not.
    glm::mat3 parent(1.0f);
    if (joint.parent != kNone) parent = glm::mat3(pose.model_space()[joint.parent]);
    for (int axis = 0; axis < 3; ++axis) {
        const float length = glm::length(parent[axis]);
        if (length > 0.0f) parent[axis] /= length;
    }
    const glm::mat3 frame = parent * glm::mat3_cast(joint.rest.rotation * glm::quat(constraint.frame));
    const glm::vec3 centre = place(pose, drawing.joint);
    const float radius = std::clamp(0.45f * length_of(drawing.joint), 0.02f * size_, 0.12f * size_);
    const glm::dquat R = to_constraint_space(constraint, joint.rest.rotation, pose.local(drawing.joint).rotation);
    const glm::vec3 pointer = centre + 1.15f * radius * (frame * glm::vec3(R * glm::dvec3(drawing.pointer)));

    for (const LimitFan& fan : drawing.fans) {
        const glm::vec4 fill(fan.colour, 0.28f);
        const glm::vec4 edge(fan.colour, 0.95f);
        const auto point = [&](std::size_t k) {
            return centre + fan.radius * radius * (frame * fan.rim[k % fan.rim.size()]);
        };
        const std::size_t sides = fan.is_closed ? fan.rim.size() : fan.rim.size() - 1;
        for (std::size_t k = 0; k < sides; ++k) {
            OverlayList::triangle(list.translucent, centre, point(k), point(k + 1), fill);
            list.line(point(k), point(k + 1), edge, 1.0f);
        }
        constexpr std::size_t kRibs = 8;
        if (fan.is_closed) {
            for (std::size_t k = 0; k < kRibs; ++k)
                list.line(centre, point(k * fan.rim.size() / kRibs), glm::vec4(fan.colour, 0.4f), 0.5f);
        } else {
            list.line(centre, point(0), edge, 0.75f);
            list.line(centre, point(fan.rim.size() - 1), edge, 0.75f);
        }
    }
    if (drawing.is_locked) {
        const float half = 0.3f * radius;
        for (int axis = 0; axis < 3; ++axis)
            list.line(centre - half * frame[axis], centre + half * frame[axis], {0.8f, 0.8f, 0.8f, 1.0f}, 1.5f);
    } else if (!drawing.fans.empty()) {
        list.line(centre, pointer, kPointerColour, 1.25f);
    }
}

void Overlay::add_constraints(Pose& pose, OverlayList& list) const {
    for (std::size_t k = 0; k < limits_.size(); ++k) add_constraint(*constraints_[k], limits_[k], pose, list);
}

void Overlay::add_targets(std::span<const TargetMark> targets, OverlayList& list) const {
    const float radius = 0.022f * size_;
    for (const TargetMark& target : targets) {
        const glm::vec4 colour = target.is_active ? kTargetColour : kIdleColour;
        add_diamond(target.position, radius, glm::vec3(colour), list);
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 arm(0.0f);
            arm[axis] = 1.8f * radius;
            list.line(target.position - arm, target.position + arm, colour, 1.0f);
        }
        if (target.tip) list.line(*target.tip, target.position, glm::vec4(glm::vec3(colour), 0.6f), 0.75f);
    }
}

std::vector<std::uint32_t> links_of(const Model& model, const Chain& chain) {
    std::vector<std::uint32_t> links(chain.links);
    std::uint32_t joint = chain.record.effector;
    for (std::uint32_t link = chain.links; link-- > 0;) {
        links[link] = joint;
        joint = model.joints()[joint].parent;
    }
    return links;
}

glm::vec3 tip_of(const Chain& chain, Pose& pose) {
    const auto& offset = chain.record.tip_offset;
    return {pose.model_space()[chain.record.effector] * glm::vec4(offset[0], offset[1], offset[2], 1.0f)};
}

std::vector<TargetMark> target_marks(Pose& pose, std::span<const Chain* const> without) {
    std::vector<TargetMark> marks;
    for (const Chain& chain : pose.model().chains()) {
        const bool is_followed = chain.record.target != kNone && chain.record.influence > 0.0f;
        if (is_followed && std::find(without.begin(), without.end(), &chain) == without.end())
            marks.push_back({place(pose, chain.record.target), tip_of(chain, pose), true});
    }
    return marks;
}

}  // namespace bendy::viewer
