// bendy_bench [FILE.bendy...] [--benchmark_...]: the whole table of costs. For each file it measures every stage of
// `bendy bench`, and crowds; then meshes of four influences with 1,000 to 1,000,000 vertices, and chains.
// --benchmark_filter=REGEX selects stages. To compare kernels, use BENDY_KERNEL=plain, or `bendy bench --kernel`, which
// measures them alternately.
#include "made_models.h"

#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>
#include <bendy/stages/stages.h>

#include <benchmark/benchmark.h>

#ifdef BENDY_HAS_TBB
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

using namespace bendy;

namespace {

/// Uses processor time for one thread, because other programs disturb it less, and elapsed time for several threads.
void add(const std::string& name, const std::function<void(benchmark::State&)>& measure, std::size_t threads = 1) {
#ifndef __clang_analyzer__  // reports a leak, although the library's list frees the benchmarks
    auto* const added = benchmark::RegisterBenchmark(name.c_str(), measure);
    if (threads > 1) added->UseRealTime();
#endif
}

/// Sets the counter of seconds per item, for the `items` of an iteration.
void per_item(benchmark::State& state, const char* item, double items) {
    state.counters[std::string("per_") + item] = benchmark::Counter(
        static_cast<double>(state.iterations()) * items, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// A file and its stages, which must not move.
struct File {
    File(const std::filesystem::path& path, Model opened)
        : model(std::move(opened)),
          steps([path](const OpenOptions& options) { return Model::open(path, options); }, model,
                model.clips().empty() ? nullptr : model.clips().data()) {}
    Model model;
    stages::Stages steps;
};

// --- crowds

/// A pool of threads, one for each worker of a crowd.
class Threads {
public:
#ifdef BENDY_HAS_TBB
    explicit Threads(const Crowd& crowd) : arena_(static_cast<int>(crowd.workers())) {}

    void play(Crowd& crowd, std::span<const CrowdMember> members) {
        arena_.execute([&] {
            tbb::parallel_for(tbb::blocked_range<std::size_t>(0, members.size(), 4), [&](const auto& range) {
                (void)crowd.play(members.subspan(range.begin(), range.size()),
                                 static_cast<std::size_t>(tbb::this_task_arena::current_thread_index()));
            });
        });
    }

private:
    tbb::task_arena arena_;
#else
    explicit Threads(const Crowd& /*crowd*/) {}
    static void play(Crowd& crowd, std::span<const CrowdMember> members) {
        (void)crowd.play(members);
    }
#endif
};

bool has_normals(const Model& model) {
    return std::any_of(model.meshes().begin(), model.meshes().end(),
                       [](const Mesh& mesh) { return mesh.normals.has_value(); });
}

/// Each member has its own time and writes positions and normals, if there are any, or only palettes, to its own
/// memory.
void measure_crowd(benchmark::State& state, const Model& model, std::size_t count, std::size_t threads,
                   bool is_skinned) {
    Crowd crowd(model, threads);
    const std::size_t each = has_normals(model) ? 6 : 3;
    const std::size_t numbers = is_skinned ? model.vertex_count() * each : 0;
    const std::size_t entries = is_skinned ? 0 : crowd.palette_size();
    std::vector<float> vertices(count * numbers);
    std::vector<PaletteMatrix> palettes(count * entries);
    std::vector<CrowdMember> members(count);
    const Clip& clip = model.clips().front();
    std::mt19937 random(1);
    std::uniform_real_distribution<float> anywhere(clip.start, clip.end);
    for (std::size_t k = 0; k < count; ++k) {
        members[k].clip = &clip;
        members[k].seconds = anywhere(random);
        members[k].palette = std::span(palettes).subspan(k * entries, entries);
        if (!is_skinned) continue;
        const std::span<float> own = std::span(vertices).subspan(k * numbers, numbers);
        members[k].out.positions = {own, each};
        if (each == 6) members[k].out.normals = {own.subspan(3), each};
    }
    Threads mesh(crowd);
    mesh.play(crowd, members);
    while (state.KeepRunning()) {
        mesh.play(crowd, members);
        benchmark::ClobberMemory();
    }
    state.counters["characters/ms"] = benchmark::Counter(
        static_cast<double>(state.iterations()) * static_cast<double>(count) / 1000.0, benchmark::Counter::kIsRate);
}

void add_crowds(const std::string& name, const Model& model) {
    if (model.clips().empty() || model.vertex_count() == 0) return;
    constexpr std::size_t kMost = std::size_t{4} << 30;  // bytes
#ifdef BENDY_HAS_TBB
    constexpr std::array<std::size_t, 2> kThreads{1, 2};
#else
    constexpr std::array<std::size_t, 1> kThreads{1};
#endif
    for (const std::size_t count : {1'000u, 10'000u}) {
        if (count * model.vertex_count() * 6 * sizeof(float) > kMost) continue;
        for (const std::size_t threads : kThreads) {
            const std::string of = name + "/crowd of " + std::to_string(count) + ", threads " + std::to_string(threads);
            add(
                of, [&model, count, threads](auto& state) { measure_crowd(state, model, count, threads, true); },
                threads);
            add(
                of + ", palettes only",
                [&model, count, threads](auto& state) { measure_crowd(state, model, count, threads, false); }, threads);
        }
    }
}

// --- bounds and dual quaternions

/// Measures bounds, and dual quaternions with positions and normals like the stage "skin positions, normals".
void add_bounds_and_duals(const std::string& name, const Model& model) {
    if (model.vertex_count() == 0) return;
    add(name + "/bounds", [&model](auto& state) {
        const Bounds bounds(model);
        Pose pose(model);
        while (state.KeepRunning()) benchmark::DoNotOptimize(bounds.of(pose));
        per_item(state, "joint", static_cast<double>(model.joints().size()));
    });
    add(name + "/skin by dual quaternions", [&model](auto& state) {
        Pose pose(model);
        if (!model.clips().empty()) (void)sample(pose, &model.clips().front(), model.clips().front().end);
        std::vector<glm::vec3> positions(model.vertex_count()), normals(model.vertex_count());
        while (state.KeepRunning()) {
            (void)skin(
                pose, {.method = SkinningMethod::dual_quaternion, .out = {.positions = positions, .normals = normals}});
            benchmark::ClobberMemory();
        }
        per_item(state, "vertex", static_cast<double>(model.vertex_count()));
    });
}

void add_file(const char* path, std::vector<std::unique_ptr<File>>& files) {
    auto model = Model::open(path);
    if (!model) {
        std::fprintf(stderr, "bendy_bench: %s: %s\n", path, describe(model.error()).c_str());
        std::exit(1);
    }
    files.push_back(std::make_unique<File>(path, *std::move(model)));
    const std::string name = std::filesystem::path(path).stem().string();
    for (const stages::Stage& stage : files.back()->steps.list()) {
        add(name + '/' + stage.name, [&stage](auto& state) {
            while (state.KeepRunning()) stage.run();
            per_item(state, stage.item, stage.items);
        });
    }
    add_bounds_and_duals(name, files.back()->model);
    add_crowds(name, files.back()->model);
}

// --- meshes of any size

/// Makes the mesh when it is first measured and keeps only the current one, because meshes are large.
void measure_mesh(benchmark::State& state, std::uint32_t vertices, int attributes) {
    static std::unique_ptr<const bench::MadeModel> made;
    if (!made || made->model.vertex_count() != vertices) made = bench::make_mesh(vertices);
    Pose pose(made->model);
    std::vector<glm::vec3> positions(vertices), normals(attributes > 1 ? vertices : 0);
    std::vector<glm::vec4> tangents(attributes > 2 ? vertices : 0);
    while (state.KeepRunning()) {
        (void)skin(pose, {.out = {positions, normals, tangents}});
        benchmark::ClobberMemory();
    }
    per_item(state, "vertex", vertices);
}

void add_meshes() {
    constexpr std::array kNames{"positions", "positions, normals", "positions, normals, tangents"};
    for (const std::uint32_t vertices : {1'000u, 10'000u, 100'000u, 1'000'000u}) {
        for (int attributes = 1; attributes <= 3; ++attributes) {
            add("mesh of " + std::to_string(vertices) + "/skin " + kNames.at(static_cast<std::size_t>(attributes) - 1),
                [vertices, attributes](auto& state) { measure_mesh(state, vertices, attributes); });
        }
    }
}

// --- chains

void measure_chain(benchmark::State& state, Solver solver, bool is_limited) {
    const auto made = bench::make_chain(solver, is_limited);
    Pose pose(made->model);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    std::vector<glm::vec3> targets;
    targets.reserve(256);
    for (int k = 0; k < 256; ++k)
        targets.emplace_back(0.2f * number(random), 0.7f + 0.15f * number(random), 0.35f + 0.2f * number(random));
    std::size_t k = 0;
    while (state.KeepRunning()) benchmark::DoNotOptimize(reach(pose, made->model.chains().data(), targets[k++ % 256]));
    per_item(state, "solve", 1.0);
}

void add_chains() {
    add("reach/two-bone", [](auto& state) { measure_chain(state, Solver::two_bone, false); });
    add("reach/two-bone, a hinge's limits", [](auto& state) { measure_chain(state, Solver::two_bone, true); });
    add("reach/aim", [](auto& state) { measure_chain(state, Solver::aim, false); });
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    std::vector<std::unique_ptr<File>> files;
    for (int k = 1; k < argc; ++k) add_file(argv[k], files);
    add_meshes();
    add_chains();
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
