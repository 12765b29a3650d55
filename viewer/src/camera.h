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

/// A box along the axes that holds the character, metres.
struct Box {
    glm::vec3 low{-1.0f};
    glm::vec3 high{1.0f};

    [[nodiscard]] glm::vec3 centre() const { return 0.5f * (low + high); }
    [[nodiscard]] float radius() const { return 0.5f * glm::length(high - low); }
};

/// A camera on an orbit: it looks at a point, Y is up.
class Camera {
public:
    /// Looks at the box so that it fills the picture, times `options.distance`.
    void fit(const Box& box, const CameraOptions& options, float aspect);

    void orbit(float yaw, float pitch);  ///< radians, added
    void pan(const glm::vec2& move);     ///< in heights of the picture at the point looked at
    void zoom(float factor);             ///< of the distance
    void set_aspect(float width_by_height) { aspect_ = width_by_height; }

    [[nodiscard]] glm::vec3 eye() const;
    [[nodiscard]] glm::mat4 view() const;
    [[nodiscard]] glm::mat4 projection() const;
    [[nodiscard]] glm::mat4 view_projection() const { return projection() * view(); }
    /// Radians about Y, and over the horizon.
    [[nodiscard]] float yaw() const { return yaw_; }
    [[nodiscard]] float pitch() const { return pitch_; }
    [[nodiscard]] float distance() const { return distance_; }

    /// Where the ray through a place of the picture (-1 to 1, y up) meets the plane through `point` that faces the
    /// camera.
    [[nodiscard]] glm::vec3 on_plane(const glm::vec2& place, const glm::vec3& point) const;

private:
    glm::vec3 centre_{0.0f};
    float radius_ = 1.0f;  // of what is looked at: for the near and far planes
    float yaw_ = 0.0f;
    float pitch_ = 0.0f;
    float distance_ = 3.0f;
    float aspect_ = 1.0f;
};

/// True if something of the model's surface is drawn: it has triangles, lines or points. Else the skeleton stands for
/// it.
bool has_surface(const Model& model);

/// Joints that only say where IK chains are to go, targets and poles: no part of the skeleton. One a joint.
std::vector<bool> find_controls(const Model& model);

/// A box round all that is drawn of a model over a clip, at some of its times; null: the rest pose. Without a surface,
/// round the joints, controls apart.
/// \param adjust  changes every pose after the clip; may be empty
/// \param others  points that the box is to hold
Box bounding_box(const Model& model, const Clip* clip, const std::function<void(Pose&)>& adjust = {},
                 std::span<const glm::vec3> others = {});

}  // namespace bendy::viewer
