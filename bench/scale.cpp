// bendy_bench_scale [--benchmark_...]: the cost per joint and per vertex, from few to very many, with synthetic
// characters. The counters per_joint and per_vertex are in seconds.
#include <bendy/runtime.h>

#include "made_models.h"

#include <benchmark/benchmark.h>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace bendy;

Result<Model> open(Bytes bytes, Sums sums) {
    OpenOptions options;
    options.sums = sums;
    return Model::from_memory(bytes, options);
}

struct Character {
    std::uint32_t joints = 0;
    std::uint32_t vertices = 0;
    std::vector<std::byte> bytes;
    Model model;
};

/// Makes the character when it is first measured and keeps only the current one, because the largest takes gigabytes.
Character& character(std::uint32_t joints, std::uint32_t vertices) {
    static std::unique_ptr<Character> kept;
    if (!kept || kept->joints != joints || kept->vertices != vertices) {
        kept.reset();
        std::vector<std::byte> bytes = bench::make_character(joints, vertices);
        auto model = open(bytes, Sums::checked);
        if (!model) std::abort();  // made_models writes valid files
        kept = std::make_unique<Character>(Character{joints, vertices, std::move(bytes), *std::move(model)});
    }
    return *kept;
}

using Measure = void (*)(benchmark::State&, Character&);

void open_checked(benchmark::State& state, Character& of) {
    while (state.KeepRunning()) benchmark::DoNotOptimize(open(of.bytes, Sums::checked).has_value());
}

void open_later(benchmark::State& state, Character& of) {
    while (state.KeepRunning()) benchmark::DoNotOptimize(open(of.bytes, Sums::later).has_value());
}

/// Includes opening with Sums::later, and the plans that a model's first Pose makes.
void open_to_first_pose(benchmark::State& state, Character& of) {
    while (state.KeepRunning()) {
        const auto fresh = open(of.bytes, Sums::later);
        const Pose pose(*fresh);
        benchmark::DoNotOptimize(&pose);
    }
}

void sample_steps(benchmark::State& state, const Model& model, float step) {
    const Clip& clip = model.clips().front();
    Pose pose(model);
    float seconds = 0.0f;
    while (state.KeepRunning()) {
        seconds += step;
        if (seconds > clip.end) seconds -= clip.end;
        (void)sample(pose, &clip, seconds);
    }
}

void next_frame(benchmark::State& state, Character& of) {
    sample_steps(state, of.model, 1.0f / 60.0f);
}

void random_time(benchmark::State& state, Character& of) {
    sample_steps(state, of.model, 0.61803399f);
}

void to_model(benchmark::State& state, Character& of) {
    Pose pose(of.model);
    (void)sample(pose, &of.model.clips().front(), 0.5f);
    while (state.KeepRunning()) {
        (void)pose.change_local_blocks();
        (void)pose.model_space();
    }
}

void skin_vertices(benchmark::State& state, Character& of, bool with_normals) {
    Pose pose(of.model);
    (void)sample(pose, &of.model.clips().front(), 0.5f);
    std::vector<glm::vec3> positions(of.vertices);
    std::vector<glm::vec3> normals(with_normals ? of.vertices : 0);
    while (state.KeepRunning()) {
        (void)skin(pose, {.out = {.positions = positions, .normals = normals}});
        benchmark::ClobberMemory();
    }
}

void skin_positions(benchmark::State& state, Character& of) {
    skin_vertices(state, of, false);
}

void skin_normals(benchmark::State& state, Character& of) {
    skin_vertices(state, of, true);
}

void add(std::uint32_t joints, std::uint32_t vertices, const char* what, [[maybe_unused]] Measure measure) {
    const bool is_skinned = vertices > 0;
    const std::uint32_t items = is_skinned ? vertices : joints;
    const std::string unit = is_skinned ? "vertex" : "joint";
    const std::string name = std::to_string(items) + (is_skinned ? " vertices/" : " joints/") + what;
#ifndef __clang_analyzer__  // reports a leak, although the library's list frees the benchmarks
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        measure(state, character(joints, vertices));
        state.counters["per_" + unit] = benchmark::Counter(static_cast<double>(state.iterations()) * items,
                                                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    });
#endif
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    for (const std::uint32_t joints : {10u, 100u, 1'000u, 10'000u}) {
        add(joints, 0, "open", open_checked);
        add(joints, 0, "open, sums later", open_later);
        add(joints, 0, "next frame", next_frame);
        add(joints, 0, "random time", random_time);
        add(joints, 0, "local to model", to_model);
    }
    constexpr std::uint32_t kJoints = 100;
    for (const std::uint32_t vertices : {1'000u, 10'000u, 100'000u, 1'000'000u, 10'000'000u}) {
        add(kJoints, vertices, "open", open_checked);
        add(kJoints, vertices, "open, sums later", open_later);
        add(kJoints, vertices, "first pose, opening included", open_to_first_pose);
        add(kJoints, vertices, "skin positions", skin_positions);
        add(kJoints, vertices, "skin positions, normals", skin_normals);
    }
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
