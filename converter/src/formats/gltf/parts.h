#pragma once

#include "document.h"

#include <bendy/converter/import.h>
#include <bendy/converter/scene.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// The stages of an import, in the order in which import_gltf calls them.

namespace bendy::converter::gltf {

/// The mapping between nodes and joints.
struct Skeleton {
    std::vector<std::uint32_t> joint_of_node;  ///< by node; kNone: left out
    std::vector<std::uint32_t> node_of_joint;  ///< by joint
    std::vector<bool> is_drawn;                ///< by joint: in the scene, not only an ancestor or a skin's joint
    /// By joint: the instance of its node (EXT_mesh_gpu_instancing); kNone: the node itself.
    std::vector<std::uint32_t> instance_of_joint;
    std::vector<bool> has_instances;  ///< by node: its instances are joints, and draw the mesh instead of it
};

/// Makes a joint of every node of the chosen scene (see GltfOptions::scene), of the ancestors of its roots, and of the
/// joints of skins that its meshes use, with their ancestors; and, if requested, of every instance of a mesh, as the
/// node's child; in pre-order. Sets the scene's name, extras and further members. Fails on a node with two parents and
/// on cycles of nodes, anywhere in the file.
Skeleton import_skeleton(const Document& document, const GltfOptions& options, Scene& scene);

/// Fills the constraints of joints from BENDY_joint_limits of their nodes, Scene::roles from BENDY_joint_role, and
/// Scene::chains from BENDY_ik_chains (spec/gltf.md). Faulty entries are named in the report and left out.
void import_rig_extensions(const Document& document, const Skeleton& skeleton, Scene& scene);

// EXT_mesh_gpu_instancing: a node that draws its mesh several times.

/// The transform of each instance of a node, relative to the node; a warning names the extension's custom attributes
/// (`_ID`). Empty: the node has no such extension, or nothing to draw. Fails on a faulty extension; the number of
/// instances is checked against the source's size.
std::vector<Transform> read_instances(const Document& document, std::size_t node);

/// Replaces the accessors of its attributes with their values: {"type": "VEC3", "values": [...]}, and for integers
/// "integers": true. Fails on a faulty extension.
void inline_instances(const Document& document, Json& extension, const std::string& place);

/// The meshes made from each node: none, one, or one per vertex layout among its primitives.
using MeshesOfNode = std::vector<std::vector<std::uint32_t>>;

/// Fills Scene::meshes from the drawn nodes with a mesh. Primitives with the same layout become parts of one mesh;
/// those with identical accessors share their vertices. A mesh used by several nodes is duplicated for each.
MeshesOfNode import_meshes(const Document& document, const Skeleton& skeleton, Scene& scene);

/// Fills Scene::materials and Scene::textures, in the file's order. Material extensions without a field are kept as
/// JSON.
void import_materials(const Document& document, Scene& scene);

/// Fills Scene::images, in the file's order: the encoded bytes, or the URI of a file that is not embedded or does not
/// exist.
void import_images(const Document& document, bool embed, Scene& scene);

/// Fills Scene::clips: one for each animation of the file, in its order, even if it moves nothing in the scene. Keys
/// are unchanged, except that rotations are normalised.
void import_animations(const Document& document, const Skeleton& skeleton, const MeshesOfNode& meshes, Scene& scene);

/// Keeps the extensions of the root and of the nodes that became joints, as JSON, in Scene::extensions and
/// Joint::extensions. Numbers with a known meaning (bendy/extensions/references.def) are converted to the Scene's; an
/// entry that refers to something missing is left out, with a warning. Textures are added for images that only an
/// extension uses. The report lists extensions that are kept without being interpreted.
void keep_extensions(const Document& document, const Skeleton& skeleton, const MeshesOfNode& meshes, Scene& scene);

/// Fills `more` of the scene's joints, materials, textures and clips, and of its root: members in the file that have no
/// field, and the names and extras of skins, cameras, samplers and images, stored with their users.
void keep_members(const Document& document, const Skeleton& skeleton, Scene& scene);

/// Warns of parts of the file that are not in the scene: unused elements, and further members of storage and animation
/// objects.
void report_left_out(const Document& document, const Skeleton& skeleton);

}  // namespace bendy::converter::gltf
