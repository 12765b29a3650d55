#include "surface.h"

#include "pose/pose_state.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <tuple>

namespace bendy {
namespace {

constexpr double kBall = 0.12, kLimbBall = 0.06;  // leg lengths: how thick a body without a skin is
constexpr double kBelowHips = 0.25;               // leg lengths: where the trunk of who stands ends
constexpr double kBelowKnee = 0.08;               // leg lengths: where a knee ends
constexpr double kLoose = 1.7;                    // of the mean distance from a thigh's bone: a skirt
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// To the sides, edges and corners of a cube.
constexpr std::size_t kDirections = 26;
const std::array<glm::dvec3, kDirections>& directions() {
    static const std::array<glm::dvec3, kDirections> kWays = [] {
        std::array<glm::dvec3, kDirections> made{};
        std::size_t count = 0;
        for (int number = 0; number < 27; ++number) {
            const glm::dvec3 way(number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1);
            if (way != glm::dvec3(0.0)) made.at(count++) = glm::normalize(way);
        }
        return made;
    }();
    return kWays;
}

/// A joint whose vertices are looked at: those of which it has the largest weight.
struct SkinBone {
    std::uint32_t joint = 0;
    SurfacePart* part = nullptr;
    double least = -kInfinite;  ///< metres: vertices that are lower in the standing pose do not count
    std::uint32_t end = kNone;  ///< if only vertices near to the bone from the joint to that count
    bool is_trunk = false;
    double distances = 0.0;  ///< metres: sum of those from that bone
    std::size_t vertices = 0;
    struct Vertex {
        std::uint32_t mesh = kNone, number = 0;
        double distance = -kInfinite;
    };
    std::array<Vertex, kDirections> farthest{};
};

class SurfaceFinder {
public:
    explicit SurfaceFinder(const Body& body) : body_(body), model_(body.model()) {}

    Surface find() {
        list_bones();
        for_each_vertex([&](SkinBone& bone, const SkinBone::Vertex& /*vertex*/, const glm::dvec3& rest) {
            bone.distances += distance_from(bone, rest);
            ++bone.vertices;
        });
        for_each_vertex(
            [&](SkinBone& bone, SkinBone::Vertex vertex, const glm::dvec3& rest) { compare(bone, vertex, rest); });
        const bool has_skin =
            std::any_of(bones_.begin(), bones_.end(), [](const SkinBone& bone) { return bone.vertices > 0; });
        for (const SkinBone& bone : bones_) has_skin ? take_skin(bone) : take_ball(bone);
        finish(surface_.body);
        finish(surface_.arms);
        for (SurfacePart& end : surface_.ends) finish(end);
        find_floor(has_skin);
        return std::move(surface_);
    }

private:
    void list_bones() {
        const double trunk = height_of(body_.hips()) - kBelowHips * body_.lengths().front();
        for (const std::uint32_t joint :
             body_.joints({Role::hips, Role::spine, Role::chest, Role::upper_chest, Role::neck, Role::head,
                           Role::left_shoulder, Role::right_shoulder})) {
            bones_.push_back({joint, &surface_.body, trunk, kNone, true});
        }
        const std::uint32_t head = body_.joint(Role::head);
        if (head != kNone) list_below(head, height_of(body_.place(head)), surface_.body, true);
        for (std::size_t k = 0; k < body_.limbs().size(); ++k) list_limb(body_.limbs()[k], surface_.ends.at(k));
        bone_of_.assign(model_.joints().size(), kNone);
        for (std::uint32_t k = 0; k < bones_.size(); ++k) bone_of_[bones_[k].joint] = k;
    }

    void list_limb(const Limb& limb, SurfacePart& end) {
        if (!limb.is_whole()) return;
        const double knee = height_of(body_.place(limb.joints[1])) - kBelowKnee * body_.lengths().front();
        const double least = limb.is_leg ? knee : -kInfinite;
        SurfacePart& part = limb.is_leg ? surface_.body : surface_.arms;
        bones_.push_back({limb.joints[0], &part, least, limb.is_leg ? limb.joints[1] : kNone});
        bones_.push_back({limb.joints[1], &part, least});
        bones_.push_back({limb.foot_joint(), &end});
        list_below(limb.foot_joint(), -kInfinite, end, limb.is_leg);
    }

    /// Lists the joints below the one listed last. \param all  also those without a role, such as for hair; of a hand,
    /// props have none
    void list_below(std::uint32_t joint, double least, SurfacePart& part, bool all) {
        std::vector<bool> is_below(model_.joints().size());
        is_below[joint] = true;
        for (++joint; joint < is_below.size(); ++joint) {
            const std::uint32_t parent = model_.parents()[joint];
            if (parent == kNone || !is_below[parent] || !(all || body_.has_role(joint))) continue;
            is_below[joint] = true;
            bones_.push_back({joint, &part, least});
        }
    }

    [[nodiscard]] double height_of(const glm::dvec3& place) const { return glm::dot(body_.up(), place); }

    /// Calls a function with each vertex that is mostly of one bone, and its place in the standing pose as if it were
    /// all of that.
    template <class Use>
    void for_each_vertex(const Use& use) {
        for (std::uint32_t number = 0; number < model_.meshes().size(); ++number) {
            const Mesh& mesh = model_.meshes()[number];
            if (mesh.positions.empty()) continue;
            for (std::uint32_t vertex = 0; vertex < mesh.vertices; ++vertex) {
                const SurfacePart::Share share = largest_share(number, vertex);
                if (share.joint >= bone_of_.size() || bone_of_[share.joint] == kNone) continue;
                const glm::dvec3 rest(body_.rest(share.joint) * glm::dvec4(share.place, 1.0));
                if (!std::isfinite(rest.x + rest.y + rest.z)) continue;
                use(bones_[bone_of_[share.joint]], {number, vertex}, rest);
            }
        }
    }

    [[nodiscard]] SurfacePart::Share largest_share(std::uint32_t mesh, std::uint32_t vertex) const {
        SurfacePart::Share largest{kNone, 0, 0.0, {}};
        for_each_share(mesh, vertex, [&](const SurfacePart::Share& share) {
            if (share.weight > largest.weight) largest = share;
        });
        return largest;
    }

    template <class Use>
    void for_each_share(std::uint32_t number, std::uint32_t vertex, const Use& use) const {
        const Mesh& mesh = model_.meshes()[number];
        const glm::dvec4 place(glm::dvec3(mesh.positions.vec3(vertex)), 1.0);
        if (mesh.is_rigid()) {
            use({model_.rigid_mover(number, vertex), 0, 1.0, glm::dvec3(place)});
            return;
        }
        for (std::uint32_t k = 0; k < mesh.bones->components; ++k) {
            const double weight = mesh.weights->number(vertex, k);
            if (!(weight > 0.0)) continue;
            const std::uint32_t bone = mesh.bones->index(vertex, k);
            const glm::dmat4 bind(mesh.palette.inverse_bind()[bone]);
            use({mesh.palette.joints[bone], 0, weight, glm::dvec3(bind * place)});
        }
    }

    [[nodiscard]] double distance_from(const SkinBone& bone, const glm::dvec3& rest) const {
        if (bone.end == kNone) return 0.0;
        const glm::dvec3 way = body_.place(bone.end) - body_.place(bone.joint);
        const glm::dvec3 to = rest - body_.place(bone.joint);
        const double square = glm::dot(way, way);
        return glm::length(square > 0.0 ? to - way * std::clamp(glm::dot(to, way) / square, 0.0, 1.0) : to);
    }

    void compare(SkinBone& bone, SkinBone::Vertex vertex, const glm::dvec3& rest) const {
        const double mean = bone.distances / static_cast<double>(bone.vertices);
        if (height_of(rest) < bone.least || distance_from(bone, rest) > kLoose * mean) return;
        for (std::size_t k = 0; k < kDirections; ++k) {
            vertex.distance = glm::dot(rest, directions().at(k));
            if (vertex.distance > bone.farthest.at(k).distance) bone.farthest.at(k) = vertex;
        }
    }

    void take_skin(const SkinBone& bone) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> taken;
        for (const SkinBone::Vertex& vertex : bone.farthest) {
            const std::pair key(vertex.mesh, vertex.number);
            if (vertex.mesh == kNone || std::find(taken.begin(), taken.end(), key) != taken.end()) continue;
            taken.push_back(key);
            const auto point = static_cast<std::uint32_t>(bone.part->radii.size());
            bone.part->radii.push_back(0.0);
            for_each_share(vertex.mesh, vertex.number, [&](SurfacePart::Share share) {
                share.point = point;
                if (share.joint < model_.joints().size()) bone.part->shares.push_back(share);
            });
        }
    }

    void take_ball(const SkinBone& bone) {
        bone.part->shares.push_back({bone.joint, static_cast<std::uint32_t>(bone.part->radii.size())});
        bone.part->radii.push_back((bone.is_trunk ? kBall : kLimbBall) * body_.lengths().front());
    }

    static void finish(SurfacePart& part) {
        part.heights.resize(part.radii.size());
        std::sort(part.shares.begin(), part.shares.end(),
                  [](const auto& a, const auto& b) { return std::tie(a.joint, a.point) < std::tie(b.joint, b.point); });
    }

    /// Soles may be below the joints of the feet.
    void find_floor(bool has_skin) {
        surface_.floor = height_of(body_.ground());
        for (std::size_t foot = 0; foot < 2 && has_skin; ++foot) {
            for (const SurfacePart::Share& share : surface_.ends.at(foot).shares) {
                const glm::dvec3 rest(body_.rest(share.joint) * glm::dvec4(share.place, 1.0));
                surface_.floor = std::min(surface_.floor, height_of(rest));
            }
        }
        surface_.floor += body_.raised();
    }

    const Body& body_;
    const Model& model_;
    Surface surface_;
    std::vector<SkinBone> bones_;
    std::vector<std::uint32_t> bone_of_;  // by joint
};

}  // namespace

Surface find_surface(const Body& body) {
    return SurfaceFinder(body).find();
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
    const auto least = std::min_element(heights.begin(), heights.end());
    return least == heights.end() ? kInfinite : *least;
}

}  // namespace bendy
