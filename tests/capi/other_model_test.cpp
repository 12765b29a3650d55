// Every call of the C API that takes the number of a part refuses numbers that the model does not have, and every call
// that takes two handles refuses those of different models.
#include "capi/open_handles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <string>
#include <utility>

namespace bendy::test::other_model_test {
namespace {

/// A model, and one of everything that is made from it.
struct Handles {
    explicit Handles(Bytes file) : model(open_copy(file)) {
        bendy_crossfade_play(fade.get(), 0, nullptr, 0.0f, BENDY_EASING_LINEAR, nullptr);
    }

    ModelHandle model;
    PoseHandle pose = new_pose(model);
    PoseHandle scratch = new_pose(model);
    LodHandle lod{bendy_lod_new(model.get(), nullptr)};
    BoundsHandle bounds{bendy_bounds_new(model.get(), nullptr)};
    RootPathHandle path{bendy_root_path_new(model.get(), 0, nullptr, nullptr)};
    BindingHandle binding{bendy_binding_new(model.get(), model.get(), nullptr, nullptr)};
    CrowdHandle crowd{bendy_crowd_new(model.get(), 1, nullptr)};
    CrossfadeHandle fade{bendy_crossfade_new(model.get(), nullptr)};
    PlaybackHandle clock{bendy_playback_new(model.get(), 0, nullptr)};
};

/// The status of a call that returns something else.
template <class Value>
bendy_status refused(const Value& is, const Value& expected, const bendy_error& error) {
    EXPECT_EQ(is, expected);
    return static_cast<bendy_status>(error.status);
}

class COtherModel : public testing::Test {
protected:
    struct Call {
        const char* name;
        std::function<bendy_status(bendy_error*)> run;
    };

    static void expect_refused(std::initializer_list<Call> calls) {
        for (const Call& call : calls) {
            SCOPED_TRACE(call.name);
            bendy_error error = BENDY_ERROR_INIT;
            EXPECT_EQ(call.run(&error), BENDY_BAD_ARGUMENT);
            EXPECT_EQ(error.status, BENDY_BAD_ARGUMENT);
        }
    }

    const Handles mine_{sample_file()};
    const Handles other_{walker_file()};
    std::array<float, 400> numbers_{};
    std::array<double, 16> doubles_{0, 0, 0, 1};
    std::array<std::uint32_t, 100> integers_{};
    std::array<bendy_transform, 8> transforms_{};
    std::size_t count_ = 0;
    std::uint64_t long_count_ = 0;
    bendy_played played_ = sized<bendy_played>();
};

TEST_F(COtherModel, NumbersThatItDoesNotHaveAreRefused) {
    const bendy_model* const m = mine_.model.get();
    bendy_pose* const p = mine_.pose.get();
    float* const f = numbers_.data();
    double* const d = doubles_.data();
    std::uint32_t* const u = integers_.data();
    const std::size_t room = 100;
    f[3] = 1.0f;  // a rotation
    for (const std::uint32_t n : {100u, 0x7fff'ffffu, 0x8000'0000u, 0xffff'fffeu, BENDY_NONE}) {
        SCOPED_TRACE(n);
        const auto fills = [&](auto get, auto out) {
            return [=](bendy_error* e) mutable { return get(m, n, &out, e); };
        };
        const auto fills_in = [&](auto get, auto out, std::uint32_t owner, std::uint32_t number) {
            return [=](bendy_error* e) mutable { return get(m, owner, number, &out, e); };
        };
        bendy_socket socket = BENDY_SOCKET_INIT;
        socket.joint = n == BENDY_NONE ? 100 : n;  // none is the model's own space
        bendy_skin_options options = BENDY_SKIN_OPTIONS_INIT;
        options.mesh = n == BENDY_NONE ? 100 : n;  // none is all of them
        bendy_binding_options binding = BENDY_BINDING_OPTIONS_INIT;
        binding.root = n == BENDY_NONE ? 100 : n;
        bendy_crowd_member member = BENDY_CROWD_MEMBER_INIT;
        member.clip = n == BENDY_NONE ? 100 : n;  // none is the rest pose
        bendy_vertices out = BENDY_VERTICES_INIT;
        out.capacity = room;
        out.positions = f;
        expect_refused({
            {"get_joint", fills(bendy_get_joint, sized<bendy_joint>())},
            {"get_clip", fills(bendy_get_clip, sized<bendy_clip>())},
            {"get_chain", fills(bendy_get_chain, sized<bendy_chain>())},
            {"get_morph_target", fills(bendy_get_morph_target, sized<bendy_morph_target>())},
            {"get_mesh", fills(bendy_get_mesh, sized<bendy_mesh>())},
            {"get_submesh", fills(bendy_get_submesh, sized<bendy_submesh>())},
            {"get_material", fills(bendy_get_material, sized<bendy_material>())},
            {"get_texture", fills(bendy_get_texture, sized<bendy_texture>())},
            {"get_joint_submesh", fills(bendy_get_joint_submesh, sized<bendy_joint_submesh>())},
            {"get_constraint", fills(bendy_get_constraint, sized<bendy_constraint>())},
            {"get_image", fills_in(bendy_get_image, sized<bendy_image>(), n, 0)},
            {"get_image 0", fills_in(bendy_get_image, sized<bendy_image>(), 0, n)},
            {"get_stream", fills_in(bendy_get_stream, sized<bendy_stream>(), n, 0)},
            {"get_stream 0", fills_in(bendy_get_stream, sized<bendy_stream>(), 0, n)},
            {"get_track", fills_in(bendy_get_track, sized<bendy_track>(), n, 0)},
            {"get_track 0", fills_in(bendy_get_track, sized<bendy_track>(), 0, n)},
            {"get_marker", fills_in(bendy_get_marker, sized<bendy_marker>(), n, 0)},
            {"get_marker 0", fills_in(bendy_get_marker, sized<bendy_marker>(), 0, n)},
            {"get_curve", fills_in(bendy_get_curve, sized<bendy_curve>(), n, 0)},
            {"get_curve 0", fills_in(bendy_get_curve, sized<bendy_curve>(), 0, n)},
            {"get_frame_sequence", fills_in(bendy_get_frame_sequence, sized<bendy_frame_sequence>(), n, 0)},
            {"get_frame_sequence 0", fills_in(bendy_get_frame_sequence, sized<bendy_frame_sequence>(), 0, n)},
            {"get_indices", [&](auto* e) { return bendy_get_indices(m, n, u, room, e); }},
            {"get_texture_coords", [&](auto* e) { return bendy_get_texture_coords(m, n, 0, f, room, e); }},
            {"get_influences", [&](auto* e) { return bendy_get_influences(m, n, u, f, room, e); }},
            {"get_bind_palette", [&](auto* e) { return bendy_get_bind_palette(m, n, u, nullptr, room, e); }},
            {"get_movers", [&](auto* e) { return bendy_get_movers(m, n, u, room, e); }},
            {"find_stream", [&](auto* e) { return refused(bendy_find_stream(m, n, 0, 0, e), BENDY_NONE, *e); }},
            {"get_numbers", [&](auto* e) { return bendy_get_numbers(m, 0, n, f, room, e); }},
            {"get_integers", [&](auto* e) { return bendy_get_integers(m, 0, n, u, room, e); }},
            {"get_displacements",
             [&](auto* e) { return bendy_get_displacements(m, n, u, nullptr, nullptr, nullptr, room, e); }},
            {"apply_morph_targets",
             [&](auto* e) { return bendy_apply_morph_targets(m, n, nullptr, f, nullptr, nullptr, 1, e); }},
            {"to_constraint_space", [&](auto* e) { return bendy_to_constraint_space(m, n, f, d, e); }},
            {"from_constraint_space", [&](auto* e) { return bendy_from_constraint_space(m, n, d, f, e); }},
            {"clamp_rotation", [&](auto* e) { return bendy_clamp_rotation(m, n, d, d, nullptr, e); }},
            {"clamp_translation", [&](auto* e) { return bendy_clamp_translation(m, n, f, f, e); }},
            {"get_links", [&](auto* e) { return bendy_get_links(m, n, u, f, room, e); }},
            {"sample_track", [&](auto* e) { return bendy_sample_track(m, 0, n, 0.0f, f, room, e); }},
            {"packed_frame_times", [&](auto* e) { return bendy_packed_frame_times(m, n, f, room, e); }},
            {"sample_curve", [&](auto* e) { return bendy_sample_curve(m, 0, n, 0.0, f, room, e); }},
            {"get_curve_values", [&](auto* e) { return bendy_get_curve_values(m, 0, n, f, room, e); }},
            {"find_curve", [&](auto* e) { return refused(bendy_find_curve(m, n, "", e), BENDY_NONE, *e); }},
            {"find_curve_of", [&](auto* e) { return refused(bendy_find_curve_of(m, n, 0, 0, "", e), BENDY_NONE, *e); }},
            {"sample", [&](auto* e) { return bendy_sample(p, n, 0.0f, e); }},
            {"mask_below", [&](auto* e) { return bendy_mask_below(m, n, 1, 0, f, room, e); }},
            {"get_local", [&](auto* e) { return bendy_get_local(p, n, 1, transforms_.data(), e); }},
            {"set_local", [&](auto* e) { return bendy_set_local(p, n, 1, transforms_.data(), e); }},
            {"get_weights", [&](auto* e) { return bendy_get_weights(p, n, 1, f, e); }},
            {"set_weights", [&](auto* e) { return bendy_set_weights(p, n, 1, f, e); }},
            {"reach", [&](auto* e) { return bendy_reach(p, n, f, nullptr, nullptr, nullptr, e); }},
            {"joint_matrices", [&](auto* e) { return bendy_joint_matrices(p, n, 1, nullptr, f, e); }},
            {"bone_matrices", [&](auto* e) { return bendy_bone_matrices(p, n, f, 6, e); }},
            {"skin", [&](auto* e) { return bendy_skin(p, &options, &out, e); }},
            {"socket_matrix", [&](auto* e) { return bendy_socket_matrix(p, &socket, nullptr, f, e); }},
            {"playback_new",
             [&](auto* e) { return refused(bendy_playback_new(m, n, e), static_cast<bendy_playback*>(nullptr), *e); }},
            {"count_markers", [&](auto* e) { return bendy_count_markers(m, n, &played_, &long_count_, e); }},
            {"collect_markers", [&](auto* e) { return bendy_collect_markers(m, n, &played_, u, room, &count_, e); }},
            {"crossfade_play", [&](auto* e) { return bendy_crossfade_play(mine_.fade.get(), n, nullptr, 0.0f, 0, e); }},
            {"get_playing",
             [&](auto* e) {
                 auto playing = sized<bendy_playing>();
                 return bendy_get_playing(mine_.fade.get(), n, &playing, e);
             }},
            {"get_played", [&](auto* e) { return bendy_get_played(mine_.fade.get(), n, &played_, e); }},
            {"crossfade_get_playback",
             [&](auto* e) { return bendy_crossfade_get_playback(mine_.fade.get(), n, mine_.clock.get(), e); }},
            {"root_path_new",
             [&](auto* e) {
                 return refused(bendy_root_path_new(m, n, nullptr, e), static_cast<bendy_root_path*>(nullptr), *e);
             }},
            {"root_path_at",
             [&](auto* e) {
                 bendy_root_motion motion{};
                 return bendy_root_path_at(mine_.path.get(), n, 0.0, &motion, e);
             }},
            {"bounds_of_joint",
             [&](auto* e) {
                 bendy_box box{};
                 return bendy_bounds_of_joint(mine_.bounds.get(), nullptr, n, &box, e);
             }},
            {"binding_new",
             [&](auto* e) {
                 return refused(bendy_binding_new(m, m, &binding, e), static_cast<bendy_binding*>(nullptr), *e);
             }},
            {"sample_bound", [&](auto* e) { return bendy_sample_bound(p, mine_.binding.get(), n, 0.0f, e); }},
            {"lod_indices",
             [&](auto* e) {
                 return refused(bendy_lod_indices(mine_.lod.get(), n, &count_, e),
                                static_cast<const std::uint32_t*>(nullptr), *e);
             }},
            {"lod_submesh",
             [&](auto* e) {
                 auto submesh = sized<bendy_submesh>();
                 return bendy_lod_submesh(mine_.lod.get(), n, &submesh, e);
             }},
            {"crowd_play", [&](auto* e) { return bendy_crowd_play(mine_.crowd.get(), &member, 1, 0, e); }},
            {"crowd_play worker", [&](auto* e) { return bendy_crowd_play(mine_.crowd.get(), &member, 0, n, e); }},
        });
        EXPECT_EQ(bendy_stream_count(m, n) + bendy_track_count(m, n) + bendy_marker_count(m, n) +
                      bendy_curve_count(m, n) + bendy_frame_sequence_count(m, n) + bendy_packed_frame_count(m, n) +
                      bendy_lod_vertices(mine_.lod.get(), n) + bendy_crowd_first_matrix(mine_.crowd.get(), n),
                  0u);
        EXPECT_EQ(bendy_joint_constraint(m, n), BENDY_NONE);
        EXPECT_EQ(bendy_joint_ik_constraint(m, n), BENDY_NONE);
    }
}

TEST_F(COtherModel, HandlesOfAnotherAreRefused) {
    bendy_pose* const p = mine_.pose.get();
    bendy_pose* const q = other_.pose.get();
    bendy_skin_options options = BENDY_SKIN_OPTIONS_INIT;
    options.lod = other_.lod.get();
    bendy_vertices out = BENDY_VERTICES_INIT;
    out.capacity = 100;
    out.positions = numbers_.data();
    bendy_crowd_member member = BENDY_CROWD_MEMBER_INIT;
    member.lod = other_.lod.get();
    bendy_box box{};
    bendy_root_motion motion{};
    expect_refused({
        {"blend", [&](auto* e) { return bendy_blend(p, q, 1.0f, nullptr, e); }},
        {"make_additive", [&](auto* e) { return bendy_make_additive(p, q, e); }},
        {"add", [&](auto* e) { return bendy_add(p, q, 1.0f, nullptr, e); }},
        {"skin", [&](auto* e) { return bendy_skin(p, &options, &out, e); }},
        {"crowd_play", [&](auto* e) { return bendy_crowd_play(mine_.crowd.get(), &member, 1, 0, e); }},
        {"sample_bound", [&](auto* e) { return bendy_sample_bound(p, other_.binding.get(), 0, 0.0f, e); }},
        {"sample_crossfade",
         [&](auto* e) { return bendy_sample_crossfade(p, other_.fade.get(), mine_.scratch.get(), e); }},
        {"sample_crossfade scratch",
         [&](auto* e) { return bendy_sample_crossfade(p, mine_.fade.get(), other_.scratch.get(), e); }},
        {"bounds_of_pose", [&](auto* e) { return bendy_bounds_of_pose(mine_.bounds.get(), q, &box, e); }},
        {"bounds_of_joint", [&](auto* e) { return bendy_bounds_of_joint(mine_.bounds.get(), q, 0, &box, e); }},
        {"root_path_extract", [&](auto* e) { return bendy_root_path_extract(mine_.path.get(), q, &motion, e); }},
    });
    EXPECT_EQ(std::count(numbers_.begin(), numbers_.end(), 0.0f), 400) << "nothing is written";
}

}  // namespace
}  // namespace bendy::test::other_model_test
