#pragma once

#include <bendy/converter/scene.h>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <limits>
#include <vector>

namespace bendy::converter {

// What a Scene looks like at a time, in double precision and by glTF's rules alone: it shares no code with the runtime
// but trig.h, so that each can be compared with the other. No function of libm but the square root: the same
// everywhere.

struct EvaluatedPose {
    std::vector<glm::dmat4> joints;                  ///< joint to model space
    std::vector<std::vector<double>> morph_weights;  ///< of each mesh
};

/// The rest pose with the targets' rest weights.
void evaluate_rest(const Scene& scene, EvaluatedPose& pose);

/// A clip at a time of its own time line, in seconds; before its first and after its last key a track holds. What it
/// does not animate rests.
void evaluate(const Scene& scene, const Clip& clip, double seconds, EvaluatedPose& pose);

/// One track's value at a time: `components` numbers. Rotations: linear is the shortest great arc, cubic is normalised.
void evaluate_track(const Track& track, double seconds, std::vector<double>& value);

/// A mesh's vertices in model space: displaced by its targets, then moved by its bones, or by its joint if it is rigid.
/// \param morph_weights  one per target, or none: not displaced
std::vector<glm::dvec3> evaluate_vertices(const Mesh& mesh, const std::vector<double>& morph_weights,
                                          const std::vector<glm::dmat4>& joints);

/// Poses to estimate by: the rest pose, then every clip at times spread evenly from its first key to its last.
/// \param most           of all clips together; large skeletons get fewer, so that they take some 33 MB at most
/// \param most_of_clip  of one clip
std::vector<EvaluatedPose> sample_poses(const Scene& scene, std::size_t most,
                                        std::size_t most_of_clip = std::numeric_limits<std::size_t>::max());

/// How far from a joint, as a share of the character's height, its turning and stretching are measured where no skin
/// shows them.
constexpr double kJointReach = 0.03;

/// Metres: the height of the character's skin at rest; the largest side of what is flat. Of a scene without a vertex
/// the size of its skeleton: of its joints' origins at rest or, where these lie at one point, over its clips; 1 for one
/// whose joints never leave that point.
double height_at_rest(const Scene& scene);

}  // namespace bendy::converter
