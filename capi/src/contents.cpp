// What is in a model: counts, names, and a struct for each thing; the values of curves.
#include "fail.h"
#include "handles.h"

#include <bendy/runtime/curve.h>

#include <algorithm>
#include <span>
#include <string>

namespace bendy::capi {
namespace {

using NameList = std::vector<std::string> Names::*;

std::uint32_t count_of(const bendy_model* model, NameList list) {
    return model == nullptr ? 0 : static_cast<std::uint32_t>((model->character->names.*list).size());
}

/// `there is no clip "Rum"; there are: "Walk", "Run"`
std::string not_found(std::string_view kind, std::string_view name, const std::vector<std::string>& names) {
    constexpr std::size_t kEnough = 400;  // what a message shows
    std::string text = "there is no " + std::string(kind) + " \"" + std::string(name) + '"';
    if (names.empty()) return text + ", the model has none at all";
    text += names.size() == 1 ? "; there is: " : "; there are: ";
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

/// Fills `out` with make(model, names), if `index` is one of `list`.
template <class Out, class Make>
bendy_status get(const bendy_model* model, NameList list, const char* kind, std::uint32_t index, Out* out,
                 bendy_error* error, const Make& make) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(index, count_of(model, list), kind, error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        Out value{};
        value.name = (model->character->names.*list)[index].c_str();
        make(model->get(), value);
        put(*out, value);
        return BENDY_OK;
    });
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
}

bendy_status check_curve(const bendy_model* model, std::uint32_t clip, std::uint32_t curve, bendy_error* error) {
    if (const bendy_status status = check_pointer(model, "model", error)) return status;
    if (const bendy_status status = check_index(clip, model->get().clips().size(), "clip", error)) return status;
    return check_index(curve, model->get().clips()[clip].curves.size(), "curve", error);
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

const uint32_t* bendy_joint_parents(const bendy_model* model) {
    return model == nullptr || model->get().parents().empty() ? nullptr : model->get().parents().data();
}

const char* bendy_model_name(const bendy_model* model) {
    return model == nullptr ? nullptr : model->character->names.model.c_str();
}

bendy_status bendy_get_joint(const bendy_model* model, uint32_t joint, bendy_joint* out, bendy_error* error) {
    return get(model, &Names::joints, "joint", joint, out, error, [&](const bendy::Model& from, bendy_joint& value) {
        const bendy::Joint& view = from.joints()[joint];
        value.parent = view.parent;
        value.rest = to_c(view.rest);
        for (int c = 0; c < 3; ++c) value.shear[c] = view.shear[c];
    });
}

bendy_status bendy_get_clip(const bendy_model* model, uint32_t clip, bendy_clip* out, bendy_error* error) {
    return get(model, &Names::clips, "clip", clip, out, error, [&](const bendy::Model& from, bendy_clip& value) {
        const bendy::Clip& view = from.clips()[clip];
        value.start = view.start;
        value.end = view.end;
        value.frame_rate = view.frame_rate;
        value.loops = view.loop ? 1 : 0;
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
    });
}

bendy_status bendy_get_morph_target(const bendy_model* model, uint32_t target, bendy_morph_target* out,
                                    bendy_error* error) {
    return get(model, &Names::targets, "target", target, out, error,
               [&](const bendy::Model& from, bendy_morph_target& value) {
                   value.mesh = model->character->target_meshes[target];
                   value.rest_weight =
                       from.meshes()[value.mesh].targets[target - from.first_morph_target(value.mesh)].rest_weight;
               });
}

bendy_status bendy_get_mesh(const bendy_model* model, uint32_t mesh, bendy_mesh* out, bendy_error* error) {
    return get(model, &Names::meshes, "mesh", mesh, out, error,
               [&](const bendy::Model& from, bendy_mesh& value) { describe_mesh(from, mesh, value); });
}

bendy_status bendy_get_material(const bendy_model* model, uint32_t material, bendy_material* out, bendy_error* error) {
    return get(model, &Names::materials, "material", material, out, error,
               [&](const bendy::Model& from, bendy_material& value) {
                   const bendy::SurfaceRecord& surface = from.materials()[material].surface;
                   value.metallic = surface.metallic;
                   value.roughness = surface.roughness;
                   std::copy(surface.base_colour.begin(), surface.base_colour.end(), value.base_colour);
                   std::copy(surface.emissive.begin(), surface.emissive.end(), value.emissive);
                   value.double_sided = surface.double_sided != 0 ? 1 : 0;
               });
}

uint32_t bendy_curve_count(const bendy_model* model, uint32_t clip) {
    if (model == nullptr || clip >= model->get().clips().size()) return 0;
    return static_cast<std::uint32_t>(model->get().clips()[clip].curves.size());
}

uint32_t bendy_find_curve(const bendy_model* model, uint32_t clip, const char* name_or_path, bendy_error* error) {
    std::uint32_t number = BENDY_NONE;
    guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, model->get().clips().size(), "clip", error)) return status;
        if (const bendy_status status = check_pointer(name_or_path, "name_or_path", error)) return status;
        const bendy::Clip& view = model->get().clips()[clip];
        const bendy::Curve* const found = bendy::find_curve(view, name_or_path);
        if (found == nullptr) {
            return fail(error, BENDY_NOT_FOUND,
                        std::string("the clip has no curve \"") + name_or_path + "\", by name or by path");
        }
        number = static_cast<std::uint32_t>(found - view.curves.data());
        return BENDY_OK;
    });
    return number;
}

bendy_status bendy_get_curve(const bendy_model* model, uint32_t clip, uint32_t curve, bendy_curve* out,
                             bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_curve(model, clip, curve, error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        const bendy::Curve& view = model->get().clips()[clip].curves[curve];
        const CurveNames& names = model->character->names.curves[clip][curve];
        bendy_curve value{};
        value.components = view.components;
        value.name = names.name.c_str();
        value.path = names.path.c_str();
        value.target_kind = static_cast<std::uint32_t>(view.kind);
        value.target = view.target;
        value.start = view.times.front();
        value.end = view.times.back();
        put(*out, value);
        return BENDY_OK;
    });
}

bendy_status bendy_sample_curve(const bendy_model* model, uint32_t clip, uint32_t curve, double seconds, float* values,
                                size_t count, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_curve(model, clip, curve, error)) return status;
        if (const bendy_status status = check_pointer(values, "values", error)) return status;
        const bendy::Curve& view = model->get().clips()[clip].curves[curve];
        if (const bendy_status status = check_room(count, view.components, "values", error)) return status;
        return from_call(bendy::sample_curve(view, seconds, std::span(values, count)), error);
    });
}
