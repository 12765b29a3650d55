#include "near_poses.h"

#include "converter/posed_scene.h"
#include "evaluate.h"
#include "frame_shapes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace bendy::converter {
namespace {

/// The largest distance from evaluate's places, at points as far from a joint as the skeleton is large, as a share of
/// what the doubts allow.
double share_of_doubt(const Scene& scene, const Clip& clip, int times) {
    NearPoses near(scene, clip, NearPoses::Rotations::as_they_are);
    EvaluatedPose exact;
    double worst = 0.0;
    const ClipSpan span = span_of(clip);
    for (int k = 0; k <= times; ++k) {
        const double seconds = span.at(static_cast<double>(k) / times);
        near.set(seconds);
        evaluate(scene, clip, seconds, exact);
        for (std::size_t joint = 0; joint < scene.joints.size(); ++joint) {
            const Affine right(exact.joints[joint]);
            const Affine& found = near.places()[joint];
            const Doubt& doubt = near.doubts()[joint];
            for (const glm::dvec3& point : {glm::dvec3(0.0), glm::dvec3(1.0, 2.0, -3.0)}) {
                const double allowed = doubt.linear * glm::length(point) + doubt.origin;
                worst = std::max(worst, glm::distance(right(point), found(point)) / allowed);
            }
        }
    }
    return worst;
}

TEST(NearPoses, AreWithinTheirDoubts) {
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
        const Scene scene = test::random_scene(seed);
        for (const Clip& clip : scene.clips) EXPECT_LT(share_of_doubt(scene, clip, 300), 0.5) << "seed " << seed;
    }
}

TEST(NearPoses, LeaveHalfTurnsOpen) {
    Scene scene;
    scene.joints.resize(1);
    Clip clip;
    clip.tracks = {{TrackPath::rotation, Interpolation::linear, 0, 4, {0.0f, 1.0f}, {0, 0, 0, 1, 1, 0, 0, 0}}};
    NearPoses near(scene, clip, NearPoses::Rotations::as_they_are);
    near.set(0.5);
    EXPECT_TRUE(std::isinf(near.doubts()[0].linear));
}

}  // namespace
}  // namespace bendy::converter
