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
    glm::vec3 other;    ///< of a line: its other end
    glm::vec4 colour;   ///< linear, alpha straight
    float side = 0.0f;  ///< of a line: pixels to its edge, sign by side; 0 in a triangle
};

/// Triangles of the things that are drawn over the character.
struct OverlayList {
    std::vector<OverlayVertex> solid;
    std::vector<OverlayVertex> translucent;
    std::vector<OverlayVertex> lines;

    void clear();
    void line(const glm::vec3& a, const glm::vec3& b, const glm::vec4& colour, float pixels);
    static void triangle(std::vector<OverlayVertex>& list, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                         const glm::vec4& colour);
};

/// A chain's target as a player has it.
struct TargetMark {
    glm::vec3 position{0.0f};
    std::optional<glm::vec3> tip;  ///< what is to reach it
    bool is_active = false;
};

/// Draws the skeleton, the constraints and the targets of one model. The model must outlive it.
class Overlay {
public:
    /// `size`: of the whole character, metres: what cannot be measured by a bone goes by it.
    Overlay(const Model& model, float size);

    /// Each adds to the list; the pose must be up to date.
    void add_bones(Pose& pose, OverlayList& list) const;
    void add_axes(Pose& pose, OverlayList& list) const;
    void add_constraints(Pose& pose, OverlayList& list) const;
    void add_targets(std::span<const TargetMark> targets, OverlayList& list) const;
    void add_mark(Pose& pose, std::uint32_t joint, OverlayList& list) const;

private:
    static void add_axes_of(Pose& pose, std::uint32_t joint, float length, float pixels, OverlayList& list);
    void add_constraint(const Constraint& constraint, const ConstraintDrawing& drawing, Pose& pose,
                        OverlayList& list) const;

    struct Bone {
        std::uint32_t from, to;
    };
    const Model* model_;
    float size_;
    std::vector<Bone> bones_;
    std::vector<std::uint32_t> ends_;  // joints where a bone ends
    std::vector<float> lengths_;       // of each joint's longest bone at rest, model space; or a share of the size
    std::vector<const Constraint*> constraints_;  // one a joint: what poses obey, or else what the solvers do
    std::vector<ConstraintDrawing> limits_;       // as many
};

/// Where the chains' target joints are in a pose that is up to date; chains without one, that are off, or that stand in
/// `without`, are left out.
std::vector<TargetMark> target_marks(Pose& pose, std::span<const Chain* const> without = {});

/// A chain's joints from its start to the effector.
std::vector<std::uint32_t> links_of(const Model& model, const Chain& chain);

/// Where a chain's tip is.
glm::vec3 tip_of(const Chain& chain, Pose& pose);

}  // namespace bendy::viewer
