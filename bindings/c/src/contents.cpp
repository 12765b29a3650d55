// The contents of a model: counts, names, and a struct for each joint, clip, IK chain, morph target and mesh.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"

#include <bendy/format/names.h>
#include <bendy/format/role.h>

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::capi {
namespace {

/// Returns a message with a suggestion and the names that exist: `...; did you mean "Run"? There are: "Walk", "Run"`.
std::string not_found(std::string_view kind, std::string_view name, const std::vector<std::string>& names) {
    constexpr std::size_t kEnough = 400;  // the length at which a message stops
    std::string text = "there is no " + std::string(kind) + " \"" + std::string(name) + '"';
    if (names.empty()) return text + ", the model has none at all";
    const std::string suggestion = did_you_mean(std::vector<std::string_view>(names.begin(), names.end()), name);
    text += suggestion + (suggestion.empty() ? "; there " : " There ") + (names.size() == 1 ? "is: " : "are: ");
    for (std::size_t k = 0; k < names.size(); ++k) {
        if (text.size() > kEnough) return text + ", ...";
        text += (k == 0 ? "\"" : ", \"") + names[k] + '"';
    }
    return text;
}

bendy_status find(const std::vector<std::string>& names, const char* kind, const char* name, std::uint32_t& found,
                  bendy_error* error) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) return fail(error, BENDY_NOT_FOUND, not_found(kind, name, names));
    found = static_cast<std::uint32_t>(at - names.begin());
    return BENDY_OK;
}

void describe_mesh(const Model& model, std::uint32_t number, bendy_mesh& out) {
    const Mesh& mesh_view = model.meshes()[number];
    out.vertices = mesh_view.vertices;
    out.first_vertex = model.first_vertex(number);
    out.indices = mesh_view.indices ? mesh_view.indices->elements : 0;
    out.joint = mesh_view.joint;
    out.first_morph_target = model.first_morph_target(number);
    out.targets = static_cast<std::uint32_t>(mesh_view.targets.size());
    out.has_normals = mesh_view.normals ? 1 : 0;
    out.has_tangents = mesh_view.tangents ? 1 : 0;
    out.texture_coord_sets = static_cast<std::uint32_t>(mesh_view.texture_coords.size());
    out.bones = mesh_view.is_rigid() ? 0 : static_cast<std::uint32_t>(mesh_view.palette.joints.size());
    out.influences = mesh_view.is_rigid() ? 0 : mesh_view.bones->components;
    const bool has_one = mesh_view.is_rigid() && mesh_view.vertices != 0 && model.has_one_mover(number);
    out.mover = has_one ? model.rigid_mover(number, 0) : BENDY_NONE;
    out.frames = mesh_view.frames();
    out.first_frame = mesh_view.first_frame;
}

}  // namespace

}  // namespace bendy::capi

using namespace bendy::capi;

uint64_t bendy_vertex_count(const bendy_model* model) {
    return model == nullptr ? 0 : model->get().vertex_count();
}

bendy_status bendy::capi::find_joint(const bendy_model* model, const char* name, uint32_t& made, bendy_error* error) {
    return find(model->character->names.joints, "joint", name, made, error);
}
bendy_status bendy::capi::find_clip(const bendy_model* model, const char* name, uint32_t& made, bendy_error* error) {
    return find(model->character->names.clips, "clip", name, made, error);
}
bendy_status bendy::capi::find_chain(const bendy_model* model, const char* name, uint32_t& made, bendy_error* error) {
    return find(model->character->names.chains, "chain", name, made, error);
}
bendy_status bendy::capi::find_morph_target(const bendy_model* model, const char* name, uint32_t& made,
                                            bendy_error* error) {
    return find(model->character->names.targets, "target", name, made, error);
}
bendy_status bendy::capi::find_mesh(const bendy_model* model, const char* name, uint32_t& made, bendy_error* error) {
    return find(model->character->names.meshes, "mesh", name, made, error);
}
bendy_status bendy::capi::find_material(const bendy_model* model, const char* name, uint32_t& made,
                                        bendy_error* error) {
    return find(model->character->names.materials, "material", name, made, error);
}
bendy_status bendy::capi::find_texture(const bendy_model* model, const char* name, uint32_t& made, bendy_error* error) {
    return find(model->character->names.textures, "texture", name, made, error);
}

const uint32_t* bendy_joint_parents(const bendy_model* model) {
    return model == nullptr ? nullptr : first_of(model->get().parents());
}

const char* bendy_model_name(const bendy_model* model) {
    return model == nullptr ? nullptr : model->character->names.model.c_str();
}

const char* bendy_model_extras(const bendy_model* model) {
    return model == nullptr ? nullptr : model->character->names.model_extras.c_str();
}

const char* bendy_file_extras(const bendy_model* model) {
    return model == nullptr ? nullptr : model->character->names.file_extras.c_str();
}

bendy_status bendy::capi::get_joint(const bendy_model* model, uint32_t joint, bendy_joint& out,
                                    bendy_error* /*error*/) {
    const Names& names = model->character->names;
    to_c(model->get().joints()[joint], out);
    out.name = names.joints[joint].c_str();
    out.extras = names.joint_extras[joint].c_str();
    const bendy::RoleRecord* role = bendy::role_of(model->get().roles(), joint);
    if (role == nullptr) return BENDY_OK;
    out.role = role->role;
    out.role_place = role->place;
    return BENDY_OK;
}

bendy_status bendy::capi::get_clip(const bendy_model* model, uint32_t clip, bendy_clip& out, bendy_error* /*error*/) {
    const bendy::Clip& view = model->get().clips()[clip];
    out.name = model->character->names.clips[clip].c_str();
    out.start = view.start;
    out.end = view.end;
    out.frame_rate = view.frame_rate;
    out.loops = view.loop ? 1 : 0;
    out.is_packed = view.packed ? 1 : 0;
    put_json(model->character->names.clip_json[clip], out);
    return BENDY_OK;
}

bendy_status bendy::capi::get_chain(const bendy_model* model, uint32_t chain, bendy_chain& out,
                                    bendy_error* /*error*/) {
    const bendy::Chain& view = model->get().chains()[chain];
    const Names& names = model->character->names;
    to_c(view.record, out);
    out.name = names.chains[chain].c_str();
    out.links = view.links;
    out.extras = names.chain_extras[chain].c_str();
    return BENDY_OK;
}

bendy_status bendy::capi::get_morph_target(const bendy_model* model, uint32_t morph_target, bendy_morph_target& out,
                                           bendy_error* /*error*/) {
    out.name = model->character->names.targets[morph_target].c_str();
    out.mesh = model->character->target_meshes[morph_target];
    const bendy::Mesh& mesh = model->get().meshes()[out.mesh];
    const bendy::MorphTargetView& view = mesh.targets[morph_target - model->get().first_morph_target(out.mesh)];
    out.rest_weight = view.rest_weight;
    out.vertices = view.touched(mesh.vertices);
    out.has_positions = view.positions ? 1 : 0;
    out.has_normals = view.normals && mesh.normals ? 1 : 0;
    out.has_tangents = view.tangents && mesh.tangents ? 1 : 0;
    return BENDY_OK;
}

bendy_status bendy::capi::get_mesh(const bendy_model* model, uint32_t mesh, bendy_mesh& out, bendy_error* /*error*/) {
    describe_mesh(model->get(), mesh, out);
    out.name = model->character->names.meshes[mesh].c_str();
    put_json(model->character->names.mesh_json[mesh], out);
    return BENDY_OK;
}
