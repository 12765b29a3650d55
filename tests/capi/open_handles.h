#pragma once

#include <bendy.h>

#include "runtime/build_model.h"
#include "runtime/clip_model.h"

#include <gtest/gtest.h>

#include <memory>

// The C API's handles, freed by themselves, and what an error says.
namespace bendy::test {

struct FreeHandle {
    void operator()(bendy_model* model) const { bendy_close(model); }
    void operator()(bendy_pose* pose) const { bendy_pose_free(pose); }
    void operator()(bendy_body_reach* body) const { bendy_body_reach_free(body); }
    void operator()(bendy_reach_state* state) const { bendy_reach_state_free(state); }
    void operator()(bendy_lod* lod) const { bendy_lod_free(lod); }
    void operator()(bendy_playback* playback) const { bendy_playback_free(playback); }
    void operator()(bendy_fade* fade) const { bendy_fade_free(fade); }
    void operator()(bendy_crossfade* crossfade) const { bendy_crossfade_free(crossfade); }
    void operator()(bendy_root_path* path) const { bendy_root_path_free(path); }
    void operator()(bendy_bounds* bounds) const { bendy_bounds_free(bounds); }
    void operator()(bendy_binding* binding) const { bendy_binding_free(binding); }
    void operator()(bendy_retarget* retarget) const { bendy_retarget_free(retarget); }
    void operator()(bendy_retarget_state* state) const { bendy_retarget_state_free(state); }
    void operator()(bendy_crowd* crowd) const { bendy_crowd_free(crowd); }
};
using ModelHandle = std::unique_ptr<bendy_model, FreeHandle>;
using PoseHandle = std::unique_ptr<bendy_pose, FreeHandle>;
using BodyReachHandle = std::unique_ptr<bendy_body_reach, FreeHandle>;
using ReachStateHandle = std::unique_ptr<bendy_reach_state, FreeHandle>;
using LodHandle = std::unique_ptr<bendy_lod, FreeHandle>;
using PlaybackHandle = std::unique_ptr<bendy_playback, FreeHandle>;
using FadeHandle = std::unique_ptr<bendy_fade, FreeHandle>;
using CrossfadeHandle = std::unique_ptr<bendy_crossfade, FreeHandle>;
using RootPathHandle = std::unique_ptr<bendy_root_path, FreeHandle>;
using BoundsHandle = std::unique_ptr<bendy_bounds, FreeHandle>;
using BindingHandle = std::unique_ptr<bendy_binding, FreeHandle>;
using RetargetHandle = std::unique_ptr<bendy_retarget, FreeHandle>;
using RetargetStateHandle = std::unique_ptr<bendy_retarget_state, FreeHandle>;
using CrowdHandle = std::unique_ptr<bendy_crowd, FreeHandle>;

inline ModelHandle open_copy(Bytes file) {
    bendy_error error = BENDY_ERROR_INIT;
    ModelHandle model(bendy_open_copy(file.data(), file.size(), nullptr, &error));
    EXPECT_NE(model, nullptr) << error.message;
    return model;
}

inline PoseHandle new_pose(const ModelHandle& model) {
    return PoseHandle(bendy_pose_new(model.get(), nullptr));
}

/// A struct that a call fills.
template <class S>
S sized() {
    S out{};
    out.size = sizeof out;
    return out;
}

/// One mesh on a joint that is moved by (1, 2, 3), and a joint below it, moved by (0, 1, 0).
inline Buffer two_joint_file() {
    ModelSpec spec;
    JointSpec root;
    root.rest = moved(1, 2, 3);
    root.name = "root";
    root.submeshes = {submesh(0, 0, 3)};
    JointSpec tip;
    tip.parent = 0;
    tip.rest = moved(0, 1, 0);
    tip.name = "tip";
    spec.joints = {root, tip};
    MeshSpec mesh;
    mesh.joint = 0;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    mesh.indices = {0, 1, 2};
    spec.meshes = {mesh};
    return build_file(spec);
}

/// The same with two clips: "walk", a loop of 1 s that moves the root by 2 m along X and turns it by a right angle
/// about Y, with the markers "left" at 0.25 s and "right" at 0.75 s; and "wave", 2 s, that moves the tip by 1 m along
/// Z.
inline Buffer walker_file() {
    ModelSpec spec;
    JointSpec root;
    root.rest = moved(1, 2, 3);
    root.name = "root";
    root.submeshes = {submesh(0, 0, 3)};
    JointSpec tip;
    tip.parent = 0;
    tip.rest = moved(0, 1, 0);
    tip.name = "tip";
    spec.joints = {root, tip};
    MeshSpec mesh;
    mesh.joint = 0;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2};
    spec.meshes = {mesh};
    const float half = std::sqrt(0.5f);
    Node walk = clip_node({"walk",
                           0.0f,
                           1.0f,
                           true,
                           {{TrackPath::translation, 0, 3, {0.0f, 1.0f}, {1, 2, 3, 3, 2, 3}},
                            {TrackPath::rotation, 0, 4, {0.0f, 1.0f}, {0, 0, 0, 1, 0, half, 0, half}}}});
    walk.children.push_back(make_leaf(FourCC("MARK"), markers_payload({{0.25f, 4}, {0.75f, 9}}, "leftright")));
    const Node wave =
        clip_node({"wave", 0.0f, 2.0f, false, {{TrackPath::translation, 1, 3, {0.0f, 2.0f}, {0, 1, 0, 0, 1, 1}}}});
    spec.more = {walk, wave};
    return build_file(spec);
}

/// The positions of all vertices of a pose.
inline std::vector<float> skinned(bendy_pose* pose, const bendy_model* model) {
    std::vector<float> positions(bendy_vertex_count(model) * 3);
    bendy_vertices out = BENDY_VERTICES_INIT;
    out.capacity = positions.size() / 3;
    out.positions = positions.data();
    EXPECT_EQ(bendy_skin(pose, nullptr, &out, nullptr), BENDY_OK);
    return positions;
}

}  // namespace bendy::test
