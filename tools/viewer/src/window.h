#pragma once

#include "camera.h"
#include "character.h"
#include "frame.h"

#include <bendy/viewer/view.h>

#include <glm/vec2.hpp>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>

struct GLFWwindow;

namespace bendy::viewer {

enum class Stage : std::uint8_t { pose, upload_and_draw, graphics, panels };
inline constexpr std::size_t kStages = 4;
inline constexpr std::array<const char*, kStages> kStageNames{"pose (sample, limits, IK)", "give to OpenGL",
                                                              "OpenGL draws", "panels"};

/// Measures each stage of a frame with the monotonic clock. A running mean keeps the numbers readable.
class StageTimer {
public:
    /// Measures the stage until it is destroyed.
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
        constexpr double kShare = 0.1;  // of the newest measurement in the mean
        double& mean = means_.at(static_cast<std::size_t>(stage));
        const double now = std::chrono::duration<double, std::milli>(taken).count();
        mean = mean == 0.0 ? now : mean + kShare * (now - mean);
    }

    std::array<double, kStages> means_{};
};

/// The window with its panels; see view.h. A script has one command per line: `key NAME` (or `key Shift+NAME`), `hold
/// NAME SECONDS`, `wait SECONDS`, `drag X Y X Y` (pixels, left button), `drop FILE`, `picture OUT.png`. After each
/// command the state is printed as a JSON object. Only the script advances the time.
class Window {
public:
    explicit Window(const ViewOptions& options);
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    Window(Window&&) = delete;
    Window& operator=(Window&&) = delete;
    ~Window();

    void run();

    // Called for GLFW's events.
    void on_key(int key, bool is_down);
    void on_button(int button, bool is_down);
    void on_move(const glm::vec2& place);
    void on_scroll(float amount);
    void on_drop(const std::filesystem::path& file);

private:
    enum class Drag : std::uint8_t { none, orbit, pan, target };

    void open_gl();
    void show(const std::filesystem::path& file);
    void fit_camera();
    void step(double seconds);
    void draw();
    void draw_scene();
    void draw_panels();
    void draw_player_panel();
    void draw_chain_panel();
    void draw_view_panel();
    void draw_chunk_panel();
    void draw_time_panel();
    void draw_help();
    void draw_demo_help();
    void play_script();
    void run_command(const std::string& line);
    void save_picture();
    void print_state();
    [[nodiscard]] DrawOptions draw_options() const;
    [[nodiscard]] glm::vec2 to_pixels(const glm::vec3& point) const;
    [[nodiscard]] glm::vec2 to_place(const glm::vec2& pixels) const;
    [[nodiscard]] bool is_demo() const { return character_->demo != nullptr; }
    void toggle_chains();
    void press_in_demo(int key);
    void show_demo_the_view();

    const ViewOptions& options_;
    GLFWwindow* window_ = nullptr;
    bool has_panels_ = false;
    glm::ivec2 size_{1, 1};  // pixels
    std::unique_ptr<Frame> frame_;
    std::unique_ptr<Character> character_;
    Camera camera_;
    DrawOptions draw_;
    StageTimer timer_;
    std::string message_;            // the error of the last dropped file
    std::filesystem::path picture_;  // where the script saves the next frame
    std::set<int> held_;
    Drag drag_ = Drag::none;
    std::size_t dragged_ = 0;
    glm::vec2 mouse_{0.0f};
    double turned_ = 0.0;  // by the demo's turntable so far
    float level_ = 1.0f;
    bool turntable_ = false;
    bool help_ = true;
    bool quits_ = false;
};

}  // namespace bendy::viewer
