#pragma once

#include <bendy/converter/scene.h>

#include <vector>

namespace bendy::converter {

/// For each target of a mesh, the step to whose multiples a clip's weights may be rounded: a power of two, at most
/// 1/1024. Roundings seldom add up, so the sum of all targets is expected to keep the bound; the result has to be
/// measured.
/// \param most_error  in the mesh's space
std::vector<float> weight_steps(const Mesh& mesh, double most_error);

/// Rounds the weights in a clip's step and linear tracks, which are encoded much better then.
/// \param steps  for each mesh, see weight_steps
/// \param finer  how often the steps are halved
void round_weights(Clip& clip, const std::vector<std::vector<float>>& steps, int finer);

}  // namespace bendy::converter
