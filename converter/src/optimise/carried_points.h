#pragma once

#include "scene/evaluate.h"
#include "scene/space.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bendy::converter {

/// Points of joints in two scenes, of which the farthest from one another are looked for in many poses. Joints that a
/// clip moves only together with one above them, their carrier, have their points in its space: boxes of these points
/// are passed over by a bound, so that a pose costs no work for each joint.
class CarriedPoints {
public:
    /// \param carrier         kNone: the points are in model space
    /// \param exact, decoded  the place of the point in the carrier's space
    void add(std::uint32_t joint, std::uint32_t carrier, const glm::dvec3& exact, const glm::dvec3& decoded) {
        points_.push_back({carrier, joint, exact, decoded});
    }
    /// Call after the last point.
    void build();
    void clear();

    /// Calls visit(joint, metres) for each point whose two places are farther apart than `most`, which visit may raise.
    /// An infinite distance may be NaN.
    template <class Visit>
    void visit_farther(const EvaluatedPose& exact, const EvaluatedPose& decoded, const double& most,
                       const Visit& visit) {
        for (std::size_t number = 0; number < nodes_.size();) {
            const Node& node = nodes_[number++];
            if (node.is_first) set_carrier(points_[node.first].carrier, exact, decoded);
            ++work_;
            if (bound(node) <= most) {
                number = node.end;
                continue;
            }
            if (number != node.end) continue;  // its parts follow
            for (std::size_t at = node.first; at < node.first + node.count; ++at, ++work_) {
                const Point& point = points_[at];
                const double metres = distance(point);
                if (!(metres <= most)) visit(point.joint, metres);
            }
        }
    }

    /// The number of boxes and points looked at so far.
    [[nodiscard]] std::uint64_t work() const { return work_; }

private:
    struct Point {
        std::uint32_t carrier, joint;
        glm::dvec3 exact, decoded;  // in the carrier's space
    };
    /// Neighbouring points of one carrier; its parts follow it.
    struct Node {
        std::size_t first = 0, count = 0, end = 0;  // end: index of the first node after its parts
        glm::dvec3 middle{0.0}, half{0.0};          // the box of the exact places
        double apart = 0.0;                         // the most by which two places differ in the carrier's space
        bool is_first = false;                      // of the carrier
    };

    void add_nodes(std::size_t first, std::size_t end);
    void set_carrier(std::uint32_t carrier, const EvaluatedPose& exact, const EvaluatedPose& decoded);
    [[nodiscard]] double bound(const Node& node) const;
    [[nodiscard]] double distance(const Point& point) const;

    std::vector<Point> points_;  // sorted by carrier
    std::vector<Node> nodes_;
    Affine difference_;  // of the carrier's two places
    Affine decoded_;     // the carrier's place there
    std::uint64_t work_ = 0;
};

}  // namespace bendy::converter
