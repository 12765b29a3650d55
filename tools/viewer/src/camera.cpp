#include "camera.h"

#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bendy::viewer {
namespace {

constexpr float kViewAngle = 0.6f;  // radians, vertical
constexpr float kSteepest = 1.55f;  // radians: straight up has no yaw

class Points {
public:
    void add(const glm::vec3& p) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            throw ViewerError("the pose is out of a float's range");
        constexpr float kFarthest = 1e15f;  // squares of larger numbers overflow a float
        if (!(std::abs(p.x) < kFarthest && std::abs(p.y) < kFarthest && std::abs(p.z) < kFarthest)) return;
        low_ = glm::min(low_, p);
        high_ = glm::max(high_, p);
    }
    [[nodiscard]] bool empty() const { return low_.x > high_.x; }
    [[nodiscard]] Box box() const {
        // A single point gets a box of one metre.
        return low_ == high_ ? Box{low_ - 0.5f, high_ + 0.5f} : Box{low_, high_};
    }

private:
    glm::vec3 low_{std::numeric_limits<float>::max()};
    glm::vec3 high_{std::numeric_limits<float>::lowest()};
};

/// Raises the sizes of the submeshes to those in one pose.
void measure(const Model& model, std::span<const glm::vec3> positions, std::vector<float>& sizes) {
    const auto submeshes = model.submeshes();
    sizes.resize(submeshes.size());
    for (std::size_t k = 0; k < submeshes.size(); ++k) {
        const Submesh& submesh = submeshes[k];
        Points points;
        for (std::uint32_t at = 0; at < submesh.count; ++at) {
            points.add(positions[model.first_vertex(submesh.mesh) +
                                 model.meshes()[submesh.mesh].indices->index(submesh.first + at, 0)]);
        }
        if (!points.empty()) sizes[k] = std::max(sizes[k], 2.0f * points.box().radius());
    }
}

/// Returns the vertices that submeshes use; meshes may have others.
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

void Camera::fit(const Box& box, const CameraOptions& options, float aspect) {
    centre_ = box.centre();
    radius_ = std::max(box.radius(), 1e-6f);
    yaw_ = options.yaw;
    pitch_ = std::clamp(options.pitch, -kSteepest, kSteepest);
    aspect_ = aspect;
    // The smallest distance from which all corners of the box are visible.
    distance_ = radius_;
    const glm::mat4 to_camera = view();
    const float upwards = std::tan(0.5f * kViewAngle);
    float nearest = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 at((corner & 1) != 0 ? box.high.x : box.low.x, (corner & 2) != 0 ? box.high.y : box.low.y,
                           (corner & 4) != 0 ? box.high.z : box.low.z);
        const glm::vec3 p = glm::vec3(to_camera * glm::vec4(at - centre_, 0.0f));
        const float across = std::max(std::abs(p.y) / upwards, std::abs(p.x) / (upwards * aspect));
        nearest = std::max(nearest, p.z + across);
    }
    constexpr float kMargin = 1.06f;
    distance_ = std::max(kMargin * nearest * options.distance, 1e-3f * radius_);
}

void Camera::orbit(float yaw, float pitch) {
    yaw_ = std::remainder(yaw_ + yaw, 6.2831853f);
    pitch_ = std::clamp(pitch_ + pitch, -kSteepest, kSteepest);
}

void Camera::pan(const glm::vec2& move) {
    const float height = 2.0f * distance_ * std::tan(0.5f * kViewAngle);
    const glm::mat4 axes = glm::transpose(view());
    centre_ -= height * (move.x * glm::vec3(axes[0]) + move.y * glm::vec3(axes[1]));
}

void Camera::zoom(float factor) {
    distance_ = std::clamp(distance_ * factor, 1e-2f * radius_, 1e3f * radius_);
}

glm::vec3 Camera::eye() const {
    const glm::vec3 outwards(std::sin(yaw_) * std::cos(pitch_), std::sin(pitch_), std::cos(yaw_) * std::cos(pitch_));
    return centre_ + distance_ * outwards;
}

glm::mat4 Camera::view() const {
    return glm::lookAt(eye(), centre_, glm::vec3(0.0f, 1.0f, 0.0f));
}

glm::mat4 Camera::projection() const {
    const float far_plane = distance_ + 4.0f * radius_;
    const float near_plane = std::max(distance_ - 4.0f * radius_, 0.01f * std::min(distance_, radius_));
    return glm::perspective(kViewAngle, aspect_, near_plane, far_plane);
}

glm::vec3 Camera::on_plane(const glm::vec2& place, const glm::vec3& point) const {
    const glm::mat4 axes = glm::transpose(view());
    const float depth = glm::dot(point - eye(), -glm::vec3(axes[2]));
    const float up = std::tan(0.5f * kViewAngle) * place.y;
    const float right = std::tan(0.5f * kViewAngle) * aspect_ * place.x;
    return eye() + depth * (-glm::vec3(axes[2]) + right * glm::vec3(axes[0]) + up * glm::vec3(axes[1]));
}

bool has_surface(const Model& model) {
    return std::any_of(model.submeshes().begin(), model.submeshes().end(),
                       [](const Submesh& submesh) { return submesh.count != 0; });
}

std::vector<bool> find_controls(const Model& model) {
    std::vector<bool> is_control(model.joints().size());
    for (const Chain& chain : model.chains()) {
        for (const std::uint32_t joint : {chain.record.target, chain.record.pole}) {
            if (joint != kNone) is_control[joint] = true;
        }
    }
    return is_control;
}

Box bounding_box(const Model& model, const Clip* clip, const std::function<void(Pose&)>& adjust,
                 std::span<const glm::vec3> others, std::vector<float>* sizes) {
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
            if (sizes != nullptr) measure(model, positions, *sizes);
        }
    }
    return points.empty() ? Box{} : points.box();
}

}  // namespace bendy::viewer
