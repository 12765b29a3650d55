#pragma once

#include "document.h"

#include <bendy/converter/import.h>
#include <bendy/converter/scene.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// The parts of an import, in the order in which import_gltf calls them.

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
/// on loops of nodes, wherever in the file.
Skeleton import_skeleton(const Document& document, const GltfOptions& options, Scene& scene);

// EXT_mesh_gpu_instancing: a node that draws its mesh several times.

/// Where each instance of a node stands, relative to the node; the extension's own attributes (`_ID`) are named in a
/// warning. Empty: the node has no such extension, or nothing to draw. Fails on a faulty one; how many there may be is
/// held against the source's bytes.
std::vector<Transform> read_instances(const Document& document, std::size_t node);

/// Puts the numbers of its attributes in place of their accessors: {"type": "VEC3", "values": [...]}, and for whole
/// numbers "integers": true. Fails on a faulty one.
void inline_instances(const Document& document, Json& extension, const std::string& place);

/// The meshes that a node became, by node: none, one, or one per layout of streams among its primitives.
using MeshesOfNode = std::vector<std::vector<std::uint32_t>>;

/// Fills Scene::meshes from the drawn nodes with a mesh. Primitives with the same layout become parts of one mesh;
/// those that name the very same accessors share their vertices. A mesh that several nodes use is made once for each.
MeshesOfNode import_meshes(const Document& document, const Skeleton& skeleton, Scene& scene);

/// Fills Scene::materials and Scene::textures, in the file's order. Material extensions without a field stay as JSON.
void import_materials(const Document& document, Scene& scene);

/// Fills Scene::images, in the file's order: encoded bytes as they came, or the URI of a file that is not embedded or
/// not there.
void import_images(const Document& document, bool embed, Scene& scene);

/// Fills Scene::clips: one for each animation of the file, in its order, even if nothing in it moves the scene. Keys
/// stay as they are, but for rotations that are no unit quaternions.
void import_animations(const Document& document, const Skeleton& skeleton, const MeshesOfNode& meshes, Scene& scene);

/// Keeps the extensions of the root and of the nodes that became joints, as JSON, in Scene::extensions and
/// Joint::extensions. Numbers whose meaning is known (bendy/extensions/references.def) become those of the Scene; an
/// entry whose thing is not there is left out, with a warning. Textures are added for images that only an extension
/// names. What is only kept is named in the report.
void keep_extensions(const Document& document, const Skeleton& skeleton, const MeshesOfNode& meshes, Scene& scene);

/// Fills `more` of the scene's joints, materials, textures and clips, and of its root: what the file says of them that
/// no field holds, and the names and extras of skins, cameras, samplers and images with those that use them.
void keep_members(const Document& document, const Skeleton& skeleton, Scene& scene);

/// Names in warnings what of the file is not in the scene: what nothing uses, and members of storage and motion.
void report_left_out(const Document& document, const Skeleton& skeleton);

}  // namespace bendy::converter::gltf
