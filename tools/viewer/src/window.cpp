#include "window.h"

#include <bendy/format/file.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iostream>
#include <new>

namespace bendy::viewer {
namespace {

Window& owner(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

std::string last_problem() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text == nullptr ? "no reason given" : text;
}

/// Returns the meaning of a key in the demo, if it has one.
std::optional<DemoKey> demo_key(int key) {
    struct Meaning {
        int key;
        DemoKey meaning;
    };
    constexpr std::array<Meaning, 15> kMeanings{{{GLFW_KEY_ESCAPE, DemoKey::quit},
                                                 {GLFW_KEY_B, DemoKey::bones},
                                                 {GLFW_KEY_F, DemoKey::forward},
                                                 {GLFW_KEY_I, DemoKey::inverse},
                                                 {GLFW_KEY_P, DemoKey::pause},
                                                 {GLFW_KEY_R, DemoKey::turntable},
                                                 {GLFW_KEY_T, DemoKey::wireframe},
                                                 {GLFW_KEY_H, DemoKey::help},
                                                 {GLFW_KEY_TAB, DemoKey::next_joint},
                                                 {GLFW_KEY_LEFT, DemoKey::left},
                                                 {GLFW_KEY_RIGHT, DemoKey::right},
                                                 {GLFW_KEY_UP, DemoKey::up},
                                                 {GLFW_KEY_DOWN, DemoKey::down},
                                                 {GLFW_KEY_PAGE_UP, DemoKey::page_up},
                                                 {GLFW_KEY_PAGE_DOWN, DemoKey::page_down}}};
    for (const Meaning& each : kMeanings) {
        if (each.key == key) return each.meaning;
    }
    return std::nullopt;
}

}  // namespace

Window::Window(const ViewOptions& options) : options_(options) {
    if (glfwInit() == GLFW_FALSE) throw ViewerError("no display: " + last_problem() + " (`bendy render` needs none)");
    try {
        open_gl();
        draw_.targets = true;
        if (options.file.empty()) {
            character_ =
                std::make_unique<Character>(std::vector<std::byte>(options.tentacle.begin(), options.tentacle.end()),
                                            "Bendy Tentacle Demo", ReadableFolders(), true, options.warn);
        } else {
            show(options.file);
        }
    } catch (...) {
        if (window_ != nullptr) glfwDestroyWindow(window_);
        glfwTerminate();
        throw;
    }
    fit_camera();
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // writes no settings file
    ImGui::StyleColorsDark();
    ImGui_ImplGlfw_InitForOpenGL(window_, true);  // also calls the callbacks installed before
    ImGui_ImplOpenGL3_Init("#version 330");
    has_panels_ = true;
}

Window::~Window() {
    if (has_panels_) {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    character_.reset();
    frame_.reset();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::open_gl() {
    require_driver_memory();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    window_ = glfwCreateWindow(static_cast<int>(options_.width), static_cast<int>(options_.height), "Bendy", nullptr,
                               nullptr);
    if (window_ == nullptr) throw ViewerError("no window with OpenGL 3.3: " + last_problem());
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(options_.script.empty() ? 1 : 0);
    if (options_.verbose) {
        std::cerr << "bendy: drawing with a window: " << reinterpret_cast<const char*>(glGetString(GL_RENDERER)) << ", "
                  << reinterpret_cast<const char*>(glGetString(GL_VERSION)) << '\n';
    }
    glfwGetFramebufferSize(window_, &size_.x, &size_.y);
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) {
        if (action != GLFW_REPEAT) owner(w).on_key(key, action == GLFW_PRESS);
    });
    glfwSetMouseButtonCallback(
        window_, [](GLFWwindow* w, int button, int action, int) { owner(w).on_button(button, action == GLFW_PRESS); });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
        owner(w).on_move({static_cast<float>(x), static_cast<float>(y)});
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) { owner(w).on_scroll(static_cast<float>(y)); });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** files) {
        if (count > 0) owner(w).on_drop(files[count - 1]);
    });
}

void Window::show(const std::filesystem::path& file) {
    auto character = std::make_unique<Character>(options_.open(file), file.filename().string(),
                                                 ReadableFolders::of(file, options_.root), false, options_.warn);
    character_ = std::move(character);
    level_ = 1.0f;
    draw_.wireframe = turntable_ = false;
    draw_.bones = !has_surface(*character_->model);  // otherwise there is nothing to see
}

void Window::fit_camera() {
    camera_.fit(character_->box, {}, static_cast<float>(size_.x) / static_cast<float>(std::max(size_.y, 1)));
    glfwSetWindowTitle(window_, (character_->title + " - Bendy").c_str());
}

void Window::on_drop(const std::filesystem::path& file) {
    // If the file is invalid, the current one stays.
    try {
        show(file);
        fit_camera();
        message_.clear();
    } catch (const std::exception& problem) {
        message_ = dynamic_cast<const std::bad_alloc*>(&problem) != nullptr ? "not enough memory" : problem.what();
        if (options_.warn) options_.warn(message_);
    }
}

void Window::toggle_chains() {
    auto& chains = character_->player->chains;
    const bool any = std::any_of(chains.begin(), chains.end(), [](const ChainControl& chain) { return chain.is_on; });
    for (ChainControl& chain : chains) chain.is_on = !any;
}

/// Tells the demo the view, because its keys refer to the picture.
void Window::show_demo_the_view() {
    const glm::mat4 axes = glm::transpose(camera_.view());
    character_->demo->look_along(glm::vec3(axes[0]), glm::vec3(axes[1]));
}

void Window::press_in_demo(int key) {
    auto meaning = demo_key(key);
    if (!meaning) return;
    const bool has_shift = held_.contains(GLFW_KEY_LEFT_SHIFT) || held_.contains(GLFW_KEY_RIGHT_SHIFT);
    if (meaning == DemoKey::next_joint && has_shift) meaning = DemoKey::previous_joint;
    show_demo_the_view();
    character_->demo->press(*meaning);
    quits_ = character_->demo->state().quits;
}

void Window::on_key(int key, bool is_down) {
    if (has_panels_ && ImGui::GetIO().WantTextInput) return;
    if (!is_down) {
        held_.erase(key);
        return;
    }
    held_.insert(key);
    if (is_demo()) {
        press_in_demo(key);
    } else {
        Player& player = *character_->player;
        constexpr float kStep = 0.02f;  // of the clip
        switch (key) {
            case GLFW_KEY_ESCAPE:
                quits_ = true;
                break;
            case GLFW_KEY_B:
                draw_.bones = !draw_.bones;
                break;
            case GLFW_KEY_C:
                draw_.constraints = !draw_.constraints;
                break;
            case GLFW_KEY_X:
                draw_.axes = !draw_.axes;
                break;
            case GLFW_KEY_T:
                draw_.wireframe = !draw_.wireframe;
                break;
            case GLFW_KEY_R:
                turntable_ = !turntable_;
                break;
            case GLFW_KEY_H:
                help_ = !help_;
                break;
            case GLFW_KEY_I:
                toggle_chains();
                break;
            case GLFW_KEY_P:
            case GLFW_KEY_SPACE:
                player.is_playing = !player.is_playing;
                break;
            case GLFW_KEY_HOME:
                fit_camera();
                break;
            case GLFW_KEY_LEFT:
            case GLFW_KEY_RIGHT:
                player.phase += key == GLFW_KEY_RIGHT ? kStep : 1.0f - kStep;
                player.phase -= std::floor(player.phase);
                break;
            default:
                break;
        }
    }
    if (key == GLFW_KEY_C && is_demo()) draw_.constraints = !draw_.constraints;
    if (options_.trace) {
        step(0.0);
        print_state();
    }
}

glm::vec2 Window::to_pixels(const glm::vec3& point) const {
    const glm::vec4 clip = camera_.view_projection() * glm::vec4(point, 1.0f);
    return {(0.5f + 0.5f * clip.x / clip.w) * static_cast<float>(size_.x),
            (0.5f - 0.5f * clip.y / clip.w) * static_cast<float>(size_.y)};
}

glm::vec2 Window::to_place(const glm::vec2& pixels) const {
    return {2.0f * pixels.x / static_cast<float>(size_.x) - 1.0f, 1.0f - 2.0f * pixels.y / static_cast<float>(size_.y)};
}

void Window::on_button(int button, bool is_down) {
    if (!is_down) {
        drag_ = Drag::none;
        return;
    }
    if (has_panels_ && ImGui::GetIO().WantCaptureMouse) return;
    drag_ = button == GLFW_MOUSE_BUTTON_LEFT ? Drag::orbit : Drag::pan;
    if (drag_ != Drag::orbit) return;
    constexpr float kNear = 14.0f;  // pixels
    float nearest = kNear;
    const std::vector<TargetMark> targets = character_->targets();
    for (std::size_t k = 0; k < targets.size(); ++k) {
        const float distance = glm::length(to_pixels(targets[k].position) - mouse_);
        if (!(distance < nearest)) continue;
        nearest = distance;
        dragged_ = k;
        drag_ = Drag::target;
    }
}

void Window::on_move(const glm::vec2& place) {
    const glm::vec2 moved = place - mouse_;
    mouse_ = place;
    const auto height = static_cast<float>(std::max(size_.y, 1));
    constexpr float kTurn = 4.0f;  // radians over the window's height
    if (drag_ == Drag::orbit) camera_.orbit(-kTurn * moved.x / height, kTurn * moved.y / height);
    if (drag_ == Drag::pan) camera_.pan({moved.x / height, -moved.y / height});
    if (drag_ == Drag::target)
        character_->move_target(dragged_, camera_.on_plane(to_place(place), character_->targets()[dragged_].position));
}

void Window::on_scroll(float amount) {
    if (has_panels_ && ImGui::GetIO().WantCaptureMouse) return;
    camera_.zoom(std::pow(0.9f, amount));
}

void Window::step(double seconds) {
    const auto running = timer_.run(Stage::pose);
    if (is_demo()) {
        Demo& demo = *character_->demo;
        show_demo_the_view();
        for (const int key : held_) {
            const auto meaning = demo_key(key);
            if (meaning && *meaning >= DemoKey::left) demo.hold(*meaning, seconds);
        }
        demo.step(seconds);
        camera_.orbit(static_cast<float>(demo.state().angle - turned_), 0.0f);
        turned_ = demo.state().angle;
    } else {
        character_->player->step(seconds);
        constexpr double kTurn = 0.8;  // radians a second
        if (turntable_) camera_.orbit(static_cast<float>(kTurn * seconds), 0.0f);
    }
}

DrawOptions Window::draw_options() const {
    DrawOptions options = draw_;
    if (is_demo()) {
        options.bones = character_->demo->state().bones;
        options.wireframe = character_->demo->state().wireframe;
        options.targets = character_->demo->state().inverse;
        if (character_->demo->state().forward) options.marked_joint = character_->demo->state().joint;
    }
    return options;
}

void Window::draw_scene() {
    if (!frame_ || frame_->width() != static_cast<std::uint32_t>(size_.x) ||
        frame_->height() != static_cast<std::uint32_t>(size_.y)) {
        frame_.reset();
        frame_ = std::make_unique<Frame>(size_.x, size_.y);
    }
    camera_.set_aspect(static_cast<float>(size_.x) / static_cast<float>(size_.y));
    {
        const auto running = timer_.run(Stage::upload_and_draw);
        frame_->bind();
        character_->renderer->draw(character_->pose(), camera_, draw_options(), character_->targets(),
                                   glm::vec2(size_));
    }
    const auto running = timer_.run(Stage::graphics);
    frame_->copy_to_window();
    glFinish();
}

void Window::draw() {
    glfwGetFramebufferSize(window_, &size_.x, &size_.y);
    if (size_.x < 1 || size_.y < 1) return;  // minimised
    draw_scene();
    {
        const auto running = timer_.run(Stage::panels);
        glViewport(0, 0, size_.x, size_.y);
        draw_panels();
    }
    if (!picture_.empty()) save_picture();
    glfwSwapBuffers(window_);
}

void Window::run() {
    if (options_.trace) {
        step(0.0);
        print_state();
    }
    if (!options_.script.empty()) {
        play_script();
        return;
    }
    using Clock = std::chrono::steady_clock;
    auto last = Clock::now();
    while (!quits_ && glfwWindowShouldClose(window_) == GLFW_FALSE) {
        glfwPollEvents();
        const auto now = Clock::now();
        constexpr double kLongest = 0.1;  // seconds: after a pause of the program, playback continues where it was
        step(std::min(kLongest, std::chrono::duration<double>(now - last).count()));
        last = now;
        draw();
    }
}

void view(const ViewOptions& options) {
    Window window(options);
    window.run();
}

}  // namespace bendy::viewer
