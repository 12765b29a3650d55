// bendy_bench_morph [--benchmark_...]: the cost of an entry of a morph target, which is one touched vertex of one
// active target. The counter per_entry is in seconds.
#include <bendy/runtime.h>

#include "made_models.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace {

using namespace bendy;

constexpr std::uint32_t kVertices = 6000, kTargets = 73, kActive = 26, kTouched = 442;

/// Every third target is active.
std::vector<float> make_weights(float weight) {
    std::vector<float> weights(kTargets, 0.0f);
    for (std::uint32_t k = 0; k < kActive; ++k) weights[std::size_t{k} * kTargets / kActive] = weight;
    return weights;
}

/// \param with_skin  uses skin(), which displaces a few vertices at a time and then skins them; otherwise
///                   apply_morph_targets()
void morph(benchmark::State& state, bool is_packed, bool with_skin, float weight) {
    const auto made = bench::make_face(kVertices, kTargets, kTouched, is_packed);
    const Model& model = made->model;
    Pose pose(model);
    const std::vector<float> weights = make_weights(weight);
    std::copy(weights.begin(), weights.end(), pose.change_morph_weights().begin());
    std::vector<glm::vec3> positions(kVertices), normals(kVertices);
    while (state.KeepRunning()) {
        if (with_skin) {
            (void)skin(pose, {.out = {.positions = positions, .normals = normals}});
        } else {
            (void)apply_morph_targets(model.meshes()[0], weights, {positions, normals, {}});
        }
        benchmark::ClobberMemory();
    }
    if (weight != 0.0f) {
        state.counters["per_entry"] = benchmark::Counter(static_cast<double>(state.iterations()) * kActive * kTouched,
                                                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    }
}

}  // namespace

BENCHMARK_CAPTURE(morph, floats / rest, false, false, 0.0f);
BENCHMARK_CAPTURE(morph, floats / apply, false, false, 0.5f);
BENCHMARK_CAPTURE(morph, floats / skin, false, true, 0.5f);
BENCHMARK_CAPTURE(morph, packed / rest, true, false, 0.0f);
BENCHMARK_CAPTURE(morph, packed / apply, true, false, 0.5f);
BENCHMARK_CAPTURE(morph, packed / skin, true, true, 0.5f);

BENCHMARK_MAIN();
