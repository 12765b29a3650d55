// bendy_bench_clips FILE... [--benchmark_...]: the cost of decoding packed clips, in nanoseconds per joint of the
// skeleton, including the copy of the rest pose; at times in order, at random times, and at random times in so many
// copies that none is in the cache.
#include "optimise/compact/pack_clips.h"
#include "plan/layout.h"
#include "plan/unpack_plan.h"
#include "play/unpack.h"

#include <bendy/converter/import.h>
#include <bendy/runtime/kernels.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

using namespace bendy;

namespace {

struct Clip {
    std::string name;
    std::vector<JointTransform> rest;
    std::vector<std::byte> payload;
};

enum class Order { next_frame, random, cold };

PackedView view_of(Bytes payload, std::size_t joints) {
    Faults faults;
    return *read_packed(payload, static_cast<std::uint32_t>(joints), 0, faults);
}

void decode(benchmark::State& state, const Clip& clip, Kernel kernel, Order order) {
    (void)set_kernel(kernel);
    constexpr std::size_t kCold = 64u << 20;  // bytes
    const std::size_t copies =
        order == Order::cold ? std::clamp<std::size_t>(kCold / clip.payload.size(), 64, 16384) : 1;
    const std::vector<std::vector<std::byte>> payloads(copies, clip.payload);
    std::vector<PackedView> views;
    views.reserve(copies);
    for (const auto& payload : payloads) views.push_back(view_of(payload, clip.rest.size()));
    std::vector<UnpackPlan> plans;
    plans.reserve(copies);
    for (const PackedView& of_copy : views) plans.push_back(make_unpack_plan(of_copy, clip.rest));
    const PackedView& view = views.front();
    const double length = view.time_of(view.record.frames - 1) - view.record.start;
    std::vector<float> times(4096);
    std::uint32_t random = 12345;
    for (std::size_t k = 0; k < times.size(); ++k) {
        random = random * 1664525u + 1013904223u;
        const double share =
            order == Order::next_frame ? static_cast<double>(k % 60) / 60.0 : (random >> 8) / 16777216.0;
        times[k] = static_cast<float>(view.record.start + length * share);
    }
    const std::vector<JointBlock>& start = plans.front().start;
    std::vector<JointBlock> local(start.size());
    std::size_t k = 0;
    while (state.KeepRunning()) {
        std::ranges::copy(start, local.begin());
        unpack(plans[(k * 2654435761u >> 4) % copies], times[k % times.size()], clip.rest.size(), local);
        benchmark::DoNotOptimize(local.data());
        benchmark::ClobberMemory();
        ++k;
    }
    state.counters["s_per_joint"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(clip.rest.size()),
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

std::vector<Clip> clips_of(const char* path) {
    converter::Report report;
    auto scene = converter::import_gltf(path, {}, report);
    std::vector<Clip> clips;
    if (!scene) return clips;
    converter::pack_clips(*scene, std::vector(scene->clips.size(), 1e-4), {.probes = converter::Probes::shell});
    std::vector<JointTransform> rest;
    for (const converter::Joint& joint : scene->joints) {
        const converter::Transform& at = joint.rest;
        rest.push_back(
            {glm::quat(at.rotation.w, at.rotation.x, at.rotation.y, at.rotation.z), at.translation, at.scale});
    }
    for (converter::Clip& clip : scene->clips) {
        if (!clip.packed.empty()) clips.push_back({clip.name, rest, std::move(clip.packed)});
    }
    return clips;
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    for (int a = 1; a < argc; ++a) {
        for (const Clip& clip : clips_of(argv[a])) {
            const auto add = [&](Kernel kernel) {
                constexpr std::pair<const char*, Order> kOrders[] = {
                    {"next", Order::next_frame}, {"random", Order::random}, {"cold", Order::cold}};
                for (const auto& [name, order] : kOrders) {
                    const std::string title = clip.name + '/' + std::string(kernel_name(kernel)) + '/' + name;
#ifndef __clang_analyzer__  // reports a leak, although the library's list frees the benchmarks
                    benchmark::RegisterBenchmark(title.c_str(), [clip, kernel, order = order](benchmark::State& state) {
                        decode(state, clip, kernel, order);
                    });
#endif
                }
            };
            add(Kernel::plain);
            add(kernels().front());
        }
    }
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
