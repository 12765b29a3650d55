#include <bendy/runtime.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

// bendy_bench_retarget FILE...: how long a frame takes if the clips of each file are put on each file, of four kinds of
// retargeting. All files need roles (spec/chunks/ROLE.md). run.py judges what comes out.
namespace {

using namespace bendy;

constexpr double kRate = 60.0;    // frames a second
constexpr int kMostFrames = 600;  // of a clip

/// Opens files; leaves out, with a line on stderr, those whose clips cannot be retargeted.
/// \return nothing, after a line on stderr, if a file cannot be opened
std::optional<std::vector<Model>> open_bodies(std::span<const char* const> paths) {
    std::vector<Model> bodies;
    for (const char* path : paths) {
        const auto model = Model::open(path);
        if (!model) {
            std::fprintf(stderr, "%s: cannot be opened\n", path);
            return std::nullopt;
        }
        if (const auto own = Retarget::make(*model, *model); !own) {
            std::fprintf(stderr, "%s: %s\n", path, error_text(own.error()).c_str());
            continue;
        }
        bodies.push_back(*model);
    }
    return bodies;
}

struct Mean {
    double total = 0.0;
    std::size_t count = 0;
};

/// Returns the least time of several calls with the same state, microseconds.
double time_frame(Pose& target, Retarget& retargeting, Pose& source, RetargetState& state) {
    const RetargetState before = state;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 4; ++k) {
        state = before;
        const auto begin = std::chrono::steady_clock::now();
        (void)retarget(target, retargeting, source, state);
        const auto end = std::chrono::steady_clock::now();
        least = std::min(least, std::chrono::duration<double, std::micro>(end - begin).count());
    }
    return least;
}

void time_clips(const Model& from, const Model& to, const RetargetOptions& options, Mean& mean) {
    auto retargeting = Retarget::make(from, to, options);
    if (!retargeting) return;
    Pose source(from), target(to);
    for (const Clip& clip : from.clips()) {
        RetargetState state;
        const int frames = std::clamp(static_cast<int>((clip.end - clip.start) * kRate), 1, kMostFrames);
        for (int frame = 0; frame < frames; ++frame) {
            if (!sample(source, &clip, clip.start + static_cast<float>(frame / kRate))) continue;
            (void)source.model_space();
            mean.total += time_frame(target, *retargeting, source, state);
            ++mean.count;
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const auto bodies = open_bodies(std::span(argv, static_cast<std::size_t>(argc)).subspan(1));
    if (!bodies) return 1;
    const std::pair<const char*, RetargetOptions> kinds[] = {
        {"directions", {RestPoses::measured, Limits::off, false}},
        {"limits", {RestPoses::measured, Limits::hard, false}},
        {"feet", {RestPoses::measured, Limits::off, true}},
        {"limits and feet", {RestPoses::measured, Limits::hard, true}}};
    for (const auto& [name, options] : kinds) {
        Mean mean;
        for (const Model& from : *bodies) {
            for (const Model& to : *bodies) {
                if (&from != &to) time_clips(from, to, options, mean);
            }
        }
        std::printf("%-16s %7.2f us a frame, %zu frames\n", name, mean.total / static_cast<double>(mean.count),
                    mean.count);
    }
    return 0;
}
