#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/pose.h>

#include <glm/vec3.hpp>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// An axis-aligned box, both corners in it; empty where a minimum is above its maximum, as at first.
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

/// The smallest box around both.
[[nodiscard]] Box unite(const Box& a, const Box& b);

/// Boxes that hold all that `skin` makes of a model in any pose, without skinning it: for culling, level of detail, and
/// rays that look for a joint first. Made once, in time linear in vertices, influences and displacements; asking costs
/// as much as there are joints with vertices. Linear skinning only: dual quaternions may bulge out of it.
///
/// A vertex lies among the places to which each of its joints alone would take it, so it lies in the box around their
/// boxes. Targets widen a joint's box by weight * the box of their displacements there. What weights that are negative
/// or do not sum to 1 do is added, and so is rounding: 4e-6 of the numbers that go into a corner. Vertices that are not
/// finite, and what is moved by joints that are not, are left out.
class Bounds {
public:
    explicit Bounds(const Model& model);

    [[nodiscard]] const Model& model() const { return model_; }
    /// In joint space, of the vertices that the joint moves, with morph target weights 0; empty if it moves none.
    [[nodiscard]] const Box& joint(std::uint32_t joint) const { return joints_[joint].box; }

    // Of a pose of the model, in model space.

    /// Of all that the joint moves, as the joint alone would have it.
    [[nodiscard]] Box of(Pose& pose, std::uint32_t joint) const;
    /// Of all vertices; empty if there are none.
    [[nodiscard]] Box of(Pose& pose) const;

private:
    /// What moves with one joint.
    struct JointBox {
        Box box;
        std::uint32_t first_shift = 0, shifts = 0;  // in shifts_
    };
    /// Displacements by one target of what one joint moves, in joint space, and the place of those it leaves alone.
    struct Shift {
        std::uint32_t target = 0;  // of all meshes
        Box box;
    };
    struct Builder;

    [[nodiscard]] Box shifted(const JointBox& joint, std::span<const float> weights) const;

    Model model_;
    std::vector<JointBox> joints_;  // the last one: what nothing moves
    std::vector<Shift> shifts_;
    double slack_ = 0.0;       // how far weights are from positive and a sum of 1, at worst
    bool has_origin_ = false;  // vertices without weights: skinning puts them at the origin
};

}  // namespace bendy
