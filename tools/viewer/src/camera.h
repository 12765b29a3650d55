#pragma once

#include <bendy/runtime.h>
#include <bendy/viewer/render.h>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <span>
#include <vector>

// The camera, and what it looks at.

namespace bendy::viewer {

/// An axis-aligned box around the character, metres.
struct Box {
    glm::vec3 low{-1.0f};
    glm::vec3 high{1.0f};

    [[nodiscard]] glm::vec3 centre() const { return 0.5f * (low + high); }
    [[nodiscard]] float radius() const { return 0.5f * glm::length(high - low); }
};

/// A camera that orbits a point; Y is up.
class Camera {
public:
    /// Looks at the box from the distance at which the box fills the picture, times `options.distance`.
    void fit(const Box& box, const CameraOptions& options, float aspect);

    void orbit(float yaw, float pitch);  ///< radians, relative
    void pan(const glm::vec2& move);     ///< in picture heights, at the distance of the orbit's centre
    void zoom(float factor);             ///< multiplies the distance
    void set_aspect(float width_by_height) { aspect_ = width_by_height; }

    [[nodiscard]] glm::vec3 eye() const;
    [[nodiscard]] glm::mat4 view() const;
    [[nodiscard]] glm::mat4 projection() const;
    [[nodiscard]] glm::mat4 view_projection() const { return projection() * view(); }
    /// Radians about Y, and above the horizon.
    [[nodiscard]] float yaw() const { return yaw_; }
    [[nodiscard]] float pitch() const { return pitch_; }
    [[nodiscard]] float distance() const { return distance_; }

    /// Returns the point where the ray through a position in the picture (-1 to 1, y up) meets the plane through
    /// `point` that faces the camera.
    [[nodiscard]] glm::vec3 on_plane(const glm::vec2& place, const glm::vec3& point) const;

private:
    glm::vec3 centre_{0.0f};
    float radius_ = 1.0f;  // of the character, for the near and far planes
    float yaw_ = 0.0f;
    float pitch_ = 0.0f;
    float distance_ = 3.0f;
    float aspect_ = 1.0f;
};

/// Returns true if the model has triangles, lines or points to draw. Otherwise its skeleton is drawn.
bool has_surface(const Model& model);

/// Returns for each joint whether it is the target or pole of an IK chain, and so not part of the skeleton.
std::vector<bool> find_controls(const Model& model);

/// Returns a box around everything that is drawn of a model, at a dozen times of the clip; null: in the rest pose. If
/// the model has no surface, the box contains its joints, without the controls.
/// Throws ViewerError if something that is drawn is out of a float's range.
/// \param adjust  changes every pose after sampling; may be empty
/// \param others  further points that the box contains
/// \param sizes   receives the largest diagonal of each submesh, metres; may be null
Box bounding_box(const Model& model, const Clip* clip, const std::function<void(Pose&)>& adjust = {},
                 std::span<const glm::vec3> others = {}, std::vector<float>* sizes = nullptr);

}  // namespace bendy::viewer
