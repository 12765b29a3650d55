#include "camera.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace bendy::viewer {
namespace {

constexpr float kViewAngle = 0.6f;  // radians, vertical
constexpr float kSteepest = 1.55f;  // radians: straight up has no yaw

}  // namespace

void Camera::fit(const Box& box, const CameraOptions& options, float aspect) {
    centre_ = box.centre();
    radius_ = std::max(box.radius(), 1e-6f);
    yaw_ = options.yaw;
    pitch_ = std::clamp(options.pitch, -kSteepest, kSteepest);
    aspect_ = aspect;
    // As near as each of the box's corners allows.
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

}  // namespace bendy::viewer
