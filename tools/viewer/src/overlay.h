#pragma once

#include "constraint_drawing.h"

#include <bendy/runtime.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <optional>
#include <span>
#include <vector>

namespace bendy::viewer {

struct OverlayVertex {
    glm::vec3 position;
    glm::vec3 other;    ///< the other end of a line
    glm::vec4 colour;   ///< linear, alpha not premultiplied
    float side = 0.0f;  ///< half the width of a line in pixels, its sign gives the side; 0 in a triangle
};

/// The triangles and lines that are drawn over the character.
struct OverlayList {
    std::vector<OverlayVertex> solid;
    std::vector<OverlayVertex> translucent;
    std::vector<OverlayVertex> lines;

    void clear();
    void line(const glm::vec3& a, const glm::vec3& b, const glm::vec4& colour, float pixels);
    static void triangle(std::vector<OverlayVertex>& list, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                         const glm::vec4& colour);
};

/// The target of an IK chain.
struct TargetMark {
    glm::vec3 position{0.0f};
    std::optional<glm::vec3> tip;  ///< the tip of its chain
    bool is_active = false;
};

/// Draws the skeleton, the constraints and the targets of one model. The model must outlive it.
class Overlay {
public:
    explicit Overlay(const Model& model);
    /// Sets the size of the whole character, in metres: what has no bone to scale with is drawn in proportion to it.
    void set_size(float size) { size_ = size; }

    /// Each function adds to the list.
    void add_bones(Pose& pose, OverlayList& list) const;
    void add_thin_bones(Pose& pose, OverlayList& list) const;
    void add_axes(Pose& pose, OverlayList& list) const;
    void add_constraints(Pose& pose, OverlayList& list) const;
    void add_targets(std::span<const TargetMark> targets, OverlayList& list) const;
    void add_mark(Pose& pose, std::uint32_t joint, OverlayList& list) const;

private:
    static void add_axes_of(Pose& pose, std::uint32_t joint, float length, float pixels, OverlayList& list);
    void add_constraint(const Constraint& constraint, const ConstraintDrawing& drawing, Pose& pose,
                        OverlayList& list) const;

    [[nodiscard]] float length_of(std::uint32_t joint) const;

    struct Bone {
        std::uint32_t from, to;
    };
    const Model* model_;
    float size_ = 1.0f;
    std::vector<Bone> bones_;
    std::vector<std::uint32_t> ends_;             // joints where a bone ends
    std::vector<float> lengths_;                  // of each joint's longest bone at rest; 0: none
    std::vector<const Constraint*> constraints_;  // one per joint: for poses, otherwise for IK
    std::vector<ConstraintDrawing> limits_;       // of the same constraints
};

/// Returns the targets of the model's chains. Chains without a target joint, with influence 0, or listed in `without`
/// are left out.
std::vector<TargetMark> target_marks(Pose& pose, std::span<const Chain* const> without = {});

/// Returns a chain's joints from its start to the effector.
std::vector<std::uint32_t> links_of(const Model& model, const Chain& chain);

/// Returns the position of a chain's tip.
glm::vec3 tip_of(const Chain& chain, Pose& pose);

}  // namespace bendy::viewer
