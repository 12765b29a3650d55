#pragma once

#include <bendy/converter/scene.h>

#include <glm/mat4x4.hpp>

#include <vector>

namespace bendy::converter {

/// A scene's joints in one pose.
struct ScenePose {
    std::vector<glm::dmat4> model_space;             ///< joint to model space, one per joint
    std::vector<std::vector<float>> target_weights;  ///< of each mesh
};

ScenePose rest_pose(const Scene& scene);

/// Poses at times that are spread over every cycle, at most some hundred. Rotations are interpolated along the chord
/// and cubic tracks straight: to measure by, not to show.
std::vector<ScenePose> sample_cycles(const Scene& scene);

/// Poses of a scene without cycles: every joint turned by some tens of degrees, the same in each run.
std::vector<ScenePose> made_up_poses(const Scene& scene);

}  // namespace bendy::converter
