#pragma once

#include "scene/frame_shapes.h"
#include "scene/space.h"

#include <bendy/converter/scene.h>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// A vertex's displacement by a morph target.
struct Displacement {
    std::uint32_t vertex = 0;
    glm::dvec3 by{0.0};
};

/// The data of a mesh that all its poses share. A rigid mesh gets a single bone.
class MeshShape {
public:
    /// \param mesh  must outlive the shape
    /// \param used  palette entries to keep, see mark_used
    MeshShape(const Mesh& mesh, const std::vector<bool>& used) : mesh_(&mesh), place_(used.size(), kNone) {
        if (mesh.influences == 0) {
            joints_ = {mesh.joint};
            inverse_bind_ = {glm::dmat4(1.0)};
        }
        for (std::size_t entry = 0; entry < used.size(); ++entry) {
            if (!used[entry]) continue;
            place_[entry] = static_cast<std::uint32_t>(joints_.size());
            joints_.push_back(mesh.palette.joints[entry]);
            inverse_bind_.emplace_back(mesh.palette.inverse_bind[entry]);
        }
        for (const MorphTarget& target : mesh.targets) {
            std::vector<Displacement>& list = targets_.emplace_back();
            for (std::size_t vertex = 0; vertex < target.positions.size(); ++vertex) {
                const glm::dvec3 shift = shift_of(target, target.positions, mesh.positions, vertex);
                if (shift != glm::dvec3(0.0)) list.push_back({static_cast<std::uint32_t>(vertex), shift});
            }
        }
    }

    [[nodiscard]] std::size_t size() const { return mesh_->positions.size(); }
    [[nodiscard]] const std::vector<std::uint32_t>& joints() const { return joints_; }
    [[nodiscard]] const std::vector<glm::dmat4>& inverse_bind() const { return inverse_bind_; }
    [[nodiscard]] const std::vector<std::vector<Displacement>>& targets() const { return targets_; }
    [[nodiscard]] std::span<const glm::vec3> positions() const { return mesh_->positions; }
    [[nodiscard]] glm::dvec3 base(std::size_t vertex) const { return {mesh_->positions[vertex]}; }
    /// Calls visit(entry, weight) for each bone that moves the vertex; `entry` is an index among the used ones.
    template <class Visit>
    void for_each_influence(std::size_t vertex, const Visit& visit) const {
        if (mesh_->influences == 0) return visit(std::uint32_t{0}, 1.0f);
        const std::size_t end = (vertex + 1) * mesh_->influences;
        for (std::size_t at = vertex * mesh_->influences; at < end; ++at) {
            if (mesh_->weights[at] != 0.0f) visit(place_[mesh_->bones[at]], mesh_->weights[at]);
        }
    }
    void mark_touched(std::vector<bool>& touched) const {
        for (const auto& target : targets_) {
            for (const Displacement& d : target) touched[d.vertex] = true;
        }
    }

private:
    const Mesh* mesh_;
    std::vector<std::uint32_t> place_;  // per palette entry: its index among the used ones
    std::vector<std::uint32_t> joints_;
    std::vector<glm::dmat4> inverse_bind_;
    std::vector<std::vector<Displacement>> targets_;
};

/// A mesh in a pose.
class PosableMesh {
public:
    /// \param shape  must outlive the mesh
    explicit PosableMesh(const MeshShape& shape)
        : shape_(&shape), matrices_(shape.joints().size()), weights_(shape.targets().size(), 0.0) {
        if (!shape.targets().empty()) positions_.assign(shape.positions().begin(), shape.positions().end());
    }

    /// Sets a pose; false if nothing has changed since the last one.
    bool set_pose(const std::vector<glm::dmat4>& joints, const std::vector<double>& weights) {
        bool has_changed = false;
        for (std::size_t entry = 0; entry < matrices_.size(); ++entry) {
            const std::uint32_t joint = shape_->joints()[entry];
            const glm::dmat4& bind = shape_->inverse_bind()[entry];
            Affine matrix(bind);
            if (joint != kNone) {
                const Affine place(joints[joint]);
                for (int c = 0; c < 3; ++c)
                    matrix.linear[c] = place.linear * matrix.linear[c] + bind[c].w * place.origin;
                matrix.origin = place.linear * matrix.origin + bind[3].w * place.origin;
            }
            has_changed = has_changed || !(matrix == matrices_[entry]);
            matrices_[entry] = matrix;
        }
        if (weights == weights_) return has_changed;
        const auto& targets = shape_->targets();
        for (std::size_t target = 0; target < targets.size(); ++target) {
            if (weights_[target] == 0.0) continue;
            for (const Displacement& d : targets[target]) positions_[d.vertex] = shape_->base(d.vertex);
        }
        weights_ = weights;
        for (std::size_t target = 0; target < targets.size(); ++target) {
            if (weights_[target] == 0.0) continue;
            for (const Displacement& d : targets[target]) positions_[d.vertex] += weights_[target] * d.by;
        }
        return true;
    }

    [[nodiscard]] glm::dvec3 place(std::size_t vertex) const {
        const glm::dvec3 position = positions_.empty() ? shape_->base(vertex) : positions_[vertex];
        glm::dvec3 sum(0.0);
        shape_->for_each_influence(
            vertex, [&](std::uint32_t entry, float weight) { sum += double{weight} * matrices_[entry](position); });
        return sum;
    }

    [[nodiscard]] const std::vector<Affine>& matrices() const { return matrices_; }
    [[nodiscard]] bool is_displaced() const {
        return std::any_of(weights_.begin(), weights_.end(), [](double weight) { return weight != 0.0; });
    }

private:
    const MeshShape* shape_;
    std::vector<Affine> matrices_;
    std::vector<glm::dvec3> positions_;  // displaced by targets; empty if there are none
    std::vector<double> weights_;
};

}  // namespace bendy::converter
