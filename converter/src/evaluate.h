#pragma once

#include <bendy/converter/scene.h>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <vector>

// What a Scene looks like at a time, in double precision and by glTF's rules alone: it shares no code with the runtime,
// so that each can be held against the other. No function of libm but the square root: the same everywhere.
namespace bendy::converter {

struct EvaluatedPose {
    std::vector<glm::dmat4> joints;                   ///< joint to model space
    std::vector<std::vector<double>> target_weights;  ///< of each mesh
};

/// The rest pose with the targets' rest weights.
void evaluate_rest(const Scene& scene, EvaluatedPose& pose);

/// A cycle at a time of its own time line, in seconds; before its first and after its last key a track holds. What it
/// does not animate rests.
void evaluate(const Scene& scene, const Cycle& cycle, double seconds, EvaluatedPose& pose);

/// One track's value at a time: `components` numbers. Rotations: linear is the shortest great arc, cubic is normalised.
void evaluate_track(const Track& track, double seconds, std::vector<double>& value);

/// A mesh's vertices in model space: displaced by its targets, then moved by its bones, or by its joint if it is rigid.
/// \param target_weights  one per target, or none: not displaced
std::vector<glm::dvec3> evaluate_vertices(const Mesh& mesh, const std::vector<double>& target_weights,
                                          const std::vector<glm::dmat4>& joints);

}  // namespace bendy::converter
