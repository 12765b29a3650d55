// The window's panels.
#include "window.h"

#include <bendy/format/diagnostics.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <string>
#include <vector>

namespace bendy::viewer {
namespace {

std::string label(std::string_view name, std::size_t number) {
    return std::to_string(number) + "  " + std::string(name);
}

/// Draws a list of clips with `none` at the top. Returns true if the choice has changed.
bool choose_clip(const char* title, const Model& model, std::uint32_t& chosen, const char* none) {
    const auto clips = model.clips();
    const std::string shown = chosen < clips.size() ? label(clips[chosen].name, chosen) : none;
    bool has_changed = false;
    if (!ImGui::BeginCombo(title, shown.c_str())) return false;
    if (ImGui::Selectable(none, chosen == kNone)) {
        chosen = kNone;
        has_changed = true;
    }
    for (std::uint32_t k = 0; k < clips.size(); ++k) {
        if (!ImGui::Selectable(label(clips[k].name, k).c_str(), k == chosen)) continue;
        chosen = k;
        has_changed = true;
    }
    ImGui::EndCombo();
    return has_changed;
}

}  // namespace

void Window::draw_panels() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    const bool shows_help = is_demo() ? character_->demo->state().help : help_;
    if (shows_help) draw_help();
    if (!is_demo()) {
        ImGui::SetNextWindowPos({10.0f, 10.0f}, ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSize({330.0f, 0.0f}, ImGuiCond_FirstUseEver);
        if (ImGui::Begin("Character")) {
            draw_player_panel();
            draw_chain_panel();
            draw_view_panel();
        }
        ImGui::End();
        draw_chunk_panel();
    }
    draw_time_panel();
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::draw_player_panel() {
    Player& player = *character_->player;
    if (!message_.empty()) ImGui::TextWrapped("%s", message_.c_str());
    ImGui::Text("%zu joints, %llu vertices, %llu triangles", character_->model->joints().size(),
                static_cast<unsigned long long>(character_->model->vertex_count()),
                static_cast<unsigned long long>(character_->renderer->level().triangles()));
    choose_clip("clip", *character_->model, player.clip, "rest pose");
    choose_clip("mixed with", *character_->model, player.other, "nothing");
    if (player.other != kNone) ImGui::SliderFloat("share", &player.share, 0.0f, 1.0f);
    if (ImGui::Button(player.is_playing ? "pause" : "play")) player.is_playing = !player.is_playing;
    ImGui::SameLine();
    const auto length = static_cast<float>(player.length());
    float time = player.phase * length;
    if (ImGui::SliderFloat("s", &time, 0.0f, length)) {
        player.is_playing = false;
        player.phase = length > 0.0f ? std::min(time / length, 1.0f) : 0.0f;
    }
    ImGui::SliderFloat("speed", &player.speed, 0.0f, 3.0f);
    ImGui::Checkbox("hold the pose to the limits", &player.obeys_constraints);
}

void Window::draw_chain_panel() {
    Player& player = *character_->player;
    if (player.chains.empty() || !ImGui::CollapsingHeader("IK chains", ImGuiTreeNodeFlags_DefaultOpen)) return;
    for (std::size_t k = 0; k < player.chains.size(); ++k) {
        ImGui::PushID(static_cast<int>(k));
        ImGui::Checkbox(label(character_->model->chains()[k].name, k).c_str(), &player.chains[k].is_on);
        ImGui::PopID();
    }
    ImGui::TextDisabled("drag a red target to pull");
}

void Window::draw_view_panel() {
    if (!ImGui::CollapsingHeader("View", ImGuiTreeNodeFlags_DefaultOpen)) return;
    ImGui::Checkbox("bones", &draw_.bones);
    ImGui::SameLine();
    ImGui::Checkbox("axes", &draw_.axes);
    ImGui::SameLine();
    ImGui::Checkbox("constraints", &draw_.constraints);
    ImGui::Checkbox("wireframe", &draw_.wireframe);
    ImGui::SameLine();
    ImGui::Checkbox("targets", &draw_.targets);
    ImGui::SameLine();
    ImGui::Checkbox("turn", &turntable_);
    if (ImGui::SliderFloat("detail", &level_, 0.0f, 1.0f)) character_->renderer->set_level(level_);
}

void Window::draw_chunk_panel() {
    ImGui::SetNextWindowPos({static_cast<float>(size_.x) - 350.0f, 10.0f}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({340.0f, 460.0f}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowCollapsed(true, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Chunks")) {
        const ChunkTree& tree = character_->tree;
        std::vector<std::uint32_t> ends;  // of the open containers around this chunk
        for (std::uint32_t number = 0; number < tree.chunks().size();) {
            while (!ends.empty() && number >= ends.back()) {
                ImGui::TreePop();
                ends.pop_back();
            }
            const Chunk& chunk = tree[number];
            const bool is_leaf = !chunk.is_container() || chunk.end == number + 1;
            const ImGuiTreeNodeFlags flags =
                (is_leaf ? ImGuiTreeNodeFlags_Leaf | ImGuiTreeNodeFlags_NoTreePushOnOpen : ImGuiTreeNodeFlags_None) |
                (ends.size() < 2 && !is_leaf ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
            std::string name;
            if (const std::uint32_t child = tree.find(number, FourCC("NAME")); child != kNone) {
                const Bytes text = tree.payload(child);
                name.assign(reinterpret_cast<const char*>(text.data()), std::min<std::size_t>(text.size(), 60));
            }
            ImGui::PushID(static_cast<int>(number));
            const bool is_open = ImGui::TreeNodeEx("", flags, "%s  %llu bytes  %s", chunk.id.letters().data(),
                                                   static_cast<unsigned long long>(chunk.size), name.c_str());
            ImGui::PopID();
            if (is_open && !is_leaf) {
                ends.push_back(chunk.end);
                ++number;
            } else {
                number = chunk.end;
            }
        }
        for (; !ends.empty(); ends.pop_back()) ImGui::TreePop();
    }
    ImGui::End();
}

void Window::draw_time_panel() {
    ImGui::SetNextWindowPos({10.0f, static_cast<float>(size_.y) - 120.0f}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowCollapsed(is_demo(), ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Time per stage", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        for (std::size_t stage = 0; stage < kStages; ++stage)
            ImGui::Text("%8.3f ms  %s", timer_.milliseconds(stage), kStageNames.at(stage));
    }
    ImGui::End();
}

void Window::draw_demo_help() {
    const Demo& demo = *character_->demo;
    const DemoState& state = demo.state();
    const auto mark = [](bool is_on) { return is_on ? "on" : "off"; };
    ImGui::TextUnformatted("Bendy Tentacle Demo");
    ImGui::Text("B    bones: %s", mark(state.bones));
    ImGui::Text("C    constraints: %s", mark(draw_.constraints));
    ImGui::Text("F    forward kinematics, by hand: %s", mark(state.forward));
    if (state.joint == kNone) {
        ImGui::TextUnformatted("Tab  bends: the whole tentacle");
    } else {
        const auto& links = demo.links();
        const auto number = std::find(links.begin(), links.end(), state.joint) - links.begin();
        const std::string name(character_->model->joints()[state.joint].name);
        ImGui::Text("Tab  bends: joint %d of %zu, %s", static_cast<int>(number) + 1, links.size(), name.c_str());
    }
    ImGui::Text("I    inverse kinematics: %s", mark(state.inverse));
    ImGui::Text("P    pause the animation: %s", mark(state.paused));
    ImGui::Text("R    turntable: %s", mark(state.turntable));
    ImGui::Text("T    wireframe: %s", mark(state.wireframe));
    ImGui::TextUnformatted(state.inverse   ? "arrows, PgUp, PgDn    move the target"
                           : state.forward ? "arrows bend, PgUp, PgDn twist"
                                           : "arrows, PgUp, PgDn    after F or I");
    ImGui::TextUnformatted("H    this help        Esc  quit");
}

void Window::draw_help() {
    ImGui::SetNextWindowPos({static_cast<float>(size_.x) - 10.0f, static_cast<float>(size_.y) - 10.0f},
                            ImGuiCond_Always, {1.0f, 1.0f});
    constexpr ImGuiWindowFlags kFlags =
        ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs;
    if (ImGui::Begin("help", nullptr, kFlags)) {
        if (is_demo()) {
            draw_demo_help();
        } else {
            ImGui::TextUnformatted(
                "left button: orbit, or drag a target; right: pan; wheel: zoom; Home: fit\n"
                "B bones  C constraints  X axes  T wireframe  R turntable\n"
                "P play or pause  Left, Right: step  I all IK chains on or off\n"
                "drop a .glb or .bendy to open it   H this help   Esc quit");
        }
    }
    ImGui::End();
}

}  // namespace bendy::viewer
