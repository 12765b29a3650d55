#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/pose.h>

#include <glm/vec3.hpp>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// An axis-aligned box that includes both corners; empty if a minimum is above its maximum, which is the initial state.
struct Box {
    glm::vec3 minimum{std::numeric_limits<float>::infinity()};
    glm::vec3 maximum{-std::numeric_limits<float>::infinity()};

    [[nodiscard]] bool is_empty() const {
        return minimum.x > maximum.x || minimum.y > maximum.y || minimum.z > maximum.z;
    }
    [[nodiscard]] bool contains(const glm::vec3& point) const {
        return point.x >= minimum.x && point.y >= minimum.y && point.z >= minimum.z && point.x <= maximum.x &&
               point.y <= maximum.y && point.z <= maximum.z;
    }
};

/// Returns the smallest box that contains both.
[[nodiscard]] Box unite(const Box& a, const Box& b);

/// Boxes that contain everything that `skin` makes of a model in any pose, without skinning it: for culling, level of
/// detail, and ray casts that pick a joint first. Construction takes time linear in vertices, influences and
/// displacements; a query takes time linear in the number of joints with vertices. For linear skinning only: dual
/// quaternions may bulge out of the box.
///
/// A skinned vertex is a weighted mean of the positions to which each of its joints alone would take it, so it lies in
/// the box around those joints' boxes. A morph target extends a joint's box by weight * the box of its displacements
/// there. The boxes also allow for weights that are negative or do not sum to 1, and for rounding: 4e-6 of the numbers
/// that contribute to a corner. Vertices that are not finite, and vertices moved by joints that are not, are left out.
class Bounds {
public:
    explicit Bounds(const Model& model);

    [[nodiscard]] const Model& model() const { return model_; }
    /// The box of the vertices that the joint moves, in joint space, with morph target weights 0; empty if it moves
    /// none, or if the joint does not exist.
    [[nodiscard]] Box joint(std::uint32_t joint) const;

    // Boxes for a pose, in model space. Errors: other_model for a pose of another model, out_of_range.

    /// The box of all vertices that the joint moves, as if that joint alone moved them.
    [[nodiscard]] Result<Box, CallError> of(Pose& pose, std::uint32_t joint) const;
    /// The box of all vertices; empty if there are none.
    [[nodiscard]] Result<Box, CallError> of(Pose& pose) const;

private:
    /// The vertices that move with one joint.
    struct JointBox {
        Box box;
        std::uint32_t first_shift = 0, shifts = 0;  // into shifts_
    };
    /// The displacements of a joint's vertices by one target, in joint space; includes zero, for vertices that it
    /// leaves alone.
    struct Shift {
        std::uint32_t target = 0;  // index among the targets of all meshes
        Box box;
    };
    struct Builder;

    /// \param joint  of the model; the pose is, too
    [[nodiscard]] Box in_model_space(Pose& pose, std::uint32_t joint) const;
    [[nodiscard]] Box shifted(const JointBox& joint, std::span<const float> weights) const;

    Model model_;
    std::vector<JointBox> joints_;  // the last one: vertices that no joint moves
    std::vector<Shift> shifts_;
    double slack_ = 0.0;       // the worst deviation of a vertex's weights from non-negative with a sum of 1
    bool has_origin_ = false;  // some vertices have no weights: skinning puts them at the origin
};

}  // namespace bendy
