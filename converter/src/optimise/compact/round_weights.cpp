#include "optimise/compact/round_weights.h"

#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace bendy::converter {

std::vector<float> weight_steps(const Mesh& mesh, double most_error) {
    constexpr int kCoarsest = -10;  // exponents: normals and programs that read weights see them, too
    constexpr int kFinest = -23;
    // Steps are the finer the farther a target reaches; `most` says how roundings add up at one vertex, as independent
    // ones do.
    std::vector<double> reach(mesh.targets.size());
    std::vector<double> sums(mesh.positions.size());
    for (std::size_t t = 0; t < reach.size(); ++t) {
        const MorphTarget& target = mesh.targets[t];
        if (target.is_frame) continue;  // it has no weight in a track
        for (const glm::vec3& shift : target.positions) reach[t] = std::max(reach[t], glm::length(glm::dvec3(shift)));
        if (!(reach[t] > 0.0)) continue;
        for (std::size_t v = 0; v < target.positions.size(); ++v) {
            const glm::dvec3 shift(target.positions[v]);
            sums[v] += glm::dot(shift, shift) / (reach[t] * reach[t]);
        }
    }
    const double most = sums.empty() ? 0.0 : std::sqrt(*std::max_element(sums.begin(), sums.end()));
    std::vector<float> steps;
    for (const double metres : reach) {
        const double step = metres > 0.0 ? 2.0 * most_error / (most * metres) : 1.0;
        int exponent = kFinest;
        if (step > 0.0 && std::isfinite(step)) std::frexp(step, &exponent);
        steps.push_back(std::ldexp(1.0f, std::clamp(exponent - 1, kFinest, kCoarsest)));  // at most `step`
    }
    return steps;
}

void round_weights(Clip& clip, const std::vector<std::vector<float>>& steps, int finer) {
    for (Track& track : clip.tracks) {
        if (track.path != TrackPath::weights || track.interpolation == Interpolation::cubic) continue;
        const std::vector<float>& of_mesh = steps[track.target];
        for (std::size_t at = 0; at < track.values.size(); ++at) {
            const float step = std::ldexp(of_mesh[at % track.components], -finer);
            const float rounded = std::nearbyint(track.values[at] / step) * step;
            if (std::isfinite(rounded)) track.values[at] = rounded;
        }
    }
}

}  // namespace bendy::converter
