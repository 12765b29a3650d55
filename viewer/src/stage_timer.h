#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace bendy::viewer {

enum class Stage : std::uint8_t { pose, upload_and_draw, graphics, panels };
inline constexpr std::size_t kStages = 4;
inline constexpr std::array<const char*, kStages> kStageNames{"pose (sample, limits, IK)", "give to OpenGL",
                                                              "OpenGL draws", "panels"};

/// How long each stage of a frame takes, by the monotonic clock; a running mean, so that it can be read.
class StageTimer {
public:
    /// Times the stage until the object goes.
    class Running {
    public:
        Running(StageTimer& timer, Stage stage) : timer_(timer), stage_(stage) {}
        Running(const Running&) = delete;
        Running& operator=(const Running&) = delete;
        Running(Running&&) = delete;
        Running& operator=(Running&&) = delete;
        ~Running() { timer_.add(stage_, std::chrono::steady_clock::now() - start_); }

    private:
        StageTimer& timer_;
        Stage stage_;
        std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    };

    [[nodiscard]] Running run(Stage stage) { return {*this, stage}; }
    [[nodiscard]] double milliseconds(std::size_t stage) const { return means_.at(stage); }

private:
    void add(Stage stage, std::chrono::steady_clock::duration taken) {
        constexpr double kShare = 0.1;  // of the newest in the mean
        double& mean = means_.at(static_cast<std::size_t>(stage));
        const double now = std::chrono::duration<double, std::milli>(taken).count();
        mean = mean == 0.0 ? now : mean + kShare * (now - mean);
    }

    std::array<double, kStages> means_{};
};

}  // namespace bendy::viewer
