// What posing costs, in nanoseconds per joint: bendy_bench_pose FILE... Least times of many rounds; every round
// measures every step once, so that what else runs on the machine disturbs all of them alike. BENDY_KERNEL chooses the
// kernel.
#include <bendy/runtime.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <vector>

using namespace bendy;

namespace {

struct Step {
    std::string name;
    std::function<void()> run;
    double least = std::numeric_limits<double>::infinity();  // nanoseconds per joint
};

/// What the steps of a character change.
struct Character {
    explicit Character(const Model& of) : model(of), pose(of), a(of), b(of), difference(of) {
        const std::span<const Clip> clips = model.clips();
        (void)sample(a, &clips.front(), clips.front().start);
        (void)sample(b, &clips.back(), 0.5f * (clips.back().start + clips.back().end));
        pose = a;
        difference = b;
        (void)make_additive(difference, a);
    }

    void touch() { pose.set_local(0, pose.local(0)); }
    /// The next frame of every clip, or a time anywhere.
    void sample_clips(bool is_random) {
        for (const Clip& clip : model.clips()) {
            random = random * 1664525u + 1013904223u;
            const float length = clip.end - clip.start;
            share += is_random ? static_cast<float>(random >> 8) / 16777216.0f
                               : 1.0f / (60.0f * std::max(length, 1e-3f) * static_cast<float>(model.clips().size()));
            share -= static_cast<float>(static_cast<int>(share));
            (void)sample(pose, &clip, clip.start + share * length);
        }
    }

    const Model& model;
    Pose pose, a, b, difference;
    float share = 0.0f, sign = 0.5f;
    std::uint32_t random = 12345;
};

std::vector<Step> steps_of(Character& of) {
    return {{"sample, next frame", [&] { of.sample_clips(false); }},
            {"sample, random time", [&] { of.sample_clips(true); }},
            {"blend", [&] { (void)blend(of.pose, of.b, 0.5f); }},
            {"add", [&] { (void)add(of.pose, of.difference, of.sign = -of.sign); }},
            {"local to model",
             [&] {
                 of.touch();
                 (void)of.pose.model_space();
             }},
            {"local to model, palettes",
             [&] {
                 of.touch();
                 (void)of.pose.model_space();
                 for (std::uint32_t mesh = 0; mesh < of.model.meshes().size(); ++mesh) (void)of.pose.palette(mesh);
             }},
            {"palettes alone", [&] {
                 of.touch();
                 for (std::uint32_t mesh = 0; mesh < of.model.meshes().size(); ++mesh) (void)of.pose.palette(mesh);
             }}};
}

void measure(Step& step, double joints) {
    using Clock = std::chrono::steady_clock;
    constexpr int kTurns = 64;
    const auto start = Clock::now();
    for (int k = 0; k < kTurns; ++k) step.run();
    const double nanoseconds = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
    step.least = std::min(step.least, nanoseconds / (kTurns * joints));
}

}  // namespace

int main(int argc, char** argv) {
    constexpr int kRounds = 2000;
    for (int k = 1; k < argc; ++k) {
        const auto model = Model::open(argv[k]);
        if (!model || model->clips().empty() || model->joints().empty()) {
            std::fprintf(stderr, "bendy_bench_pose: %s: no character with a clip\n", argv[k]);
            return 1;
        }
        Character character(*model);
        std::vector<Step> steps = steps_of(character);
        const auto joints = static_cast<double>(model->joints().size());
        for (int round = 0; round < kRounds; ++round) {
            character.pose = character.a;
            for (std::size_t step = 0; step < steps.size(); ++step)
                measure(steps[step], step < 2 ? joints * static_cast<double>(model->clips().size()) : joints);
        }
        std::printf("%s, %zu joints, %s\n", argv[k], model->joints().size(),
                    std::string(kernel_name(kernel())).c_str());
        for (const Step& step : steps) std::printf("  %-26s %6.2f\n", step.name.c_str(), step.least);
    }
    return 0;
}
