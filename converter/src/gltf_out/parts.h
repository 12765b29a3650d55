#pragma once

#include "gltf/further_members.h"
#include "gltf_out/buffer.h"
#include "json_text.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/extensions/renumber_extensions.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

// The parts of an export, in the order in which export_gltf calls them.

namespace bendy::converter::gltf_out {

// What Scene::more and its like say, back in glTF's objects.

/// The JSON object of `more`; an empty one, which is said, if it is none.
Json read_members(const std::string& more, const std::string& place, Report& report);

/// Adds the further members of an object: those that the specification does not define and extras, also deeper inside
/// it. What is there already stays; a texture that is not used any more, or an interpreted extension, is not made.
void add_members(Json& object, const Json& more, gltf::Element element, const std::string& place, Report& report);

/// The author's own JSON as a member of `object`; what is no JSON is named in the report.
void add_extras(Json& object, const std::string& extras, const std::string& place, Report& report);
/// Extensions that were kept, with the numbers that glTF's arrays have. \param host  what `object` is
void add_extensions(Json& object, const std::string& extensions, extensions::Host host,
                    const extensions::NewNumber& numbers, const std::string& place, Report& report);

/// One node for each joint, of the same number, with its rest transform.
Json export_nodes(const Scene& scene, const extensions::NewNumber& numbers, Report& report);

/// The roots, in order.
Json root_nodes(const Scene& scene);

/// Puts accessors in place of the numbers that gltf::inline_instances has left in the nodes' EXT_mesh_gpu_instancing;
/// an extension without such numbers is left out, which is said.
void export_instances(Json& nodes, Buffer& buffer, Report& report);

// What is equal is written once in glTF, unless something moves one of the two: these append what moves it in a clip.

void append_motion(const Curve& curve, std::size_t clip, std::string& motion);
void append_motion(const Track& track, std::size_t clip, std::string& motion);
void append_motion(const Play& play, std::size_t clip, std::string& motion);

struct ExportedMeshes {
    Json meshes = Json::array();
    Json skins = Json::array();
    std::vector<std::uint32_t> node_of_mesh;  ///< the node that draws a mesh of the scene; kNone: left out
};

/// Writes the scene's meshes, each on the node of the joint that carries it; those of one joint that go together become
/// primitives of one glTF mesh. What cannot share a node gets one of its own below, which is appended to `nodes`; its
/// number is added to `roots` where no joint carries it.
/// \param node_members  by joint, Joint::more: `skin` in it is what is said of the skin
ExportedMeshes export_meshes(const Scene& scene, std::span<const Json> node_members, Json& nodes, Json& roots,
                             Buffer& buffer, Report& report);

struct ExportedAnimations {
    Json animations = Json::array();
    std::vector<std::uint32_t> animation_of_clip;  ///< kNone: left out
};

/// Writes the scene's clips, each as an animation, but for their curves: one that has nothing else has no channels
/// yet. \param node_of_mesh  see ExportedMeshes
ExportedAnimations export_animations(const Scene& scene, std::span<const std::uint32_t> node_of_mesh, Buffer& buffer,
                                     Report& report);

/// glTF's word for it.
const char* interpolation_name(Interpolation interpolation);

/// Seconds by which an animation is later than its clip: glTF's do not begin before 0 s.
float shift_of(const Clip& clip);

/// Key times, later by `shift`, as an accessor.
std::uint32_t add_times(const std::vector<float>& times, float shift, Buffer& buffer);

/// Writes materials, textures, samplers and images, all with the scene's numbers, into the document `root`.
void export_materials(const Scene& scene, const extensions::NewNumber& numbers, Json& root, Buffer& buffer,
                      Report& report);

}  // namespace bendy::converter::gltf_out
