#include "surface.h"

#include "pose/pose_state.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>

namespace bendy {
namespace {

constexpr double kBall = 0.12, kLimbBall = 0.06;  // leg lengths: how thick a body without a skin is
constexpr double kFingerBall = 0.02;              // the same of the joints of its hands
constexpr double kBelowHips = 0.25;               // leg lengths: where the trunk of who stands ends
constexpr double kBelowKnee = 0.08;               // leg lengths: where a knee ends
constexpr double kLoose = 1.7;                    // of the mean distance from a thigh's bone: a skirt
constexpr std::uint32_t kHead = 0, kChest = 1, kBelly = 2, kThighs = 3;  // of Surface::shells
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A joint whose vertices are looked at: those of which it has the largest weight, or one of some joints below it.
struct SkinBone {
    std::uint32_t joint = 0;
    SurfacePart* part = nullptr;
    double least = -kInfinite;  ///< metres: its vertices that are lower in the standing pose do not count
    std::uint32_t end = kNone;  ///< if only vertices near to the bone from the joint to that count
    bool is_trunk = false;
    double least_below = -kInfinite;  ///< metres: the same as `least`, of the joints below it
    std::uint32_t shell = kNone;      ///< of Surface::shells; kChest for all of the trunk
};

struct SkinVertex {
    std::uint32_t mesh = 0, number = 0;
    const SkinBone* bone = nullptr;
    glm::dvec3 rest{0.0};  ///< in the standing pose, as if it were all of the joint that has the largest weight
};

class SurfaceFinder {
public:
    SurfaceFinder(const Body& body, std::span<const std::uint32_t> props)
        : body_(body), model_(body.model()), props_(props) {
        surface_.shells.resize(kBodyShells + props.size());
    }

    Surface find() {
        list_bones();
        read_vertices();
        for (const SkinBone& bone : bones_) vertices_.empty() ? take_ball(bone) : take_skin(bone);
        finish(surface_.body);
        finish(surface_.arms);
        for (SurfacePart& end : surface_.ends) finish(end);
        find_floor();
        finish_shells();
        return std::move(surface_);
    }

private:
    void list_bones() {
        const glm::dvec3 top = body_.top() == kNone ? body_.hips() : body_.place(body_.top());
        waist_ = 0.5 * height_of(body_.hips() + top);
        const double least = height_of(body_.hips()) - kBelowHips * body_.lengths().front();
        bone_of_.assign(model_.joints().size(), kNone);
        for (const std::uint32_t joint :
             body_.joints({Role::hips, Role::spine, Role::chest, Role::upper_chest, Role::left_shoulder,
                           Role::right_shoulder, Role::neck, Role::head})) {
            list({joint, &surface_.body, least, kNone, true, height_of(body_.place(joint))});
        }
        for (const std::uint32_t joint : body_.joints({Role::hips, Role::spine, Role::chest, Role::upper_chest}))
            bones_[bone_of_[joint]].shell = kChest;
        const std::uint32_t head = body_.joint(Role::head);
        if (head != kNone) {
            bones_[bone_of_[head]].shell = kHead;
            list_below(head, true);
        }
        for (std::size_t k = 0; k < body_.limbs().size(); ++k) list_limb(body_.limbs()[k], surface_.ends.at(k));
        for (std::uint32_t k = 0; k < props_.size(); ++k) {
            list({props_[k], &prop_});
            bones_.back().shell = kBodyShells + k;
        }
    }

    void list(const SkinBone& bone) {
        bone_of_[bone.joint] = static_cast<std::uint32_t>(bones_.size());
        bones_.push_back(bone);
    }

    void list_limb(const Limb& limb, SurfacePart& end) {
        if (!limb.is_whole()) return;
        const double knee = height_of(body_.place(limb.joints[1])) - kBelowKnee * body_.lengths().front();
        const double least = limb.is_leg ? knee : -kInfinite;
        SurfacePart& part = limb.is_leg ? surface_.body : surface_.arms;
        list({limb.joints[0], &part, least, limb.is_leg ? limb.joints[1] : kNone});
        if (limb.is_leg) bones_.back().shell = kThighs + (&limb == &body_.limbs()[1] ? 1 : 0);
        list({limb.joints[1], &part, least});
        list({limb.foot_joint(), &end});
        list_below(limb.foot_joint(), limb.is_leg);
    }

    /// Counts the joints below one as that. \param all  also those without a role, such as for hair; of a hand, props
    /// have none
    void list_below(std::uint32_t top, bool all) {
        for (std::uint32_t joint = top + 1; joint < bone_of_.size(); ++joint) {
            const std::uint32_t parent = model_.parents()[joint];
            const bool is_below = parent != kNone && bone_of_[parent] == bone_of_[top];
            if (is_below && (all || body_.has_role(joint))) bone_of_[joint] = bone_of_[top];
        }
    }

    [[nodiscard]] double height_of(const glm::dvec3& place) const { return glm::dot(body_.up(), place); }

    [[nodiscard]] glm::dvec3 at_rest(const SurfacePart::Share& share) const {
        return {body_.rest(share.joint) * glm::dvec4(share.place, 1.0)};
    }

    void read_vertices() {
        for (std::uint32_t mesh = 0; mesh < model_.meshes().size(); ++mesh) {
            if (model_.meshes()[mesh].positions.empty()) continue;
            for (std::uint32_t number = 0; number < model_.meshes()[mesh].vertices; ++number) read_vertex(mesh, number);
        }
    }

    void read_vertex(std::uint32_t mesh, std::uint32_t number) {
        const SurfacePart::Share* largest = nullptr;
        for (const SurfacePart::Share& share : shares_of(mesh, number)) {
            if (largest == nullptr || share.weight > largest->weight) largest = &share;
        }
        if (largest == nullptr || bone_of_[largest->joint] == kNone) return;
        const SkinBone& bone = bones_[bone_of_[largest->joint]];
        const glm::dvec3 rest = at_rest(*largest);
        if (std::isfinite(rest.x + rest.y + rest.z) &&
            (largest->joint == bone.joint || height_of(rest) >= bone.least_below))
            vertices_.push_back({mesh, number, &bone, rest});
    }

    /// Returns what moves a vertex.
    const std::vector<SurfacePart::Share>& shares_of(std::uint32_t number, std::uint32_t vertex) {
        const Mesh& mesh = model_.meshes()[number];
        const glm::dvec4 place(glm::dvec3(mesh.positions.vec3(vertex)), 1.0);
        shares_.clear();
        if (mesh.is_rigid()) {
            const std::uint32_t mover = model_.rigid_mover(number, vertex);
            if (mover < model_.joints().size()) shares_.push_back({mover, 0, 1.0, glm::dvec3(place)});
            return shares_;
        }
        for (std::uint32_t k = 0; k < mesh.bones->components; ++k) {
            const double weight = mesh.weights->number(vertex, k);
            if (!(weight > 0.0)) continue;
            const std::uint32_t bone = mesh.bones->index(vertex, k);
            const glm::dmat4 bind(mesh.palette.inverse_bind()[bone]);
            shares_.push_back({mesh.palette.joints[bone], 0, weight, glm::dvec3(bind * place)});
        }
        return shares_;
    }

    [[nodiscard]] double distance_from(const SkinBone& bone, const glm::dvec3& rest) const {
        if (bone.end == kNone) return 0.0;
        const glm::dvec3 way = body_.place(bone.end) - body_.place(bone.joint);
        const glm::dvec3 to = rest - body_.place(bone.joint);
        const double square = glm::dot(way, way);
        return glm::length(square > 0.0 ? to - way * std::clamp(glm::dot(to, way) / square, 0.0, 1.0) : to);
    }

    void take_skin(const SkinBone& bone) {
        double sum = 0.0, count = 0.0;
        for (const SkinVertex& vertex : vertices_) {
            if (vertex.bone != &bone) continue;
            sum += distance_from(bone, vertex.rest);
            ++count;
        }
        std::array<const SkinVertex*, kDirections> farthest{};
        for (const SkinVertex& vertex : vertices_) {
            const bool is_here = vertex.bone == &bone && height_of(vertex.rest) >= bone.least;
            if (!is_here || distance_from(bone, vertex.rest) * count > kLoose * sum) continue;
            if (bone.shell != kNone) take_into_shell(bone.shell, vertex.rest);
            for (std::size_t k = 0; k < kDirections; ++k) {
                const SkinVertex*& most = farthest.at(k);
                if (most == nullptr || glm::dot(vertex.rest - most->rest, direction(k)) > 0.0) most = &vertex;
            }
        }
        for (auto one = farthest.begin(); one != farthest.end(); ++one) {
            if (*one != nullptr && std::find(farthest.begin(), one, *one) == one) take_vertex(**one, *bone.part);
        }
    }

    void take_into_shell(std::uint32_t shell, const glm::dvec3& place) {
        const bool is_belly = shell == kChest && height_of(place) < waist_;
        surface_.shells.at(is_belly ? kBelly : shell).take(glm::conjugate(body_.axes()) * place);
    }

    void take_vertex(const SkinVertex& vertex, SurfacePart& part) {
        const auto point = static_cast<std::uint32_t>(part.radii.size());
        part.radii.push_back(0.0);
        for (SurfacePart::Share share : shares_of(vertex.mesh, vertex.number)) {
            share.point = point;
            part.shares.push_back(share);
        }
    }

    void take_ball(const SkinBone& bone) {
        add_ball(*bone.part, bone.joint, bone.is_trunk ? kBall : kLimbBall);
        for (std::uint32_t joint = bone.joint + 1; joint < bone_of_.size() && !bone.is_trunk; ++joint) {
            if (bone_of_[joint] == bone_of_[bone.joint]) add_ball(*bone.part, joint, kFingerBall);
        }
        if (bone.shell >= kBodyShells) return;  // or none
        const double radius = (bone.is_trunk ? kBall : kLimbBall) * body_.lengths().front();
        glm::dvec3 middle = body_.place(bone.joint);
        if (bone.shell == kHead) middle += radius * body_.up();  // the joint is where the neck ends
        for (std::size_t k = 0; k < kDirections; ++k)
            take_into_shell(bone.shell, middle + body_.axes() * (radius * direction(k)));
        if (bone.end != kNone) take_into_shell(bone.shell, body_.place(bone.end));
    }

    void add_ball(SurfacePart& part, std::uint32_t joint, double radius) const {
        part.shares.push_back({joint, static_cast<std::uint32_t>(part.radii.size())});
        part.radii.push_back(radius * body_.lengths().front());
    }

    void finish(SurfacePart& part) const {
        part.heights.resize(part.radii.size());
        part.points.resize(part.radii.size());
        const std::vector<SurfacePart::Share> shares = std::move(part.shares);
        part.shares.clear();
        for (std::uint32_t joint = 0; joint < model_.joints().size(); ++joint) {
            for (const SurfacePart::Share& share : shares) {
                if (share.joint == joint) part.shares.push_back(share);
            }
        }
    }

    void finish_shells() {
        const auto trunk = body_.joints({Role::spine, Role::chest, Role::upper_chest});
        set_joint(kHead, body_.joint(Role::head));
        set_joint(kChest, trunk.empty() ? kNone : trunk.back());
        set_joint(kBelly, body_.joint(Role::hips));
        for (std::uint32_t leg = 0; leg < 2; ++leg) set_joint(kThighs + leg, body_.limbs()[leg].upper());
        for (std::uint32_t k = 0; k < props_.size(); ++k) set_joint(kBodyShells + k, props_[k]);
    }

    void set_joint(std::uint32_t number, std::uint32_t joint) {
        Shell& shell = surface_.shells.at(number);
        if (joint == kNone || !shell.finish()) return;
        const glm::dmat4 axes = glm::mat4_cast(glm::conjugate(body_.axes()));
        shell.to_body = axes * body_.rest(joint);
        shell.from_body = glm::inverse(shell.to_body);
        shell.joint = joint;
    }

    /// Soles may be below the joints of the feet.
    void find_floor() {
        surface_.floor = height_of(body_.ground());
        for (std::size_t foot = 0; foot < 2 && !vertices_.empty(); ++foot) {
            for (const SurfacePart::Share& share : surface_.ends.at(foot).shares)
                surface_.floor = std::min(surface_.floor, height_of(at_rest(share)));
        }
        surface_.floor += body_.raised();
    }

    const Body& body_;
    const Model& model_;
    std::span<const std::uint32_t> props_;
    SurfacePart prop_;    // props do not touch the ground
    double waist_ = 0.0;  // metres along up: between belly and chest
    Surface surface_;
    std::vector<SkinBone> bones_;
    std::vector<std::uint32_t> bone_of_;  // by joint
    std::vector<SkinVertex> vertices_;
    std::vector<SurfacePart::Share> shares_;  // of one vertex
};

}  // namespace

Surface find_surface(const Body& body, std::span<const std::uint32_t> props) {
    return SurfaceFinder(body, props).find();
}

std::span<const glm::dvec3> SurfacePart::places(PoseState& pose) {
    points.assign(radii.size(), glm::dvec3(0.0));
    for (const Share& share : shares)
        points[share.point] += share.weight * glm::dvec3(pose.fresh_matrix(share.joint) * glm::dvec4(share.place, 1.0));
    return points;
}

double SurfacePart::lowest(PoseState& pose, const glm::dvec3& up) {
    for (std::size_t point = 0; point < heights.size(); ++point) heights[point] = -radii[point];
    std::uint32_t joint = kNone;
    glm::dvec4 row(0.0);  // of the joint's matrix, along up
    for (const Share& share : shares) {
        if (share.joint != joint) {
            joint = share.joint;
            row = glm::dvec4(up, 0.0) * pose.fresh_matrix(joint);
        }
        heights[share.point] += share.weight * glm::dot(row, glm::dvec4(share.place, 1.0));
    }
    double least = kInfinite;
    for (const double height : heights) least = std::min(least, height);
    return least;
}

}  // namespace bendy
