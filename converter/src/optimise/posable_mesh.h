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

/// A bone of a vertex.
struct Influence {
    std::uint32_t entry = 0;  ///< index among the used entries of the palette
    float weight = 0.0f;
};

/// A vertex's displacement by a morph target.
struct Displacement {
    std::uint32_t vertex = 0;
    glm::dvec3 by{0.0};
};

/// Marks the palette entries that a mesh's vertices use.
inline void mark_used(const Mesh& mesh, std::vector<bool>& used) {
    used.resize(mesh.palette.joints.size());
    for (std::size_t at = 0; at < mesh.weights.size(); ++at) {
        if (mesh.weights[at] != 0.0f) used[mesh.bones[at]] = true;
    }
}

/// A mesh prepared for repeated posing. A rigid mesh gets a single bone.
class PosableMesh {
public:
    /// \param used  palette entries to keep, see mark_used
    PosableMesh(const Mesh& mesh, const std::vector<bool>& used)
        : base_(mesh.positions), weights_(mesh.targets.size(), 0.0) {
        if (!mesh.targets.empty()) positions_.assign(base_.begin(), base_.end());
        std::vector<std::uint32_t> place(used.size(), kNone);  // per palette entry: its index among the used ones
        if (mesh.influences == 0) {
            joints_ = {mesh.joint};
            inverse_bind_ = {glm::dmat4(1.0)};
        } else {
            for (std::size_t entry = 0; entry < used.size(); ++entry) {
                if (!used[entry]) continue;
                place[entry] = static_cast<std::uint32_t>(joints_.size());
                joints_.push_back(mesh.palette.joints[entry]);
                inverse_bind_.emplace_back(mesh.palette.inverse_bind[entry]);
            }
        }
        first_.reserve(base_.size() + 1);
        first_.push_back(0);
        for (std::size_t vertex = 0; vertex < base_.size(); ++vertex) {
            if (mesh.influences == 0) influences_.push_back({0, 1.0f});
            for (std::size_t k = 0; k < mesh.influences; ++k) {
                const std::size_t at = vertex * mesh.influences + k;
                if (mesh.weights[at] != 0.0f) influences_.push_back({place[mesh.bones[at]], mesh.weights[at]});
            }
            first_.push_back(static_cast<std::uint32_t>(influences_.size()));
        }
        for (const MorphTarget& target : mesh.targets) {
            std::vector<Displacement>& list = targets_.emplace_back();
            for (std::size_t vertex = 0; vertex < target.positions.size(); ++vertex) {
                const glm::dvec3 shift = shift_of(target, target.positions, mesh.positions, vertex);
                if (shift != glm::dvec3(0.0)) list.push_back({static_cast<std::uint32_t>(vertex), shift});
            }
        }
        matrices_.resize(joints_.size());
    }

    /// Sets a pose; false if nothing has changed since the last one.
    bool set_pose(const std::vector<glm::dmat4>& joints, const std::vector<double>& weights) {
        bool has_changed = false;
        for (std::size_t entry = 0; entry < joints_.size(); ++entry) {
            const std::uint32_t joint = joints_[entry];
            const glm::dmat4& bind = inverse_bind_[entry];
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
        for (std::size_t target = 0; target < targets_.size(); ++target) {
            if (weights_[target] == 0.0) continue;
            for (const Displacement& d : targets_[target]) positions_[d.vertex] = base(d.vertex);
        }
        weights_ = weights;
        for (std::size_t target = 0; target < targets_.size(); ++target) {
            if (weights_[target] == 0.0) continue;
            for (const Displacement& d : targets_[target]) positions_[d.vertex] += weights_[target] * d.by;
        }
        return true;
    }

    [[nodiscard]] glm::dvec3 place(std::size_t vertex) const {
        const glm::dvec3 position = positions_.empty() ? base(vertex) : positions_[vertex];
        glm::dvec3 sum(0.0);
        for (const Influence& influence : influences(vertex))
            sum += double{influence.weight} * matrices_[influence.entry](position);
        return sum;
    }

    [[nodiscard]] std::size_t size() const { return base_.size(); }
    [[nodiscard]] const std::vector<std::uint32_t>& joints() const { return joints_; }
    [[nodiscard]] const std::vector<Affine>& matrices() const { return matrices_; }
    [[nodiscard]] glm::dvec3 base(std::size_t vertex) const { return {base_[vertex]}; }
    [[nodiscard]] std::span<const Influence> influences(std::size_t vertex) const {
        return std::span(influences_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }
    [[nodiscard]] bool is_displaced() const {
        return std::any_of(weights_.begin(), weights_.end(), [](double weight) { return weight != 0.0; });
    }
    void mark_touched(std::vector<bool>& touched) const {
        for (const auto& target : targets_) {
            for (const Displacement& d : target) touched[d.vertex] = true;
        }
    }

private:
    std::vector<std::uint32_t> joints_;
    std::vector<glm::dmat4> inverse_bind_;
    std::vector<Affine> matrices_;
    std::vector<glm::vec3> base_;
    std::vector<glm::dvec3> positions_;  // displaced by targets; empty if there are none
    std::vector<std::uint32_t> first_;
    std::vector<Influence> influences_;
    std::vector<std::vector<Displacement>> targets_;
    std::vector<double> weights_;
};

}  // namespace bendy::converter
