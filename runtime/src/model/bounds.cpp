#include <bendy/runtime/bounds.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace bendy {
namespace {

// 32 units in the last place: kernels guarantee 8, and matrices and boxes are rounded too.
constexpr double kKernelRounding = 4e-6;

bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void put_in(Box& box, const glm::dvec3& point) {
    if (!is_finite(point)) return;
    box.minimum = glm::min(box.minimum, glm::vec3(point));
    box.maximum = glm::max(box.maximum, glm::vec3(point));
}

/// Returns the box around a box transformed by a matrix, including rounding.
Box moved(const Box& box, const glm::dmat4& matrix) {
    if (box.is_empty()) return box;
    const glm::dvec3 middle = 0.5 * (glm::dvec3(box.minimum) + glm::dvec3(box.maximum));
    const glm::dvec3 half = glm::dvec3(box.maximum) - middle;
    const glm::dvec3 most = glm::abs(middle) + half;
    glm::dvec3 place(matrix[3]);
    glm::dvec3 reach(0.0);
    glm::dvec3 rounding = glm::abs(place);
    for (int c = 0; c < 3; ++c) {
        const glm::dvec3 column(matrix[c]);
        place += middle[c] * column;
        reach += half[c] * glm::abs(column);
        rounding += most[c] * glm::abs(column);
    }
    reach += kKernelRounding * rounding;
    if (!is_finite(place) || !is_finite(reach)) return {};
    return {place - reach, place + reach};
}

/// Returns the box enlarged by that fraction of its largest number.
Box grown(const Box& box, double share) {
    if (box.is_empty() || share == 0.0) return box;
    const glm::vec3 most = glm::max(glm::abs(box.minimum), glm::abs(box.maximum));
    const auto by = static_cast<float>(share * std::max({most.x, most.y, most.z}));
    return {box.minimum - by, box.maximum + by};
}

}  // namespace

Box unite(const Box& a, const Box& b) {
    return {glm::min(a.minimum, b.minimum), glm::max(a.maximum, b.maximum)};
}

/// Collects the boxes from the vertices.
struct Bounds::Builder {
    explicit Builder(Bounds& made) : bounds(made), model(made.model_), shifts(made.joints_.size()) {}

    void add_mesh(std::uint32_t number) {
        const Mesh& mesh = model.meshes()[number];
        std::vector<glm::vec3> vectors(mesh.vertices);
        mesh.positions.decode(std::span(vectors).first(mesh.positions.empty() ? 0 : vectors.size()));
        for (std::uint32_t vertex = 0; vertex < mesh.vertices; ++vertex) {
            for_each_mover(number, vertex, [&](std::uint32_t joint, const glm::dmat4& bind) {
                put_in(bounds.joints_[joint].box, glm::dvec3(bind * glm::dvec4(glm::dvec3(vectors[vertex]), 1.0)));
            });
            if (!mesh.is_rigid()) look_at_weights(mesh, vertex);
        }
        for (std::uint32_t k = 0; k < mesh.targets.size(); ++k) add_target(number, k);
    }

    void add_target(std::uint32_t number, std::uint32_t k) {
        const MorphTargetView& target = model.meshes()[number].targets[k];
        if (!target.positions) return;
        const std::uint32_t place = model.first_morph_target(number) + k;
        const Mesh& mesh = model.meshes()[number];
        for (std::uint32_t entry = 0; entry < target.touched(mesh.vertices); ++entry) {
            const glm::dvec3 displacement(target.displacement(*target.positions, mesh.positions, entry));
            const std::uint32_t vertex = target.vertex(entry);
            for_each_mover(number, vertex, [&](std::uint32_t joint, const glm::dmat4& bind) {
                // The box also contains zero, for the joint's other vertices, which are not displaced.
                Box& box = shifts[joint].try_emplace(place, Box{glm::vec3(0.0f), glm::vec3(0.0f)}).first->second;
                put_in(box, glm::dmat3(bind) * displacement);
            });
        }
    }

    /// Calls visit(joint, inverse bind matrix) for each joint that moves the vertex; those of a rigid mesh are in joint
    /// space.
    template <class Visit>
    void for_each_mover(std::uint32_t number, std::uint32_t vertex, const Visit& visit) const {
        const Mesh& mesh = model.meshes()[number];
        if (mesh.is_rigid()) {
            const std::uint32_t joint = model.rigid_mover(number, vertex);
            visit(joint == kNone ? static_cast<std::uint32_t>(bounds.joints_.size() - 1) : joint, glm::dmat4(1.0));
            return;
        }
        for (std::uint32_t k = 0; k < mesh.bones->components; ++k) {
            if (mesh.weights->number(vertex, k) == 0.0f) continue;
            const std::uint32_t bone = mesh.bones->index(vertex, k);
            visit(mesh.palette.joints[bone], glm::dmat4(mesh.palette.inverse_bind()[bone]));
        }
    }

    /// With sum P of the positive weights and sum -N of the negative ones, a vertex is P times a point in the boxes
    /// minus N times another.
    void look_at_weights(const Mesh& mesh, std::uint32_t vertex) {
        double above = 0.0;
        double below = 0.0;
        for (std::uint32_t k = 0; k < mesh.weights->components; ++k) {
            const double weight = mesh.weights->number(vertex, k);
            (weight < 0.0 ? below : above) += std::abs(weight);
        }
        if (above == 0.0 && below == 0.0) {
            bounds.has_origin_ = true;
            return;
        }
        const double slack = std::abs(above - 1.0) + below;
        if (std::isfinite(slack)) bounds.slack_ = std::max(bounds.slack_, slack);
    }

    void finish() {
        for (std::size_t joint = 0; joint < shifts.size(); ++joint) {
            JointBox& made = bounds.joints_[joint];
            made.first_shift = static_cast<std::uint32_t>(bounds.shifts_.size());
            made.shifts = static_cast<std::uint32_t>(shifts[joint].size());
            for (const auto& [target, box] : shifts[joint]) bounds.shifts_.push_back({target, box});
        }
    }

    Bounds& bounds;
    const Model& model;
    std::vector<std::map<std::uint32_t, Box>> shifts;  // per joint, by target
};

Bounds::Bounds(const Model& model) : model_(model), joints_(model.joints().size() + 1) {
    Builder builder(*this);
    for (std::uint32_t mesh = 0; mesh < model.meshes().size(); ++mesh) builder.add_mesh(mesh);
    builder.finish();
}

Box Bounds::shifted(const JointBox& joint, std::span<const float> weights) const {
    Box box = joint.box;
    if (box.is_empty()) return box;
    for (const Shift& shift : std::span(shifts_).subspan(joint.first_shift, joint.shifts)) {
        const float weight = weights[shift.target];
        if (weight == 0.0f || !std::isfinite(weight)) continue;
        box.minimum += weight * (weight > 0.0f ? shift.box.minimum : shift.box.maximum);
        box.maximum += weight * (weight > 0.0f ? shift.box.maximum : shift.box.minimum);
    }
    return box;
}

Box Bounds::joint(std::uint32_t joint) const {
    return joint < model_.joints().size() ? joints_[joint].box : Box{};
}

Box Bounds::in_model_space(Pose& pose, std::uint32_t joint) const {
    return moved(shifted(joints_[joint], pose.morph_weights()), glm::dmat4(pose.model_space()[joint]));
}

Result<Box, CallError> Bounds::of(Pose& pose, std::uint32_t joint) const {
    if (pose.model() != model_) return CallError::other_model;
    if (joint >= model_.joints().size()) return CallError::out_of_range;
    return in_model_space(pose, joint);
}

Result<Box, CallError> Bounds::of(Pose& pose) const {
    if (pose.model() != model_) return CallError::other_model;
    Box all = moved(shifted(joints_.back(), pose.morph_weights()), glm::dmat4(1.0));
    for (std::uint32_t joint = 0; joint < model_.joints().size(); ++joint) {
        if (!joints_[joint].box.is_empty()) all = unite(all, in_model_space(pose, joint));
    }
    all = grown(all, slack_);
    if (has_origin_) put_in(all, glm::dvec3(0.0));
    return all;
}

}  // namespace bendy
