#pragma once

#include "formats/gltf/further_members.h"
#include "formats/gltf_out/buffer.h"
#include "scene/json_text.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/extensions/renumber_extensions.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

// The stages of an export, in the order in which export_gltf calls them.

namespace bendy::converter::gltf_out {

// Restores the members of Scene::more and its like in glTF's objects.

/// Parses `more`; an empty object, after a warning, if it is not a JSON object.
Json read_members(const std::string& more, const std::string& place, Report& report);

/// Adds the further members of an object: extras, and members that the specification does not define, also nested ones.
/// Existing members stay; a texture that has become unused, or an interpreted extension, is not created. Members that
/// only glTF 2.1 has are left out.
void add_members(Json& object, const Json& more, gltf::Element element, const std::string& place, Report& report);

/// Removes the members that only glTF 2.1 has, with warnings.
void leave_out_drafts(Json& members, gltf::Element element, const std::string& place, Report& report);

/// Adds the author's JSON as a member of `object`; text that is not JSON is reported.
void add_extras(Json& object, const std::string& extras, const std::string& place, Report& report);
/// Adds extensions that were kept, with glTF's numbers.
/// \param host  the kind of `object`
void add_extensions(Json& object, const std::string& extensions, extensions::Host host,
                    const extensions::NewNumber& numbers, const std::string& place, Report& report);

/// One node per joint, with the same number, and its rest transform.
Json export_nodes(const Scene& scene, const extensions::NewNumber& numbers, Report& report);

/// The root nodes, in order.
Json root_nodes(const Scene& scene);

/// Replaces the numbers that gltf::inline_instances has left in the nodes' EXT_mesh_gpu_instancing with accessors; an
/// extension without such numbers is left out with a warning.
void export_instances(Json& nodes, Buffer& buffer, Report& report);

// Equal things are written once in glTF, unless a clip animates one of them. These append a clip's animation to the
// comparison key.

void append_motion(const Curve& curve, std::size_t clip, std::string& motion);
void append_motion(const Track& track, std::size_t clip, std::string& motion);
void append_motion(const Play& play, std::size_t clip, std::string& motion);

struct ExportedMeshes {
    Json meshes = Json::array();
    Json skins = Json::array();
    std::vector<std::uint32_t> node_of_mesh;  ///< by mesh of the scene: the node that draws it; kNone: left out
};

/// Writes the scene's meshes, each on the node of the joint that carries it; compatible meshes of one joint become
/// primitives of one glTF mesh. Meshes that cannot share a node get their own child node, which is appended to `nodes`,
/// and to `roots` if no joint carries it.
/// \param node_members  by joint, Joint::more: its `skin` holds the skin's members
ExportedMeshes export_meshes(const Scene& scene, std::span<const Json> node_members, Json& nodes, Json& roots,
                             Buffer& buffer, Report& report);

struct ExportedAnimations {
    Json animations = Json::array();
    std::vector<std::uint32_t> animation_of_clip;  ///< kNone: left out
};

/// Writes each clip as an animation, without curves: an animation of curves only has no channels yet.
/// \param node_of_mesh  see ExportedMeshes
ExportedAnimations export_animations(const Scene& scene, std::span<const std::uint32_t> node_of_mesh, Buffer& buffer,
                                     Report& report);

/// glTF's name of an interpolation.
const char* interpolation_name(Interpolation interpolation);

/// Seconds by which an animation is later than its clip: glTF's animations do not start before 0 s.
float shift_of(const Clip& clip);

/// Adds key times, delayed by `shift`, as an accessor.
std::uint32_t add_times(const std::vector<float>& times, float shift, Buffer& buffer);

/// Adds the joints' constraints as BENDY_joint_limits of their nodes in the document `root`, and the chains as its
/// BENDY_ik_chains (spec/gltf.md). Floats read back bit for bit.
void export_rig(const Scene& scene, Json& root, Report& report);

/// Writes materials, textures, samplers and images to the document `root`, with the scene's numbers.
void export_materials(const Scene& scene, const extensions::NewNumber& numbers, Json& root, Buffer& buffer,
                      Report& report);

}  // namespace bendy::converter::gltf_out
