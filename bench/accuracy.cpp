// bench_accuracy FILE...: the largest distance of posed vertices from the converter's evaluation of the same file,
// which uses doubles and shares no code with the runtime. It is measured with every kernel of this machine, over all
// vertices, at rest and at 41 times of every clip, in millionths of the extent (the bounding box's diagonal at rest).
#include "scene/evaluate.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/runtime.h>
#include <bendy/runtime/kernels.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace {

using bendy::converter::Scene;

constexpr int kTimes = 41;

double extent_of(const std::vector<glm::vec3>& positions) {
    glm::dvec3 low(std::numeric_limits<double>::max());
    glm::dvec3 high(std::numeric_limits<double>::lowest());
    for (const glm::vec3& position : positions) {
        low = glm::min(low, glm::dvec3(position));
        high = glm::max(high, glm::dvec3(position));
    }
    return glm::distance(low, high);
}

/// Returns the largest distance between a vertex and its correct position.
double worst_of(const Scene& scene, const bendy::converter::EvaluatedPose& expected,
                const std::vector<glm::vec3>& found) {
    double worst = 0.0;
    std::size_t at = 0;
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        for (const glm::dvec3& place :
             bendy::converter::evaluate_vertices(scene.meshes[mesh], expected.morph_weights[mesh], expected.joints))
            worst = std::max(worst, glm::distance(place, glm::dvec3(found[at++])));
    }
    return worst;
}

/// Returns the largest error in millionths of the extent.
double measure(const Scene& scene, const bendy::Model& model) {
    bendy::Pose pose(model);
    std::vector<glm::vec3> positions(model.vertex_count());
    bendy::converter::EvaluatedPose expected;
    (void)bendy::skin(pose, {.out = {.positions = positions}});
    const double extent = extent_of(positions);
    bendy::converter::evaluate_rest(scene, expected);
    double worst = worst_of(scene, expected, positions);
    for (std::size_t number = 0; number < scene.clips.size(); ++number) {
        const bendy::Clip& clip = model.clips()[number];
        for (int k = 0; k < kTimes; ++k) {
            const float share = static_cast<float>(k) / (kTimes - 1);
            const float seconds = clip.start + share * (clip.end - clip.start);
            (void)bendy::sample(pose, &clip, seconds);
            (void)bendy::skin(pose, {.out = {.positions = positions}});
            bendy::converter::evaluate(scene, scene.clips[number], seconds, expected);
            worst = std::max(worst, worst_of(scene, expected, positions));
        }
    }
    return 1e6 * worst / extent;
}

}  // namespace

int main(int count, char** arguments) {
    std::printf("| file |");
    for (const bendy::Kernel kernel : bendy::kernels()) std::printf(" %s |", std::string(kernel_name(kernel)).c_str());
    std::printf("\n|---|");
    for (std::size_t k = 0; k < bendy::kernels().size(); ++k) std::printf("---|");
    std::printf("\n");
    for (int k = 1; k < count; ++k) {
        bendy::converter::Report report;
        const auto scene = bendy::converter::is_bendy_file(arguments[k])
                               ? bendy::converter::import_bendy(std::filesystem::path(arguments[k]), report)
                               : bendy::converter::import_gltf(arguments[k], {}, report);
        if (!scene) return 1;
        const std::vector<std::byte> bytes = bendy::converter::build_chunks(*scene, "accuracy", report);
        const auto model = bendy::Model::from_memory(bytes);
        if (!model) return 1;
        std::printf("| %s |", arguments[k]);
        for (const bendy::Kernel kernel : bendy::kernels()) {
            (void)bendy::set_kernel(kernel);
            std::printf(" %.3f |", measure(*scene, *model));
        }
        std::printf("\n");
    }
    return 0;
}
