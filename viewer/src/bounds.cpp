#include "bounds.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace bendy::viewer {
namespace {

class Points {
public:
    void add(const glm::vec3& p) {
        constexpr float kFarthest = 1e15f;  // beyond, squares leave a float's range
        if (!(std::abs(p.x) < kFarthest && std::abs(p.y) < kFarthest && std::abs(p.z) < kFarthest)) return;
        low_ = glm::min(low_, p);
        high_ = glm::max(high_, p);
    }
    [[nodiscard]] bool empty() const { return low_.x > high_.x; }
    [[nodiscard]] Box box() const {
        // A point has some room round it.
        return low_ == high_ ? Box{low_ - 0.5f, high_ + 0.5f} : Box{low_, high_};
    }

private:
    glm::vec3 low_{std::numeric_limits<float>::max()};
    glm::vec3 high_{std::numeric_limits<float>::lowest()};
};

/// Vertices that something draws: meshes may hold others.
std::vector<std::uint64_t> drawn_vertices(const Model& model) {
    std::vector<bool> is_drawn(model.vertex_count());
    for (const Submesh& submesh : model.submeshes()) {
        const Mesh& mesh = model.meshes()[submesh.mesh];
        for (std::uint32_t k = 0; k < submesh.count; ++k)
            is_drawn[model.first_vertex(submesh.mesh) + mesh.indices->index(submesh.first + k, 0)] = true;
    }
    std::vector<std::uint64_t> list;
    for (std::uint64_t v = 0; v < is_drawn.size(); ++v) {
        if (is_drawn[v]) list.push_back(v);
    }
    return list;
}

}  // namespace

bool has_surface(const Model& model) {
    return std::any_of(model.submeshes().begin(), model.submeshes().end(),
                       [](const Submesh& submesh) { return submesh.count != 0; });
}

std::vector<bool> find_controls(const Model& model) {
    std::vector<bool> is_control(model.joints().size());
    for (const Chain& chain : model.chains()) {
        for (const std::uint32_t joint : {chain.target, chain.pole}) {
            if (joint != kNone) is_control[joint] = true;
        }
    }
    return is_control;
}

Box bounding_box(const Model& model, const Clip* clip, const std::function<void(Pose&)>& adjust,
                 std::span<const glm::vec3> others) {
    constexpr int kTimes = 12;
    const std::vector<std::uint64_t> drawn = drawn_vertices(model);
    std::vector<glm::vec3> positions(drawn.empty() ? 0 : model.vertex_count());
    Pose pose(model);
    const std::vector<bool> is_control = find_controls(model);
    Points points;
    for (const glm::vec3& other : others) points.add(other);
    for (int k = 0; k < (clip == nullptr ? 1 : kTimes); ++k) {
        if (clip != nullptr)
            (void)sample(pose, clip, clip->start + (clip->end - clip->start) * static_cast<float>(k) / (kTimes - 1));
        if (adjust) adjust(pose);
        if (drawn.empty()) {
            const auto matrices = pose.model_space();
            for (std::uint32_t joint = 0; joint < is_control.size(); ++joint) {
                if (!is_control[joint]) points.add(glm::vec3(matrices[joint][3]));
            }
        } else {
            (void)skin(pose, {.out = {.positions = positions}});
            for (const std::uint64_t v : drawn) points.add(positions[v]);
        }
    }
    return points.empty() ? Box{} : points.box();
}

}  // namespace bendy::viewer
