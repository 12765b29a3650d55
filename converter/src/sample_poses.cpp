#include "sample_poses.h"

#include "cycle_span.h"

#include <algorithm>

namespace bendy::converter {

std::vector<EvaluatedPose> sample_poses(const Scene& scene, std::size_t most, std::size_t most_of_cycle) {
    constexpr std::size_t kMostMatrices = std::size_t{1} << 20U;
    std::vector<EvaluatedPose> poses(1);
    evaluate_rest(scene, poses.front());
    most = std::min(most, kMostMatrices / std::max<std::size_t>(scene.joints.size(), 1));
    const std::size_t cycles = std::min(scene.cycles.size(), most);
    for (std::size_t c = 0; c < cycles; ++c) {
        const CycleSpan span = span_of(scene.cycles[c]);
        const std::size_t count = std::clamp<std::size_t>(most / cycles, 1, most_of_cycle);
        for (std::size_t k = 0; k < count; ++k) {
            const double share = count == 1 ? 0.5 : static_cast<double>(k) / static_cast<double>(count - 1);
            evaluate(scene, scene.cycles[c], span.at(share), poses.emplace_back());
        }
    }
    return poses;
}

}  // namespace bendy::converter
