#pragma once

#include "document.h"

#include <bendy/converter/scene.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bendy::converter::gltf {

/// Which nodes became joints.
struct Skeleton {
    std::vector<std::uint32_t> joint_of_node;  ///< by node; kNone: left out
    std::vector<std::uint32_t> node_of_joint;  ///< by joint
    std::vector<bool> is_drawn;  ///< by joint: in the scene, not only there to carry or to be a skin's joint
};

/// Makes a joint of every node of the chosen scene (see GltfOptions::scene), of the ancestors of its roots, and of the
/// joints of skins that its meshes use, with their ancestors; pre-order. Sets the scene's name and extras.
/// Fails on a node with two parents and on cycles, wherever in the file.
Skeleton import_skeleton(const Document& document, const std::optional<std::string>& scene_option, Scene& scene);

}  // namespace bendy::converter::gltf
