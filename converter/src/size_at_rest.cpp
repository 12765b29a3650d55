#include "size_at_rest.h"

#include "cycle_span.h"
#include "evaluate.h"

#include <glm/common.hpp>

#include <algorithm>
#include <limits>

namespace bendy::converter {
namespace {

class Extent {
public:
    void add(const glm::dvec3& point) {
        low_ = glm::min(low_, point);
        high_ = glm::max(high_, point);
    }
    void add_origins(const EvaluatedPose& pose) {
        for (const glm::dmat4& joint : pose.joints) add(glm::dvec3(joint[3]));
    }
    [[nodiscard]] bool is_empty() const { return !(low_.x <= high_.x); }
    /// The height, or the largest side of what has none to speak of; 0 if empty.
    [[nodiscard]] double height() const {
        if (is_empty()) return 0.0;
        constexpr double kFlat = 1e-3;  // of the largest side
        const glm::dvec3 size = high_ - low_;
        const double largest = std::max({size.x, size.y, size.z});
        return size.y > kFlat * largest ? size.y : largest;
    }

private:
    glm::dvec3 low_{std::numeric_limits<double>::max()};
    glm::dvec3 high_{std::numeric_limits<double>::lowest()};
};

double height_of_joints(const Scene& scene, EvaluatedPose& pose) {
    if (scene.joints.empty()) return 0.0;
    Extent extent;
    extent.add_origins(pose);
    if (extent.height() > 0.0) return extent.height();
    constexpr int kSamples = 32;  // of a clip
    for (const Cycle& cycle : scene.cycles) {
        const CycleSpan span = span_of(cycle);
        for (int k = 0; k <= kSamples; ++k) {
            evaluate(scene, cycle, span.at(static_cast<double>(k) / kSamples), pose);
            extent.add_origins(pose);
        }
    }
    return extent.height() > 0.0 ? extent.height() : 1.0;
}

}  // namespace

double height_at_rest(const Scene& scene) {
    EvaluatedPose rest;
    evaluate_rest(scene, rest);
    Extent extent;
    for (const Mesh& mesh : scene.meshes) {
        for (const glm::dvec3& posed : evaluate_vertices(mesh, {}, rest.joints)) extent.add(posed);
    }
    return extent.is_empty() ? height_of_joints(scene, rest) : extent.height();
}

}  // namespace bendy::converter
