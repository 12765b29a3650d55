// Plays a character's clips as a game does: one fades into the next, footsteps are heard, root motion moves the
// character, something hangs in a hand, and a character outside the view is not skinned.
//
//     bendy convert mannequin.glb && play mannequin.bendy [ROOT JOINT] [SOCKET JOINT]
#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>

#include <array>
#include <cstdio>
#include <string>
#include <vector>

int main(int argc, char** argv) {
    const char* file = argc > 1 ? argv[1] : "mannequin.bendy";
    const auto model = bendy::Model::open(file);
    if (!model) {
        std::fprintf(stderr, "%s: %s\n", file, bendy::describe(model.error()).c_str());
        return 1;
    }
    if (model->clips().empty()) {
        std::fprintf(stderr, "%s: no clips\n", file);
        return 1;
    }
    const char* const root_name = argc > 2 ? argv[2] : "mixamorig:Hips";
    const char* const hand_name = argc > 3 ? argv[3] : "mixamorig:RightHand";
    const bendy::RootPath root(*model, model->joint(root_name));
    const bendy::Socket hand = bendy::make_socket(*model, hand_name);
    for (const char* const name : {root_name, hand_name}) {
        if (model->joint(name) == bendy::kNone)
            std::fprintf(stderr, "%s: no joint %s: it stays where it is\n", file, name);
    }
    const bendy::Bounds bounds(*model);
    bendy::Pose pose(*model);
    bendy::Pose scratch(*model);
    std::vector<glm::vec3> positions(model->vertex_count());

    bendy::Crossfade fade;
    bendy::RootMotion character;  // where it stands in the world
    std::size_t steps = 0;
    std::size_t outside = 0;
    constexpr int kFrames = 240;
    for (int frame = 0; frame < kFrames; ++frame) {
        if (frame % 80 == 0) {  // the next clip, over a third of a second
            const bendy::Clip& next = model->clips()[static_cast<std::size_t>(frame) / 80 % model->clips().size()];
            fade.play(next, bendy::Playback(next.start, next.end, bendy::LoopMode::repeat), 1.0f / 3.0f);
        }
        fade.advance(1.0 / 60.0);

        bendy::RootMotion moved;  // of all clips that play, by their shares
        float share = 0.0f;
        for (const bendy::Playing& playing : fade.playing()) {
            share += playing.share;
            const auto step = root.over(*playing.clip, playing.played);
            if (!step) return 1;
            if (share > 0.0f) moved = blend(moved, *step, playing.share / share);
            // A foot is set down at a quarter and at three quarters of each clip.
            const float length = playing.clip->end - playing.clip->start;
            const std::array<bendy::Marker, 2> feet{
                {{playing.clip->start + 0.25f * length, "left"}, {playing.clip->start + 0.75f * length, "right"}}};
            bendy::visit_markers(feet, playing.played, [&](const bendy::Marker&) { steps += playing.share > 0.5f; });
        }
        character = compose(character, moved);

        if (!bendy::sample(pose, fade, scratch) || !root.extract(pose)) return 1;
        const auto box = bounds.of(pose);  // in model space: test it against the camera before skinning
        if (!box || !bendy::skin(pose, {.out = {.positions = positions}})) return 1;
        for (const glm::vec3& position : positions) outside += box->contains(position) ? 0 : 1;
        if (frame % 20 != 0) continue;
        const auto sword = bendy::socket_matrix(pose, hand, glm::mat4(character.matrix()));
        if (!sword) return 1;
        const glm::vec4 place = (*sword)[3];
        std::printf("%5.2f s  %-12.12s %3.0f %%  at (%6.3f, %6.3f)  hand at (%6.3f, %6.3f, %6.3f)  %zu steps\n",
                    frame / 60.0, std::string(fade.playing().back().clip->name).c_str(),
                    100.0 * fade.playing().back().share, character.translation.x, character.translation.z, place.x,
                    place.y, place.z, steps);
    }
    std::printf("%zu vertices were outside their bounds\n", outside);
    return outside == 0 ? 0 : 1;
}
