#pragma once

#include <bendy.h>

#include "runtime/build_model.h"

#include <gtest/gtest.h>

#include <memory>

// The C API's handles, freed by themselves, and what an error says.
namespace bendy::test {

struct FreeHandle {
    void operator()(bendy_model* model) const { bendy_close(model); }
    void operator()(bendy_pose* pose) const { bendy_pose_free(pose); }
    void operator()(bendy_lod* lod) const { bendy_lod_free(lod); }
};
using ModelHandle = std::unique_ptr<bendy_model, FreeHandle>;
using PoseHandle = std::unique_ptr<bendy_pose, FreeHandle>;
using LodHandle = std::unique_ptr<bendy_lod, FreeHandle>;

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

}  // namespace bendy::test
