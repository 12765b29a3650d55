// bench_scale: what each joint and each vertex costs, from few to very many, on made-up characters. The least of some
// runs, in nanoseconds per joint or vertex.
#include <bendy/runtime.h>

#include "made_models.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

namespace {

using bendy::Bytes;
using bendy::bench::make_character;

/// Nanoseconds per item, the least of runs that take half a second together.
template <class Run>
double least(double items, const Run& run) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::milliseconds(500);
    double best = std::numeric_limits<double>::max();
    do {
        const auto start = Clock::now();
        run();
        best = std::min(best, std::chrono::duration<double, std::nano>(Clock::now() - start).count());
    } while (Clock::now() < end);
    return best / items;
}

bendy::Result<bendy::Model> open(Bytes bytes, bendy::Sums sums) {
    bendy::OpenOptions options;
    options.sums = sums;
    return bendy::Model::from_memory(bytes, options);
}

bool measure_joints(std::uint32_t joints) {
    const std::vector<std::byte> bytes = make_character(joints, 0);
    const auto model = open(bytes, bendy::Sums::checked);
    if (!model) return false;
    const bendy::Cycle& cycle = model->cycles().front();
    bendy::Pose pose(*model);
    float seconds = 0.0f;
    const auto next = [&](float step) {
        seconds += step;
        if (seconds > cycle.end) seconds -= cycle.end;
        (void)bendy::sample(pose, &cycle, seconds);
    };
    const double n = joints;
    const double checked = least(n, [&] { return open(bytes, bendy::Sums::checked).has_value(); });
    const double later = least(n, [&] { return open(bytes, bendy::Sums::later).has_value(); });
    const double in_order = least(n, [&] { next(1.0f / 60.0f); });
    const double at_random = least(n, [&] { next(0.61803399f); });
    const double to_model = least(n, [&] {
        (void)pose.change_local();
        (void)pose.model_space();
    });
    std::printf("| %u | %.0f | %.0f | %.1f | %.1f | %.1f |\n", joints, checked, later, in_order, at_random, to_model);
    std::fflush(stdout);
    return true;
}

bool measure_vertices(std::uint32_t vertices) {
    constexpr std::uint32_t kJoints = 100;
    const std::vector<std::byte> bytes = make_character(kJoints, vertices);
    const auto model = open(bytes, bendy::Sums::checked);
    if (!model) return false;
    const double n = vertices;
    const double checked = least(n, [&] { return open(bytes, bendy::Sums::checked).has_value(); });
    const double later = least(n, [&] { return open(bytes, bendy::Sums::later).has_value(); });
    const double first_pose = least(n, [&] {
        const auto fresh = open(bytes, bendy::Sums::later);
        const bendy::Pose pose(*fresh);
    });
    bendy::Pose pose(*model);
    (void)bendy::sample(pose, &model->cycles().front(), 0.5f);
    std::vector<glm::vec3> positions(vertices);
    std::vector<glm::vec3> normals(vertices);
    const double skin_positions = least(n, [&] { (void)bendy::skin(pose, {.out = {.positions = positions}}); });
    const double skin_normals =
        least(n, [&] { (void)bendy::skin(pose, {.out = {.positions = positions, .normals = normals}}); });
    std::printf("| %u | %.2f | %.2f | %.1f | %.2f | %.2f |\n", vertices, checked, later, first_pose - later,
                skin_positions, skin_normals);
    std::fflush(stdout);
    return true;
}

}  // namespace

int main() {
    bool is_good = true;
    std::printf(
        "| joints | open | sums later | next frame | random time | local to model |\n|---|---|---|---|---|---|\n");
    for (const std::uint32_t joints : {10u, 100u, 1'000u, 10'000u}) is_good = is_good && measure_joints(joints);
    std::printf("\n| vertices | open | sums later | first pose | positions | + normals |\n|---|---|---|---|---|---|\n");
    for (const std::uint32_t vertices : {1'000u, 10'000u, 100'000u, 1'000'000u, 10'000'000u})
        is_good = is_good && measure_vertices(vertices);
    return is_good ? 0 : 1;
}
