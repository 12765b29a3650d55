#pragma once

#include <bendy/converter/scene.h>

#include <cstddef>
#include <vector>

namespace bendy::converter {

/// Model space matrices of all joints in the rest pose and in poses spread evenly over every cycle; to estimate by how
/// much poses enlarge an error, so rotations between keys are rough. Never more than some 200 MB.
std::vector<std::vector<glm::dmat4>> sample_poses(const Scene& scene);

/// The largest factor by which the matrix lengthens a vector.
double largest_stretch(const glm::dmat4& matrix);

}  // namespace bendy::converter
