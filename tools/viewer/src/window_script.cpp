// The window's test interface: it reads commands and prints the state as JSON.
#include "window.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>

namespace bendy::viewer {
namespace {

/// Returns GLFW's number of a key, which is a letter or one of the names below.
int key_named(const std::string& name) {
    struct Named {
        const char* name;
        int key;
    };
    constexpr std::array<Named, 10> kNamed{{{"Esc", GLFW_KEY_ESCAPE},
                                            {"Left", GLFW_KEY_LEFT},
                                            {"Right", GLFW_KEY_RIGHT},
                                            {"Up", GLFW_KEY_UP},
                                            {"Down", GLFW_KEY_DOWN},
                                            {"PgUp", GLFW_KEY_PAGE_UP},
                                            {"PgDn", GLFW_KEY_PAGE_DOWN},
                                            {"Space", GLFW_KEY_SPACE},
                                            {"Tab", GLFW_KEY_TAB},
                                            {"Home", GLFW_KEY_HOME}}};
    if (name.size() == 1 && name[0] >= 'A' && name[0] <= 'Z') return GLFW_KEY_A + (name[0] - 'A');
    const auto found = std::find_if(kNamed.begin(), kNamed.end(), [&](const Named& each) { return name == each.name; });
    if (found == kNamed.end()) throw ViewerError("script: unknown key " + name);
    return found->key;
}

std::string json_text(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        const bool is_plain = static_cast<unsigned char>(c) >= 0x20 && c != '"' && c != '\\';
        out += is_plain ? c : '?';
    }
    return out + '"';
}

class JsonLine {
public:
    void add(const char* name, bool value) { add_text(name, value ? "true" : "false"); }
    void add(const char* name, double value) {
        std::ostringstream number;
        number.precision(9);
        number << value;
        add_text(name, number.str());
    }
    void add(const char* name, const glm::vec3& v) {
        std::ostringstream numbers;
        numbers.precision(9);
        numbers << '[' << v.x << ", " << v.y << ", " << v.z << ']';
        add_text(name, numbers.str());
    }
    void add_text(const char* name, const std::string& value) {
        text_ += (text_.empty() ? "{\"" : ", \"") + std::string(name) + "\": " + value;
    }
    [[nodiscard]] std::string text() const { return text_ + '}'; }

private:
    std::string text_;
};

}  // namespace

void Window::print_state() {
    JsonLine line;
    line.add("demo", is_demo());
    line.add_text("title", json_text(character_->title));
    const DrawOptions shown = draw_options();
    line.add("bones", shown.bones);
    line.add("wireframe", shown.wireframe);
    line.add("constraints", shown.constraints);
    line.add("axes", shown.axes);
    line.add("yaw", static_cast<double>(camera_.yaw()));
    line.add("pitch", static_cast<double>(camera_.pitch()));
    line.add("distance", static_cast<double>(camera_.distance()));
    if (is_demo()) {
        const Demo& demo = *character_->demo;
        const DemoState& state = demo.state();
        line.add("forward", state.forward);
        line.add("inverse", state.inverse);
        line.add("paused", state.paused);
        line.add("turntable", state.turntable);
        line.add("help", state.help);
        line.add("quits", state.quits);
        line.add("time", state.time);
        line.add("violation", demo.violation());
        line.add_text("joint",
                      json_text(state.joint == kNone ? std::string()
                                                     : std::string(character_->model->joints()[state.joint].name)));
        std::string links;
        for (const std::uint32_t joint : demo.links()) {
            JsonLine link;
            link.add("position", glm::vec3(character_->pose().model_space()[joint][3]));
            link.add("pixels", glm::vec3(to_pixels(glm::vec3(character_->pose().model_space()[joint][3])), 0.0f));
            links += (links.empty() ? "" : ", ") + link.text();
        }
        line.add_text("links", '[' + links + ']');
    } else {
        line.add("help", help_);
        line.add("quits", quits_);
        line.add("turntable", turntable_);
        line.add("paused", !character_->player->is_playing);
        line.add("phase", static_cast<double>(character_->player->phase));
    }
    std::string targets;
    for (const TargetMark& mark : character_->targets()) {
        JsonLine target;
        target.add("on", mark.is_active);
        target.add("position", mark.position);
        target.add("tip", mark.tip.value_or(glm::vec3(0.0f)));
        target.add("tip_pixels", glm::vec3(to_pixels(mark.tip.value_or(glm::vec3(0.0f))), 0.0f));
        target.add("pixels", glm::vec3(to_pixels(mark.position), 0.0f));
        targets += (targets.empty() ? "" : ", ") + target.text();
    }
    line.add_text("targets", '[' + targets + ']');
    line.add_text("message", json_text(message_));
    std::cout << line.text() << std::endl;  // NOLINT(performance-avoid-endl): a reader waits for it
}

void Window::play_script() {
    std::ifstream file(options_.script);
    if (!file) throw ViewerError("the script " + options_.script.string() + " cannot be read");
    draw();
    std::string line;
    while (!quits_ && std::getline(file, line)) {
        glfwPollEvents();
        if (line.empty() || line[0] == '#') continue;
        run_command(line);
        step(0.0);
        draw();
        print_state();
    }
}

void Window::save_picture() {
    const auto written = write_file(picture_, encode_png(frame_->read_window()));
    if (!written) throw ViewerError(picture_.string() + ": " + describe(written.error()));
    picture_.clear();
}

void Window::run_command(const std::string& line) {
    std::istringstream words(line);
    std::string command;
    std::string name;
    words >> command;
    constexpr double kFrame = 1.0 / 60.0;
    const auto wait = [&](double seconds) {
        const auto frames = static_cast<int>(std::ceil(std::clamp(seconds, 0.0, 1e4) / kFrame));
        for (int k = 0; k < frames; ++k) step(std::min(kFrame, seconds - k * kFrame));
    };
    if (command == "key") {
        words >> name;
        constexpr std::string_view kShift = "Shift+";
        const bool has_shift = name.starts_with(kShift);
        if (has_shift) name.erase(0, kShift.size());
        if (has_shift) on_key(GLFW_KEY_LEFT_SHIFT, true);
        on_key(key_named(name), true);
        on_key(key_named(name), false);
        if (has_shift) on_key(GLFW_KEY_LEFT_SHIFT, false);
    } else if (command == "hold") {
        double seconds = 0.0;
        words >> name >> seconds;
        on_key(key_named(name), true);
        wait(seconds);
        on_key(key_named(name), false);
    } else if (command == "wait") {
        double seconds = 0.0;
        words >> seconds;
        wait(seconds);
    } else if (command == "drag") {
        glm::vec2 from(0.0f);
        glm::vec2 to(0.0f);
        words >> from.x >> from.y >> to.x >> to.y;
        on_move(from);
        on_button(GLFW_MOUSE_BUTTON_LEFT, true);
        on_move(to);
        on_button(GLFW_MOUSE_BUTTON_LEFT, false);
    } else if (command == "drop") {
        std::getline(words >> std::ws, name);
        on_drop(name);
    } else if (command == "picture") {
        std::getline(words >> std::ws, name);
        picture_ = name;  // saved by the draw that follows every command
    } else {
        throw ViewerError("script: unknown command " + command);
    }
}

}  // namespace bendy::viewer
