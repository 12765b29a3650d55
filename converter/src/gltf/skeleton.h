#pragma once

#include "document.h"

#include <bendy/converter/import_gltf.h>
#include <bendy/converter/scene.h>

#include <cstdint>
#include <vector>

namespace bendy::converter::gltf {

/// Which nodes became joints.
struct Skeleton {
    std::vector<std::uint32_t> joint_of_node;  ///< by node; kNone: left out
    std::vector<std::uint32_t> node_of_joint;  ///< by joint
    std::vector<bool> is_drawn;  ///< by joint: in the scene, not only there to carry or to be a skin's joint
    /// By joint: which instance of its node it is (EXT_mesh_gpu_instancing); kNone: the node itself.
    std::vector<std::uint32_t> instance_of_joint;
    std::vector<bool>
        has_instances;  ///< by node: its instances are joints of their own, and draw the mesh in its place
};

/// Makes a joint of every node of the chosen scene (see GltfOptions::scene), of the ancestors of its roots, and of the
/// joints of skins that its meshes use, with their ancestors; and, if asked for, of every instance of a mesh, which is
/// the node's child; pre-order. Sets the scene's name, extras and further members. Fails on a node with two parents and
/// on cycles, wherever in the file.
Skeleton import_skeleton(const Document& document, const GltfOptions& options, Scene& scene);

}  // namespace bendy::converter::gltf
