// What is in a model: counts, names, and a struct for each joint, clip, IK chain, morph target and mesh.
#include "fail.h"
#include "handles.h"
#include "lookup.h"

#include <bendy/format/names.h>

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::capi {
namespace {

/// For example: `there is no clip "Rum"; did you mean "Run"? There are: "Walk", "Run"`
std::string not_found(std::string_view kind, std::string_view name, const std::vector<std::string>& names) {
    constexpr std::size_t kEnough = 400;  // what a message shows
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

std::uint32_t find(const bendy_model* model, NameList list, const char* kind, const char* name, bendy_error* error) {
    std::uint32_t found = BENDY_NONE;
    guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_pointer(name, "name", error)) return status;
        const auto& names = model->character->names.*list;
        const auto at = std::find(names.begin(), names.end(), name);
        if (at == names.end()) return fail(error, BENDY_NOT_FOUND, not_found(kind, name, names));
        found = static_cast<std::uint32_t>(at - names.begin());
        return BENDY_OK;
    });
    return found;
}

void describe_chain(const ChainRecord& record, bendy_chain& out) {
    out.solver = record.solver;
    out.flags = record.flags;
    out.iterations = record.iterations;
    out.priority = record.priority;
    out.tolerance = record.tolerance;
    std::copy(record.pole_vector.begin(), record.pole_vector.end(), out.pole_vector);
    out.pole_angle = record.pole_angle;
    std::copy(record.tip_offset.begin(), record.tip_offset.end(), out.tip_offset);
    std::copy(record.tip_rotation.begin(), record.tip_rotation.end(), out.tip_rotation);
    out.position_weight = record.position_weight;
    out.rotation_weight = record.rotation_weight;
    out.influence = record.influence;
    out.stretch = record.stretch;
    out.compress = record.compress;
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

uint32_t bendy_joint_count(const bendy_model* model) {
    return count_of(model, &Names::joints);
}
uint32_t bendy_clip_count(const bendy_model* model) {
    return count_of(model, &Names::clips);
}
uint32_t bendy_chain_count(const bendy_model* model) {
    return count_of(model, &Names::chains);
}
uint32_t bendy_morph_target_count(const bendy_model* model) {
    return count_of(model, &Names::targets);
}
uint32_t bendy_mesh_count(const bendy_model* model) {
    return count_of(model, &Names::meshes);
}
uint32_t bendy_submesh_count(const bendy_model* model) {
    return model == nullptr ? 0 : static_cast<std::uint32_t>(model->get().submeshes().size());
}
uint32_t bendy_material_count(const bendy_model* model) {
    return count_of(model, &Names::materials);
}
uint32_t bendy_texture_count(const bendy_model* model) {
    return count_of(model, &Names::textures);
}
uint64_t bendy_vertex_count(const bendy_model* model) {
    return model == nullptr ? 0 : model->get().vertex_count();
}

uint32_t bendy_find_joint(const bendy_model* model, const char* name, bendy_error* error) {
    return find(model, &Names::joints, "joint", name, error);
}
uint32_t bendy_find_clip(const bendy_model* model, const char* name, bendy_error* error) {
    return find(model, &Names::clips, "clip", name, error);
}
uint32_t bendy_find_chain(const bendy_model* model, const char* name, bendy_error* error) {
    return find(model, &Names::chains, "chain", name, error);
}
uint32_t bendy_find_morph_target(const bendy_model* model, const char* name, bendy_error* error) {
    return find(model, &Names::targets, "target", name, error);
}
uint32_t bendy_find_mesh(const bendy_model* model, const char* name, bendy_error* error) {
    return find(model, &Names::meshes, "mesh", name, error);
}
uint32_t bendy_find_material(const bendy_model* model, const char* name, bendy_error* error) {
    return find(model, &Names::materials, "material", name, error);
}
uint32_t bendy_find_texture(const bendy_model* model, const char* name, bendy_error* error) {
    return find(model, &Names::textures, "texture", name, error);
}

const uint32_t* bendy_joint_parents(const bendy_model* model) {
    return model == nullptr || model->get().parents().empty() ? nullptr : model->get().parents().data();
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

bendy_status bendy_get_joint(const bendy_model* model, uint32_t joint, bendy_joint* out, bendy_error* error) {
    return get(model, &Names::joints, "joint", joint, out, error, [&](const bendy::Model& from, bendy_joint& value) {
        const bendy::Joint& view = from.joints()[joint];
        value.parent = view.parent;
        value.rest = to_c(view.rest);
        for (int c = 0; c < 3; ++c) value.shear[c] = view.shear[c];
        value.extras = model->character->names.joint_extras[joint].c_str();
    });
}

bendy_status bendy_get_clip(const bendy_model* model, uint32_t clip, bendy_clip* out, bendy_error* error) {
    return get(model, &Names::clips, "clip", clip, out, error, [&](const bendy::Model& from, bendy_clip& value) {
        const bendy::Clip& view = from.clips()[clip];
        value.start = view.start;
        value.end = view.end;
        value.frame_rate = view.frame_rate;
        value.loops = view.loop ? 1 : 0;
        value.is_packed = view.packed ? 1 : 0;
        put_json(model->character->names.clip_json[clip], value);
    });
}

bendy_status bendy_get_chain(const bendy_model* model, uint32_t chain, bendy_chain* out, bendy_error* error) {
    return get(model, &Names::chains, "chain", chain, out, error, [&](const bendy::Model& from, bendy_chain& value) {
        const bendy::Chain& view = from.chains()[chain];
        value.start = view.start;
        value.effector = view.effector;
        value.links = view.links;
        value.target = view.target;
        value.pole = view.pole;
        describe_chain(view.record, value);
        value.extras = model->character->names.chain_extras[chain].c_str();
    });
}

bendy_status bendy_get_morph_target(const bendy_model* model, uint32_t target, bendy_morph_target* out,
                                    bendy_error* error) {
    return get(model, &Names::targets, "target", target, out, error,
               [&](const bendy::Model& from, bendy_morph_target& value) {
                   value.mesh = model->character->target_meshes[target];
                   const bendy::Mesh& mesh = from.meshes()[value.mesh];
                   const bendy::MorphTargetView& view = mesh.targets[target - from.first_morph_target(value.mesh)];
                   value.rest_weight = view.rest_weight;
                   value.vertices = view.touched(mesh.vertices);
                   value.has_positions = view.positions ? 1 : 0;
                   value.has_normals = view.normals && mesh.normals ? 1 : 0;
                   value.has_tangents = view.tangents && mesh.tangents ? 1 : 0;
               });
}

bendy_status bendy_get_mesh(const bendy_model* model, uint32_t mesh, bendy_mesh* out, bendy_error* error) {
    return get(model, &Names::meshes, "mesh", mesh, out, error, [&](const bendy::Model& from, bendy_mesh& value) {
        describe_mesh(from, mesh, value);
        put_json(model->character->names.mesh_json[mesh], value);
    });
}
