// A crowd on all cores: members of one model, each at a time of its own, posed and skinned by TBB's threads.
//
//     bendy convert mannequin.glb && crowd mannequin.bendy [MEMBERS] [FRAMES]
//
// The runtime starts no threads. TBB splits the members into ranges; a range is played by whichever thread takes it, in
// the Pose that the crowd keeps for that thread.
#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    const char* file = argc > 1 ? argv[1] : "mannequin.bendy";
    const std::size_t count = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 200;
    const int frames = argc > 3 ? std::atoi(argv[3]) : 20;
    const auto model = bendy::Model::open(file);
    if (!model) {
        std::fprintf(stderr, "%s: %s\n", file, bendy::describe(model.error()).c_str());
        return 1;
    }

    const std::size_t numbers = model->vertex_count() * 6;  // a position and a normal for each vertex
    std::vector<float> vertices(count * numbers);
    std::vector<bendy::CrowdMember> members(count);
    const auto clips = model->clips();
    const auto length = [](const bendy::Clip& clip) { return std::max(clip.end - clip.start, 1e-3f); };
    for (std::size_t k = 0; k < count; ++k) {
        const std::span<float> own = std::span(vertices).subspan(k * numbers, numbers);
        if (!clips.empty()) members[k].clip = &clips[k % clips.size()];
        members[k].out = {{own, 6}, {own.subspan(std::min<std::size_t>(3, numbers)), 6}, {}};
    }

    const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    bendy::Crowd crowd(*model, threads);
    std::atomic<bool> is_good{true};
    const auto begin = std::chrono::steady_clock::now();
    for (int frame = 0; frame < frames; ++frame) {
        for (std::size_t k = 0; k < count; ++k) {
            bendy::CrowdMember& member = members[k];
            const float seconds = static_cast<float>(frame) / 60.0f + 0.37f * static_cast<float>(k);
            if (member.clip != nullptr) member.seconds = member.clip->start + std::fmod(seconds, length(*member.clip));
        }
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, bendy::Crowd::kAtOnce), [&](const auto& range) {
            const auto worker = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
            if (!crowd.play(std::span(members).subspan(range.begin(), range.size()), worker)) is_good = false;
        });
    }
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
    std::printf("%zu characters, %d frames, %zu threads: %.1f characters per millisecond\n", count, frames, threads,
                static_cast<double>(count) * frames / taken.count());

    // The result of several threads equals that of one.
    const std::vector<float> by_all = vertices;
    bendy::Crowd alone(*model);
    const bool is_same = alone.play(members) && by_all == vertices;
    std::puts(is_same ? "the same vertices from one thread" : "other vertices from one thread");
    return is_good && is_same ? 0 : 1;
}
