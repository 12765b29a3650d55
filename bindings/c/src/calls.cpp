// Made from bendy.h by bindings/make_c.py.
#include "calls.h"
#include <bendy.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include "fail.h"
#include "fields.h"
#include "lookup.h"
using namespace bendy::capi;

bendy_model* bendy_open(const char* path, const bendy_open_options* options, bendy_error* error) {
    bendy_model* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(path, "path", error)) return status;
        bendy_open_options taken_options = BENDY_OPEN_OPTIONS_INIT;
        if (const bendy_status status = take(options, "options", taken_options, error)) return status;
        return bendy::capi::open(path, taken_options, made, error);
    });
    return made;
}

bendy_model* bendy_open_copy(const void* bytes, size_t size, const bendy_open_options* options, bendy_error* error) {
    bendy_model* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        bendy_open_options taken_options = BENDY_OPEN_OPTIONS_INIT;
        if (const bendy_status status = take(options, "options", taken_options, error)) return status;
        return bendy::capi::open_copy(bytes, size, taken_options, made, error);
    });
    return made;
}

bendy_model* bendy_open_borrowed(const void* bytes, size_t size, const bendy_open_options* options,
                                 bendy_error* error) {
    bendy_model* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        bendy_open_options taken_options = BENDY_OPEN_OPTIONS_INIT;
        if (const bendy_status status = take(options, "options", taken_options, error)) return status;
        return bendy::capi::open_borrowed(bytes, size, taken_options, made, error);
    });
    return made;
}

void bendy_close(bendy_model* model) {
    delete model;
}

bendy_status bendy_check_sums(const bendy_model* model, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        return bendy::capi::check_sums(model, error);
    });
}

uint32_t bendy_joint_count(const bendy_model* model) {
    return model != nullptr ? static_cast<uint32_t>(parts(*model).joint()) : 0;
}

uint32_t bendy_clip_count(const bendy_model* model) {
    return model != nullptr ? static_cast<uint32_t>(parts(*model).clip()) : 0;
}

uint32_t bendy_chain_count(const bendy_model* model) {
    return model != nullptr ? static_cast<uint32_t>(parts(*model).chain()) : 0;
}

uint32_t bendy_morph_target_count(const bendy_model* model) {
    return model != nullptr ? static_cast<uint32_t>(parts(*model).morph_target()) : 0;
}

uint32_t bendy_mesh_count(const bendy_model* model) {
    return model != nullptr ? static_cast<uint32_t>(parts(*model).mesh()) : 0;
}

uint32_t bendy_submesh_count(const bendy_model* model) {
    return model != nullptr ? static_cast<uint32_t>(parts(*model).submesh()) : 0;
}

uint32_t bendy_material_count(const bendy_model* model) {
    return model != nullptr ? static_cast<uint32_t>(parts(*model).material()) : 0;
}

uint32_t bendy_texture_count(const bendy_model* model) {
    return model != nullptr ? static_cast<uint32_t>(parts(*model).texture()) : 0;
}

uint32_t bendy_find_joint(const bendy_model* model, const char* name, bendy_error* error) {
    uint32_t made = BENDY_NONE;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_pointer(name, "name", error)) return status;
        return bendy::capi::find_joint(model, name, made, error);
    });
    return made;
}

uint32_t bendy_find_clip(const bendy_model* model, const char* name, bendy_error* error) {
    uint32_t made = BENDY_NONE;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_pointer(name, "name", error)) return status;
        return bendy::capi::find_clip(model, name, made, error);
    });
    return made;
}

uint32_t bendy_find_chain(const bendy_model* model, const char* name, bendy_error* error) {
    uint32_t made = BENDY_NONE;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_pointer(name, "name", error)) return status;
        return bendy::capi::find_chain(model, name, made, error);
    });
    return made;
}

uint32_t bendy_find_morph_target(const bendy_model* model, const char* name, bendy_error* error) {
    uint32_t made = BENDY_NONE;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_pointer(name, "name", error)) return status;
        return bendy::capi::find_morph_target(model, name, made, error);
    });
    return made;
}

uint32_t bendy_find_mesh(const bendy_model* model, const char* name, bendy_error* error) {
    uint32_t made = BENDY_NONE;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_pointer(name, "name", error)) return status;
        return bendy::capi::find_mesh(model, name, made, error);
    });
    return made;
}

uint32_t bendy_find_material(const bendy_model* model, const char* name, bendy_error* error) {
    uint32_t made = BENDY_NONE;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_pointer(name, "name", error)) return status;
        return bendy::capi::find_material(model, name, made, error);
    });
    return made;
}

uint32_t bendy_find_texture(const bendy_model* model, const char* name, bendy_error* error) {
    uint32_t made = BENDY_NONE;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_pointer(name, "name", error)) return status;
        return bendy::capi::find_texture(model, name, made, error);
    });
    return made;
}

bendy_status bendy_get_joint(const bendy_model* model, uint32_t joint, bendy_joint* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(joint, parts(*model).joint(), "joint", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_joint made_out{};
        if (const bendy_status status = bendy::capi::get_joint(model, joint, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_get_clip(const bendy_model* model, uint32_t clip, bendy_clip* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_clip made_out{};
        if (const bendy_status status = bendy::capi::get_clip(model, clip, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_get_chain(const bendy_model* model, uint32_t chain, bendy_chain* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(chain, parts(*model).chain(), "chain", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_chain made_out{};
        if (const bendy_status status = bendy::capi::get_chain(model, chain, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_get_morph_target(const bendy_model* model, uint32_t morph_target, bendy_morph_target* out,
                                    bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(morph_target, parts(*model).morph_target(), "morph target", error))
            return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_morph_target made_out{};
        if (const bendy_status status = bendy::capi::get_morph_target(model, morph_target, made_out, error))
            return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_get_mesh(const bendy_model* model, uint32_t mesh, bendy_mesh* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(mesh, parts(*model).mesh(), "mesh", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_mesh made_out{};
        if (const bendy_status status = bendy::capi::get_mesh(model, mesh, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_get_submesh(const bendy_model* model, uint32_t submesh, bendy_submesh* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(submesh, parts(*model).submesh(), "submesh", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_submesh made_out{};
        if (const bendy_status status = bendy::capi::get_submesh(model, submesh, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_get_material(const bendy_model* model, uint32_t material, bendy_material* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(material, parts(*model).material(), "material", error))
            return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_material made_out{};
        if (const bendy_status status = bendy::capi::get_material(model, material, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_get_texture(const bendy_model* model, uint32_t texture, bendy_texture* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(texture, parts(*model).texture(), "texture", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_texture made_out{};
        if (const bendy_status status = bendy::capi::get_texture(model, texture, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_get_image(const bendy_model* model, uint32_t texture, uint32_t image, bendy_image* out,
                             bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(texture, parts(*model).texture(), "texture", error)) return status;
        if (const bendy_status status = check_index(image, parts(*model).image(texture), "image", error, "the texture"))
            return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_image made_out{};
        if (const bendy_status status = bendy::capi::get_image(model, texture, image, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_get_indices(const bendy_model* model, uint32_t mesh, uint32_t* indices, size_t count,
                               bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(mesh, parts(*model).mesh(), "mesh", error)) return status;
        return bendy::capi::get_indices(model, mesh, indices, count, error);
    });
}

bendy_status bendy_get_texture_coords(const bendy_model* model, uint32_t mesh, uint32_t set, float* uv, size_t count,
                                      bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(mesh, parts(*model).mesh(), "mesh", error)) return status;
        if (const bendy_status status = check_pointer(uv, "uv", error)) return status;
        return bendy::capi::get_texture_coords(model, mesh, set, uv, count, error);
    });
}

bendy_status bendy_get_influences(const bendy_model* model, uint32_t mesh, uint32_t* bones, float* weights,
                                  size_t count, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(mesh, parts(*model).mesh(), "mesh", error)) return status;
        if (const bendy_status status = check_pointer(bones, "bones", error)) return status;
        if (const bendy_status status = check_pointer(weights, "weights", error)) return status;
        return bendy::capi::get_influences(model, mesh, bones, weights, count, error);
    });
}

bendy_status bendy_get_bind_palette(const bendy_model* model, uint32_t mesh, uint32_t* joints, float* inverse_bind,
                                    size_t count, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(mesh, parts(*model).mesh(), "mesh", error)) return status;
        return bendy::capi::get_bind_palette(model, mesh, joints, inverse_bind, count, error);
    });
}

bendy_status bendy_get_movers(const bendy_model* model, uint32_t mesh, uint32_t* joints, size_t count,
                              bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(mesh, parts(*model).mesh(), "mesh", error)) return status;
        return bendy::capi::get_movers(model, mesh, joints, count, error);
    });
}

uint32_t bendy_stream_count(const bendy_model* model, uint32_t mesh) {
    return model != nullptr && mesh < parts(*model).mesh() ? static_cast<uint32_t>(parts(*model).stream(mesh)) : 0;
}

uint32_t bendy_find_stream(const bendy_model* model, uint32_t mesh, uint32_t kind, uint32_t set, bendy_error* error) {
    uint32_t made = BENDY_NONE;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(mesh, parts(*model).mesh(), "mesh", error)) return status;
        if (const bendy_status status = check_value(kind, BENDY_STREAM_INDICES + 1, "kind", "bendy_stream_kind", error))
            return status;
        return bendy::capi::find_stream(model, mesh, kind, set, made, error);
    });
    return made;
}

bendy_status bendy_get_stream(const bendy_model* model, uint32_t mesh, uint32_t stream, bendy_stream* out,
                              bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(mesh, parts(*model).mesh(), "mesh", error)) return status;
        if (const bendy_status status = check_index(stream, parts(*model).stream(mesh), "stream", error, "the mesh"))
            return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_stream made_out{};
        if (const bendy_status status = bendy::capi::get_stream(model, mesh, stream, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_get_numbers(const bendy_model* model, uint32_t mesh, uint32_t stream, float* numbers, size_t count,
                               bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(mesh, parts(*model).mesh(), "mesh", error)) return status;
        if (const bendy_status status = check_index(stream, parts(*model).stream(mesh), "stream", error, "the mesh"))
            return status;
        if (const bendy_status status = check_pointer(numbers, "numbers", error)) return status;
        return bendy::capi::get_numbers(model, mesh, stream, numbers, count, error);
    });
}

bendy_status bendy_get_integers(const bendy_model* model, uint32_t mesh, uint32_t stream, uint32_t* integers,
                                size_t count, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(mesh, parts(*model).mesh(), "mesh", error)) return status;
        if (const bendy_status status = check_index(stream, parts(*model).stream(mesh), "stream", error, "the mesh"))
            return status;
        if (const bendy_status status = check_pointer(integers, "integers", error)) return status;
        return bendy::capi::get_integers(model, mesh, stream, integers, count, error);
    });
}

bendy_status bendy_get_displacements(const bendy_model* model, uint32_t morph_target, uint32_t* vertices,
                                     float* positions, float* normals, float* tangents, size_t count,
                                     bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(morph_target, parts(*model).morph_target(), "morph target", error))
            return status;
        return bendy::capi::get_displacements(model, morph_target, vertices, positions, normals, tangents, count,
                                              error);
    });
}

bendy_status bendy_apply_morph_targets(const bendy_model* model, uint32_t mesh, const float* weights, float* positions,
                                       float* normals, float* tangents, size_t count, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(mesh, parts(*model).mesh(), "mesh", error)) return status;
        return bendy::capi::apply_morph_targets(model, mesh, weights, positions, normals, tangents, count, error);
    });
}

uint32_t bendy_joint_submesh_count(const bendy_model* model) {
    return model != nullptr ? static_cast<uint32_t>(parts(*model).joint_submesh()) : 0;
}

bendy_status bendy_get_joint_submesh(const bendy_model* model, uint32_t joint_submesh, bendy_joint_submesh* out,
                                     bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status =
                check_index(joint_submesh, parts(*model).joint_submesh(), "joint submesh", error))
            return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_joint_submesh made_out{};
        if (const bendy_status status = bendy::capi::get_joint_submesh(model, joint_submesh, made_out, error))
            return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

uint32_t bendy_constraint_count(const bendy_model* model) {
    return model != nullptr ? static_cast<uint32_t>(parts(*model).constraint()) : 0;
}

bendy_status bendy_get_constraint(const bendy_model* model, uint32_t constraint, bendy_constraint* out,
                                  bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(constraint, parts(*model).constraint(), "constraint", error))
            return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_constraint made_out{};
        if (const bendy_status status = bendy::capi::get_constraint(model, constraint, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_to_constraint_space(const bendy_model* model, uint32_t constraint, const float* rotation, double* R,
                                       bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(constraint, parts(*model).constraint(), "constraint", error))
            return status;
        if (const bendy_status status = check_pointer(rotation, "rotation", error)) return status;
        if (const bendy_status status = check_rotation(rotation, error)) return status;
        if (const bendy_status status = check_pointer(R, "R", error)) return status;
        return bendy::capi::to_constraint_space(model, constraint, rotation, R, error);
    });
}

bendy_status bendy_from_constraint_space(const bendy_model* model, uint32_t constraint, const double* R,
                                         float* rotation, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(constraint, parts(*model).constraint(), "constraint", error))
            return status;
        if (const bendy_status status = check_pointer(R, "R", error)) return status;
        if (const bendy_status status = check_rotation(R, error)) return status;
        if (const bendy_status status = check_pointer(rotation, "rotation", error)) return status;
        return bendy::capi::from_constraint_space(model, constraint, R, rotation, error);
    });
}

bendy_status bendy_clamp_rotation(const bendy_model* model, uint32_t constraint, const double* R, double* clamped,
                                  double* violation, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(constraint, parts(*model).constraint(), "constraint", error))
            return status;
        if (const bendy_status status = check_pointer(R, "R", error)) return status;
        if (const bendy_status status = check_rotation(R, error)) return status;
        return bendy::capi::clamp_rotation(model, constraint, R, clamped, violation, error);
    });
}

bendy_status bendy_clamp_translation(const bendy_model* model, uint32_t constraint, const float* translation,
                                     float* clamped, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(constraint, parts(*model).constraint(), "constraint", error))
            return status;
        if (const bendy_status status = check_pointer(translation, "translation", error)) return status;
        if (const bendy_status status = check_finite(std::span(translation, 3), "translation", error)) return status;
        if (const bendy_status status = check_pointer(clamped, "clamped", error)) return status;
        return bendy::capi::clamp_translation(model, constraint, translation, clamped, error);
    });
}

bendy_status bendy_get_links(const bendy_model* model, uint32_t chain, uint32_t* joints, float* weights, size_t count,
                             bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(chain, parts(*model).chain(), "chain", error)) return status;
        if (const bendy_status status = check_pointer(joints, "joints", error)) return status;
        return bendy::capi::get_links(model, chain, joints, weights, count, error);
    });
}

uint32_t bendy_track_count(const bendy_model* model, uint32_t clip) {
    return model != nullptr && clip < parts(*model).clip() ? static_cast<uint32_t>(parts(*model).track(clip)) : 0;
}

bendy_status bendy_get_track(const bendy_model* model, uint32_t clip, uint32_t track, bendy_track* out,
                             bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        if (const bendy_status status = check_index(track, parts(*model).track(clip), "track", error, "the clip"))
            return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_track made_out{};
        if (const bendy_status status = bendy::capi::get_track(model, clip, track, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_sample_track(const bendy_model* model, uint32_t clip, uint32_t track, float seconds, float* values,
                                size_t count, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        if (const bendy_status status = check_index(track, parts(*model).track(clip), "track", error, "the clip"))
            return status;
        if (const bendy_status status = check_number(seconds, "seconds", error)) return status;
        if (const bendy_status status = check_pointer(values, "values", error)) return status;
        return bendy::capi::sample_track(model, clip, track, seconds, values, count, error);
    });
}

bendy_status bendy_packed_frame_times(const bendy_model* model, uint32_t clip, float* times, size_t count,
                                      bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        return bendy::capi::packed_frame_times(model, clip, times, count, error);
    });
}

uint32_t bendy_marker_count(const bendy_model* model, uint32_t clip) {
    return model != nullptr && clip < parts(*model).clip() ? static_cast<uint32_t>(parts(*model).marker(clip)) : 0;
}

bendy_status bendy_get_marker(const bendy_model* model, uint32_t clip, uint32_t marker, bendy_marker* out,
                              bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        if (const bendy_status status = check_index(marker, parts(*model).marker(clip), "marker", error, "the clip"))
            return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_marker made_out{};
        if (const bendy_status status = bendy::capi::get_marker(model, clip, marker, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

uint32_t bendy_frame_sequence_count(const bendy_model* model, uint32_t clip) {
    return model != nullptr && clip < parts(*model).clip() ? static_cast<uint32_t>(parts(*model).frame_sequence(clip))
                                                           : 0;
}

bendy_status bendy_get_frame_sequence(const bendy_model* model, uint32_t clip, uint32_t frame_sequence,
                                      bendy_frame_sequence* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        if (const bendy_status status =
                check_index(frame_sequence, parts(*model).frame_sequence(clip), "frame sequence", error, "the clip"))
            return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_frame_sequence made_out{};
        if (const bendy_status status = bendy::capi::get_frame_sequence(model, clip, frame_sequence, made_out, error))
            return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_mix_frames(const bendy_model* model, uint32_t clip, uint32_t frame_sequence, float seconds,
                              bendy_frame_mix* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        if (const bendy_status status =
                check_index(frame_sequence, parts(*model).frame_sequence(clip), "frame sequence", error, "the clip"))
            return status;
        if (const bendy_status status = check_number(seconds, "seconds", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_frame_mix made_out{};
        if (const bendy_status status = bendy::capi::mix_frames(model, clip, frame_sequence, seconds, made_out, error))
            return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

uint32_t bendy_curve_count(const bendy_model* model, uint32_t clip) {
    return model != nullptr && clip < parts(*model).clip() ? static_cast<uint32_t>(parts(*model).curve(clip)) : 0;
}

uint32_t bendy_find_curve(const bendy_model* model, uint32_t clip, const char* name_or_path, bendy_error* error) {
    uint32_t made = BENDY_NONE;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        if (const bendy_status status = check_pointer(name_or_path, "name_or_path", error)) return status;
        return bendy::capi::find_curve(model, clip, name_or_path, made, error);
    });
    return made;
}

uint32_t bendy_find_curve_of(const bendy_model* model, uint32_t clip, uint32_t target_kind, uint32_t target_index,
                             const char* path, bendy_error* error) {
    uint32_t made = BENDY_NONE;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        if (const bendy_status status =
                check_value(target_kind, BENDY_CURVE_TEXTURE + 1, "target_kind", "bendy_curve_target", error))
            return status;
        if (const bendy_status status = check_pointer(path, "path", error)) return status;
        return bendy::capi::find_curve_of(model, clip, target_kind, target_index, path, made, error);
    });
    return made;
}

bendy_status bendy_get_curve(const bendy_model* model, uint32_t clip, uint32_t curve, bendy_curve* out,
                             bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        if (const bendy_status status = check_index(curve, parts(*model).curve(clip), "curve", error, "the clip"))
            return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_curve made_out{};
        if (const bendy_status status = bendy::capi::get_curve(model, clip, curve, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_get_curve_values(const bendy_model* model, uint32_t clip, uint32_t curve, float* values,
                                    size_t count, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        if (const bendy_status status = check_index(curve, parts(*model).curve(clip), "curve", error, "the clip"))
            return status;
        if (const bendy_status status = check_pointer(values, "values", error)) return status;
        return bendy::capi::get_curve_values(model, clip, curve, values, count, error);
    });
}

bendy_status bendy_sample_curve(const bendy_model* model, uint32_t clip, uint32_t curve, double seconds, float* values,
                                size_t count, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        if (const bendy_status status = check_index(curve, parts(*model).curve(clip), "curve", error, "the clip"))
            return status;
        if (const bendy_status status = check_number(seconds, "seconds", error)) return status;
        if (const bendy_status status = check_pointer(values, "values", error)) return status;
        return bendy::capi::sample_curve(model, clip, curve, seconds, values, count, error);
    });
}

bendy_pose* bendy_pose_new(const bendy_model* model, bendy_error* error) {
    bendy_pose* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        return bendy::capi::pose_new(model, made, error);
    });
    return made;
}

bendy_pose* bendy_pose_copy(const bendy_pose* pose, bendy_error* error) {
    bendy_pose* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        return bendy::capi::pose_copy(pose, made, error);
    });
    return made;
}

void bendy_pose_free(bendy_pose* pose) {
    delete pose;
}

bendy_status bendy_set_rest(bendy_pose* pose, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        return bendy::capi::set_rest(pose, error);
    });
}

bendy_status bendy_stand(bendy_pose* pose, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        return bendy::capi::stand(pose, error);
    });
}

bendy_status bendy_sample(bendy_pose* pose, uint32_t clip, float seconds, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*pose).clip(), "clip", error)) return status;
        if (const bendy_status status = check_number(seconds, "seconds", error)) return status;
        return bendy::capi::sample(pose, clip, seconds, error);
    });
}

bendy_status bendy_blend(bendy_pose* pose, const bendy_pose* other, float weight, const float* mask,
                         bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_pointer(other, "other", error)) return status;
        if (const bendy_status status = check_same_model(other, *pose, "other", "pose", error)) return status;
        if (const bendy_status status = check_finite(weight, "weight", error)) return status;
        return bendy::capi::blend(pose, other, weight, mask, error);
    });
}

bendy_status bendy_make_additive(bendy_pose* pose, const bendy_pose* reference, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_pointer(reference, "reference", error)) return status;
        if (const bendy_status status = check_same_model(reference, *pose, "reference", "pose", error)) return status;
        return bendy::capi::make_additive(pose, reference, error);
    });
}

bendy_status bendy_add(bendy_pose* pose, const bendy_pose* difference, float weight, const float* mask,
                       bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_pointer(difference, "difference", error)) return status;
        if (const bendy_status status = check_same_model(difference, *pose, "difference", "pose", error)) return status;
        if (const bendy_status status = check_finite(weight, "weight", error)) return status;
        return bendy::capi::add(pose, difference, weight, mask, error);
    });
}

bendy_status bendy_mask_below(const bendy_model* model, uint32_t joint, float inside, float outside, float* mask,
                              size_t count, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(joint, parts(*model).joint(), "joint", error)) return status;
        if (const bendy_status status = check_finite(inside, "inside", error)) return status;
        if (const bendy_status status = check_finite(outside, "outside", error)) return status;
        if (const bendy_status status = check_pointer(mask, "mask", error)) return status;
        return bendy::capi::mask_below(model, joint, inside, outside, mask, count, error);
    });
}

bendy_status bendy_get_local(const bendy_pose* pose, uint32_t first, uint32_t count, bendy_transform* transforms,
                             bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        return bendy::capi::get_local(pose, first, count, transforms, error);
    });
}

bendy_status bendy_set_local(bendy_pose* pose, uint32_t first, uint32_t count, const bendy_transform* transforms,
                             bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        return bendy::capi::set_local(pose, first, count, transforms, error);
    });
}

bendy_status bendy_get_weights(const bendy_pose* pose, uint32_t first, uint32_t count, float* weights,
                               bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        return bendy::capi::get_weights(pose, first, count, weights, error);
    });
}

bendy_status bendy_set_weights(bendy_pose* pose, uint32_t first, uint32_t count, const float* weights,
                               bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        return bendy::capi::set_weights(pose, first, count, weights, error);
    });
}

bendy_status bendy_transform_matrix(const bendy_transform* transform, const float* shear, float* matrix,
                                    bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(transform, "transform", error)) return status;
        if (const bendy_status status = check_fields(*transform, error)) return status;
        if (const bendy_status status = shear == nullptr ? BENDY_OK : check_finite(std::span(shear, 3), "shear", error))
            return status;
        if (const bendy_status status = check_pointer(matrix, "matrix", error)) return status;
        return bendy::capi::transform_matrix(*transform, shear, matrix, error);
    });
}

bendy_status bendy_constrain(bendy_pose* pose, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        return bendy::capi::constrain(pose, error);
    });
}

bendy_reach_state* bendy_reach_state_new(const bendy_model* model, bendy_error* error) {
    bendy_reach_state* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        return bendy::capi::reach_state_new(model, made, error);
    });
    return made;
}

void bendy_reach_state_free(bendy_reach_state* state) {
    delete state;
}

bendy_status bendy_reach_state_reset(bendy_reach_state* state, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(state, "state", error)) return status;
        return bendy::capi::reach_state_reset(state, error);
    });
}

bendy_status bendy_reach_state_forget(bendy_reach_state* state, uint32_t chain, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(state, "state", error)) return status;
        if (const bendy_status status = check_index(chain, parts(*state).chain(), "chain", error)) return status;
        return bendy::capi::reach_state_forget(state, chain, error);
    });
}

bendy_status bendy_reach(bendy_pose* pose, uint32_t chain, const float* position, const float* rotation,
                         const bendy_reach_options* options, bendy_reach_result* result, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_index(chain, parts(*pose).chain(), "chain", error)) return status;
        if (const bendy_status status = check_pointer(position, "position", error)) return status;
        if (const bendy_status status = check_finite(std::span(position, 3), "position", error)) return status;
        if (const bendy_status status = rotation == nullptr ? BENDY_OK : check_rotation(rotation, error)) return status;
        bendy_reach_options taken_options = BENDY_REACH_OPTIONS_INIT;
        if (const bendy_status status = take(options, "options", taken_options, error)) return status;
        if (const bendy_status status = check_fields(taken_options, error)) return status;
        if (const bendy_status status = result == nullptr ? BENDY_OK : check_out(result, "result", error))
            return status;
        bendy_reach_result made_result{};
        if (const bendy_status status =
                bendy::capi::reach(pose, chain, position, rotation, taken_options, made_result, error))
            return status;
        if (result != nullptr) put(*result, made_result);
        return BENDY_OK;
    });
}

bendy_status bendy_reach_chains(bendy_pose* pose, const bendy_reach_request* requests, size_t count,
                                bendy_reach_result* results, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        return bendy::capi::reach_chains(pose, requests, count, results, error);
    });
}

bendy_status bendy_reach_all(bendy_pose* pose, bendy_reach_state* state, float seconds, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_same_model(state, *pose, "state", "pose", error)) return status;
        if (const bendy_status status = check_finite(seconds, "seconds", error)) return status;
        return bendy::capi::reach_all(pose, state, seconds, error);
    });
}

bendy_body_reach* bendy_body_reach_new(const bendy_model* model, const bendy_effector* effectors, size_t count,
                                       const bendy_body_reach_options* options, bendy_error* error) {
    bendy_body_reach* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        bendy_body_reach_options taken_options = BENDY_BODY_REACH_OPTIONS_INIT;
        if (const bendy_status status = take(options, "options", taken_options, error)) return status;
        if (const bendy_status status = check_fields(taken_options, error)) return status;
        return bendy::capi::body_reach_new(model, effectors, count, taken_options, made, error);
    });
    return made;
}

void bendy_body_reach_free(bendy_body_reach* body) {
    delete body;
}

bendy_status bendy_reach_body(bendy_pose* pose, bendy_body_reach* body, const bendy_effector_target* targets,
                              size_t count, bendy_body_reached* result, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_pointer(body, "body", error)) return status;
        if (const bendy_status status = check_same_model(body, *pose, "body", "pose", error)) return status;
        if (const bendy_status status = result == nullptr ? BENDY_OK : check_out(result, "result", error))
            return status;
        bendy_body_reached made_result{};
        if (const bendy_status status = bendy::capi::reach_body(pose, body, targets, count, made_result, error))
            return status;
        if (result != nullptr) put(*result, made_result);
        return BENDY_OK;
    });
}

bendy_status bendy_joint_matrices(bendy_pose* pose, uint32_t first, uint32_t count, const float* world, float* matrices,
                                  bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status =
                world == nullptr ? BENDY_OK : check_finite(std::span(world, 16), "world", error))
            return status;
        return bendy::capi::joint_matrices(pose, first, count, world, matrices, error);
    });
}

bendy_status bendy_bone_matrices(bendy_pose* pose, uint32_t mesh, float* matrices, size_t count, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_index(mesh, parts(*pose).mesh(), "mesh", error)) return status;
        if (const bendy_status status = check_pointer(matrices, "matrices", error)) return status;
        return bendy::capi::bone_matrices(pose, mesh, matrices, count, error);
    });
}

bendy_playback* bendy_playback_new(const bendy_model* model, uint32_t clip, bendy_error* error) {
    bendy_playback* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        return bendy::capi::playback_new(model, clip, made, error);
    });
    return made;
}

bendy_playback* bendy_playback_new_range(float start, float end, uint32_t mode, bendy_error* error) {
    bendy_playback* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_finite(start, "start", error)) return status;
        if (const bendy_status status = check_finite(end, "end", error)) return status;
        if (const bendy_status status = check_value(mode, BENDY_LOOP_PING_PONG + 1, "mode", "bendy_loop_mode", error))
            return status;
        return bendy::capi::playback_new_range(start, end, mode, made, error);
    });
    return made;
}

void bendy_playback_free(bendy_playback* playback) {
    delete playback;
}

bendy_status bendy_get_playback(const bendy_playback* playback, bendy_playback_info* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_playback_info made_out{};
        if (const bendy_status status = bendy::capi::get_playback(playback, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_playback_advance(bendy_playback* playback, double seconds, bendy_played* played,
                                    bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        if (const bendy_status status = check_finite(seconds, "seconds", error)) return status;
        if (const bendy_status status = played == nullptr ? BENDY_OK : check_out(played, "played", error))
            return status;
        bendy_played made_played{};
        if (const bendy_status status = bendy::capi::playback_advance(playback, seconds, made_played, error))
            return status;
        if (played != nullptr) put(*played, made_played);
        return BENDY_OK;
    });
}

bendy_status bendy_playback_set_speed(bendy_playback* playback, double speed, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        if (const bendy_status status = check_finite(speed, "speed", error)) return status;
        return bendy::capi::playback_set_speed(playback, speed, error);
    });
}

bendy_status bendy_playback_set_mode(bendy_playback* playback, uint32_t mode, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        if (const bendy_status status = check_value(mode, BENDY_LOOP_PING_PONG + 1, "mode", "bendy_loop_mode", error))
            return status;
        return bendy::capi::playback_set_mode(playback, mode, error);
    });
}

bendy_status bendy_playback_seek(bendy_playback* playback, double seconds, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        if (const bendy_status status = check_finite(seconds, "seconds", error)) return status;
        return bendy::capi::playback_seek(playback, seconds, error);
    });
}

bendy_status bendy_playback_seek_share(bendy_playback* playback, double share, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        if (const bendy_status status = check_finite(share, "share", error)) return status;
        return bendy::capi::playback_seek_share(playback, share, error);
    });
}

bendy_status bendy_count_markers(const bendy_model* model, uint32_t clip, const bendy_played* played, uint64_t* count,
                                 bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        if (const bendy_status status = check_pointer(played, "played", error)) return status;
        bendy_played taken_played{};
        if (const bendy_status status = take(played, "played", taken_played, error)) return status;
        if (const bendy_status status = check_fields(taken_played, error)) return status;
        if (const bendy_status status = check_pointer(count, "count", error)) return status;
        return bendy::capi::count_markers(model, clip, taken_played, count, error);
    });
}

bendy_status bendy_collect_markers(const bendy_model* model, uint32_t clip, const bendy_played* played,
                                   uint32_t* markers, size_t capacity, size_t* count, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*model).clip(), "clip", error)) return status;
        if (const bendy_status status = check_pointer(played, "played", error)) return status;
        bendy_played taken_played{};
        if (const bendy_status status = take(played, "played", taken_played, error)) return status;
        if (const bendy_status status = check_fields(taken_played, error)) return status;
        if (const bendy_status status = check_pointer(count, "count", error)) return status;
        return bendy::capi::collect_markers(model, clip, taken_played, markers, capacity, count, error);
    });
}

bendy_fade* bendy_fade_new(float weight, bendy_error* error) {
    bendy_fade* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_finite(weight, "weight", error)) return status;
        return bendy::capi::fade_new(weight, made, error);
    });
    return made;
}

void bendy_fade_free(bendy_fade* fade) {
    delete fade;
}

bendy_status bendy_fade_to(bendy_fade* fade, float weight, float seconds, uint32_t easing, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(fade, "fade", error)) return status;
        if (const bendy_status status = check_finite(weight, "weight", error)) return status;
        if (const bendy_status status = check_finite(seconds, "seconds", error)) return status;
        if (const bendy_status status = check_value(easing, BENDY_EASING_SMOOTH + 1, "easing", "bendy_easing", error))
            return status;
        return bendy::capi::fade_to(fade, weight, seconds, easing, error);
    });
}

bendy_status bendy_fade_advance(bendy_fade* fade, double seconds, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(fade, "fade", error)) return status;
        if (const bendy_status status = check_finite(seconds, "seconds", error)) return status;
        return bendy::capi::fade_advance(fade, seconds, error);
    });
}

bendy_crossfade* bendy_crossfade_new(const bendy_model* model, bendy_error* error) {
    bendy_crossfade* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        return bendy::capi::crossfade_new(model, made, error);
    });
    return made;
}

void bendy_crossfade_free(bendy_crossfade* crossfade) {
    delete crossfade;
}

bendy_status bendy_crossfade_play(bendy_crossfade* crossfade, uint32_t clip, const bendy_playback* playback,
                                  float fade_seconds, uint32_t easing, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(crossfade, "crossfade", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*crossfade).clip(), "clip", error)) return status;
        if (const bendy_status status = check_finite(fade_seconds, "fade_seconds", error)) return status;
        if (const bendy_status status = check_value(easing, BENDY_EASING_SMOOTH + 1, "easing", "bendy_easing", error))
            return status;
        return bendy::capi::crossfade_play(crossfade, clip, playback, fade_seconds, easing, error);
    });
}

bendy_status bendy_crossfade_advance(bendy_crossfade* crossfade, double seconds, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(crossfade, "crossfade", error)) return status;
        if (const bendy_status status = check_finite(seconds, "seconds", error)) return status;
        return bendy::capi::crossfade_advance(crossfade, seconds, error);
    });
}

bendy_status bendy_get_playing(const bendy_crossfade* crossfade, uint32_t number, bendy_playing* out,
                               bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(crossfade, "crossfade", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_playing made_out{};
        if (const bendy_status status = bendy::capi::get_playing(crossfade, number, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_get_played(const bendy_crossfade* crossfade, uint32_t number, bendy_played* out,
                              bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(crossfade, "crossfade", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_played made_out{};
        if (const bendy_status status = bendy::capi::get_played(crossfade, number, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_crossfade_get_playback(const bendy_crossfade* crossfade, uint32_t number, bendy_playback* playback,
                                          bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(crossfade, "crossfade", error)) return status;
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        return bendy::capi::crossfade_get_playback(crossfade, number, playback, error);
    });
}

bendy_status bendy_crossfade_set_playback(bendy_crossfade* crossfade, const bendy_playback* playback,
                                          bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(crossfade, "crossfade", error)) return status;
        if (const bendy_status status = check_pointer(playback, "playback", error)) return status;
        return bendy::capi::crossfade_set_playback(crossfade, playback, error);
    });
}

bendy_status bendy_sample_crossfade(bendy_pose* pose, const bendy_crossfade* crossfade, bendy_pose* scratch,
                                    bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_pointer(crossfade, "crossfade", error)) return status;
        if (const bendy_status status = check_same_model(crossfade, *pose, "crossfade", "pose", error)) return status;
        if (const bendy_status status = check_pointer(scratch, "scratch", error)) return status;
        if (const bendy_status status = check_same_model(scratch, *pose, "scratch", "pose", error)) return status;
        return bendy::capi::sample_crossfade(pose, crossfade, scratch, error);
    });
}

bendy_status bendy_root_motion_matrix(const bendy_root_motion* motion, double* matrix, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(motion, "motion", error)) return status;
        if (const bendy_status status = check_fields(*motion, error)) return status;
        if (const bendy_status status = check_pointer(matrix, "matrix", error)) return status;
        return bendy::capi::root_motion_matrix(*motion, matrix, error);
    });
}

bendy_status bendy_root_motion_compose(const bendy_root_motion* before, const bendy_root_motion* motion,
                                       bendy_root_motion* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(before, "before", error)) return status;
        if (const bendy_status status = check_fields(*before, error)) return status;
        if (const bendy_status status = check_pointer(motion, "motion", error)) return status;
        if (const bendy_status status = check_fields(*motion, error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        bendy_root_motion made_out{};
        if (const bendy_status status = bendy::capi::root_motion_compose(*before, *motion, made_out, error))
            return status;
        *out = made_out;
        return BENDY_OK;
    });
}

bendy_status bendy_root_motion_inverse(const bendy_root_motion* motion, bendy_root_motion* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(motion, "motion", error)) return status;
        if (const bendy_status status = check_fields(*motion, error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        bendy_root_motion made_out{};
        if (const bendy_status status = bendy::capi::root_motion_inverse(*motion, made_out, error)) return status;
        *out = made_out;
        return BENDY_OK;
    });
}

bendy_status bendy_root_motion_blend(const bendy_root_motion* motion, const bendy_root_motion* other, double weight,
                                     bendy_root_motion* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(motion, "motion", error)) return status;
        if (const bendy_status status = check_fields(*motion, error)) return status;
        if (const bendy_status status = check_pointer(other, "other", error)) return status;
        if (const bendy_status status = check_fields(*other, error)) return status;
        if (const bendy_status status = check_finite(weight, "weight", error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        bendy_root_motion made_out{};
        if (const bendy_status status = bendy::capi::root_motion_blend(*motion, *other, weight, made_out, error))
            return status;
        *out = made_out;
        return BENDY_OK;
    });
}

bendy_status bendy_root_motion_repeat(const bendy_root_motion* motion, uint64_t times, bendy_root_motion* out,
                                      bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(motion, "motion", error)) return status;
        if (const bendy_status status = check_fields(*motion, error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        bendy_root_motion made_out{};
        if (const bendy_status status = bendy::capi::root_motion_repeat(*motion, times, made_out, error)) return status;
        *out = made_out;
        return BENDY_OK;
    });
}

bendy_root_path* bendy_root_path_new(const bendy_model* model, uint32_t joint, const bendy_root_axes* axes,
                                     bendy_error* error) {
    bendy_root_path* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(joint, parts(*model).joint(), "joint", error)) return status;
        bendy_root_axes taken_axes = BENDY_ROOT_AXES_INIT;
        if (const bendy_status status = take(axes, "axes", taken_axes, error)) return status;
        if (const bendy_status status = check_fields(taken_axes, error)) return status;
        return bendy::capi::root_path_new(model, joint, taken_axes, made, error);
    });
    return made;
}

void bendy_root_path_free(bendy_root_path* path) {
    delete path;
}

bendy_status bendy_root_path_at(const bendy_root_path* path, uint32_t clip, double seconds, bendy_root_motion* out,
                                bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(path, "path", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*path).clip(), "clip", error)) return status;
        if (const bendy_status status = check_finite(seconds, "seconds", error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        bendy_root_motion made_out{};
        if (const bendy_status status = bendy::capi::root_path_at(path, clip, seconds, made_out, error)) return status;
        *out = made_out;
        return BENDY_OK;
    });
}

bendy_status bendy_root_path_between(const bendy_root_path* path, uint32_t clip, double from, double to,
                                     bendy_root_motion* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(path, "path", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*path).clip(), "clip", error)) return status;
        if (const bendy_status status = check_finite(from, "from", error)) return status;
        if (const bendy_status status = check_finite(to, "to", error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        bendy_root_motion made_out{};
        if (const bendy_status status = bendy::capi::root_path_between(path, clip, from, to, made_out, error))
            return status;
        *out = made_out;
        return BENDY_OK;
    });
}

bendy_status bendy_root_path_over(const bendy_root_path* path, uint32_t clip, const bendy_played* played,
                                  bendy_root_motion* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(path, "path", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*path).clip(), "clip", error)) return status;
        if (const bendy_status status = check_pointer(played, "played", error)) return status;
        bendy_played taken_played{};
        if (const bendy_status status = take(played, "played", taken_played, error)) return status;
        if (const bendy_status status = check_fields(taken_played, error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        bendy_root_motion made_out{};
        if (const bendy_status status = bendy::capi::root_path_over(path, clip, taken_played, made_out, error))
            return status;
        *out = made_out;
        return BENDY_OK;
    });
}

bendy_status bendy_root_path_extract(const bendy_root_path* path, bendy_pose* pose, bendy_root_motion* out,
                                     bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(path, "path", error)) return status;
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_same_model(pose, *path, "pose", "path", error)) return status;
        bendy_root_motion made_out{};
        if (const bendy_status status = bendy::capi::root_path_extract(path, pose, made_out, error)) return status;
        if (out != nullptr) *out = made_out;
        return BENDY_OK;
    });
}

bendy_status bendy_socket_matrix(bendy_pose* pose, const bendy_socket* socket, const float* world, float* matrix,
                                 bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_pointer(socket, "socket", error)) return status;
        bendy_socket taken_socket = BENDY_SOCKET_INIT;
        if (const bendy_status status = take(socket, "socket", taken_socket, error)) return status;
        if (const bendy_status status = check_fields(taken_socket, error)) return status;
        if (const bendy_status status =
                world == nullptr ? BENDY_OK : check_finite(std::span(world, 16), "world", error))
            return status;
        if (const bendy_status status = check_pointer(matrix, "matrix", error)) return status;
        return bendy::capi::socket_matrix(pose, taken_socket, world, matrix, error);
    });
}

bendy_bounds* bendy_bounds_new(const bendy_model* model, bendy_error* error) {
    bendy_bounds* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        return bendy::capi::bounds_new(model, made, error);
    });
    return made;
}

void bendy_bounds_free(bendy_bounds* bounds) {
    delete bounds;
}

bendy_status bendy_bounds_of_pose(const bendy_bounds* bounds, bendy_pose* pose, bendy_box* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(bounds, "bounds", error)) return status;
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_same_model(pose, *bounds, "pose", "bounds", error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        bendy_box made_out{};
        if (const bendy_status status = bendy::capi::bounds_of_pose(bounds, pose, made_out, error)) return status;
        *out = made_out;
        return BENDY_OK;
    });
}

bendy_status bendy_bounds_of_joint(const bendy_bounds* bounds, bendy_pose* pose, uint32_t joint, bendy_box* out,
                                   bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(bounds, "bounds", error)) return status;
        if (const bendy_status status = check_same_model(pose, *bounds, "pose", "bounds", error)) return status;
        if (const bendy_status status = check_index(joint, parts(*bounds).joint(), "joint", error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        bendy_box made_out{};
        if (const bendy_status status = bendy::capi::bounds_of_joint(bounds, pose, joint, made_out, error))
            return status;
        *out = made_out;
        return BENDY_OK;
    });
}

bendy_binding* bendy_binding_new(const bendy_model* animated, const bendy_model* posed,
                                 const bendy_binding_options* options, bendy_error* error) {
    bendy_binding* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(animated, "animated", error)) return status;
        if (const bendy_status status = check_pointer(posed, "posed", error)) return status;
        bendy_binding_options taken_options = BENDY_BINDING_OPTIONS_INIT;
        if (const bendy_status status = take(options, "options", taken_options, error)) return status;
        if (const bendy_status status = check_fields(taken_options, error)) return status;
        return bendy::capi::binding_new(animated, posed, taken_options, made, error);
    });
    return made;
}

void bendy_binding_free(bendy_binding* binding) {
    delete binding;
}

bendy_status bendy_sample_bound(bendy_pose* pose, bendy_binding* binding, uint32_t clip, float seconds,
                                bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_pointer(binding, "binding", error)) return status;
        if (const bendy_status status = check_same_model(binding, *pose, "binding", "pose", error)) return status;
        if (const bendy_status status = check_index(clip, parts(*binding).clip(), "clip", error)) return status;
        if (const bendy_status status = check_number(seconds, "seconds", error)) return status;
        return bendy::capi::sample_bound(pose, binding, clip, seconds, error);
    });
}

const uint32_t* bendy_binding_unmatched_joints(const bendy_binding* binding, size_t* count, bendy_error* error) {
    const uint32_t* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(binding, "binding", error)) return status;
        if (const bendy_status status = check_pointer(count, "count", error)) return status;
        return bendy::capi::binding_unmatched_joints(binding, count, made, error);
    });
    return made;
}

const uint32_t* bendy_binding_unmatched_targets(const bendy_binding* binding, size_t* count, bendy_error* error) {
    const uint32_t* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(binding, "binding", error)) return status;
        if (const bendy_status status = check_pointer(count, "count", error)) return status;
        return bendy::capi::binding_unmatched_targets(binding, count, made, error);
    });
    return made;
}

bendy_retarget* bendy_retarget_new(const bendy_model* source, const bendy_model* target,
                                   const bendy_retarget_options* options, bendy_error* error) {
    bendy_retarget* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(source, "source", error)) return status;
        if (const bendy_status status = check_pointer(target, "target", error)) return status;
        bendy_retarget_options taken_options = BENDY_RETARGET_OPTIONS_INIT;
        if (const bendy_status status = take(options, "options", taken_options, error)) return status;
        if (const bendy_status status = check_fields(taken_options, error)) return status;
        return bendy::capi::retarget_new(source, target, taken_options, made, error);
    });
    return made;
}

void bendy_retarget_free(bendy_retarget* retarget) {
    delete retarget;
}

bendy_retarget_state* bendy_retarget_state_new(bendy_error* error) {
    bendy_retarget_state* made = nullptr;
    guarded(error, [&]() -> bendy_status { return bendy::capi::retarget_state_new(made, error); });
    return made;
}

void bendy_retarget_state_free(bendy_retarget_state* state) {
    delete state;
}

bendy_status bendy_retarget_state_reset(bendy_retarget_state* state, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(state, "state", error)) return status;
        return bendy::capi::retarget_state_reset(state, error);
    });
}

bendy_status bendy_retarget_pose(bendy_pose* pose, bendy_retarget* retarget, bendy_pose* source,
                                 bendy_retarget_state* state, const float* contacts, float seconds,
                                 bendy_retargeted* result, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_pointer(retarget, "retarget", error)) return status;
        if (const bendy_status status = check_same_model(retarget, *pose, "retarget", "pose", error)) return status;
        if (const bendy_status status = check_pointer(source, "source", error)) return status;
        if (const bendy_status status = check_pointer(state, "state", error)) return status;
        if (const bendy_status status =
                contacts == nullptr ? BENDY_OK : check_finite(std::span(contacts, 14), "contacts", error))
            return status;
        if (const bendy_status status = check_finite(seconds, "seconds", error)) return status;
        if (const bendy_status status = result == nullptr ? BENDY_OK : check_out(result, "result", error))
            return status;
        bendy_retargeted made_result{};
        if (const bendy_status status =
                bendy::capi::retarget_pose(pose, retarget, source, state, contacts, seconds, made_result, error))
            return status;
        if (result != nullptr) put(*result, made_result);
        return BENDY_OK;
    });
}

bendy_lod* bendy_lod_new(const bendy_model* model, bendy_error* error) {
    bendy_lod* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        return bendy::capi::lod_new(model, made, error);
    });
    return made;
}

void bendy_lod_free(bendy_lod* lod) {
    delete lod;
}

bendy_status bendy_lod_set_share(bendy_lod* lod, float share, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(lod, "lod", error)) return status;
        if (const bendy_status status = check_fraction(share, "share", error)) return status;
        return bendy::capi::lod_set_share(lod, share, error);
    });
}

bendy_status bendy_get_lod(const bendy_lod* lod, bendy_lod_info* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(lod, "lod", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_lod_info made_out{};
        if (const bendy_status status = bendy::capi::get_lod(lod, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

const uint32_t* bendy_lod_indices(const bendy_lod* lod, uint32_t mesh, size_t* count, bendy_error* error) {
    const uint32_t* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(lod, "lod", error)) return status;
        if (const bendy_status status = check_index(mesh, parts(*lod).mesh(), "mesh", error)) return status;
        if (const bendy_status status = check_pointer(count, "count", error)) return status;
        return bendy::capi::lod_indices(lod, mesh, count, made, error);
    });
    return made;
}

bendy_status bendy_lod_submesh(const bendy_lod* lod, uint32_t submesh, bendy_submesh* out, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(lod, "lod", error)) return status;
        if (const bendy_status status = check_index(submesh, parts(*lod).submesh(), "submesh", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_submesh made_out{};
        if (const bendy_status status = bendy::capi::lod_submesh(lod, submesh, made_out, error)) return status;
        put(*out, made_out);
        return BENDY_OK;
    });
}

bendy_status bendy_skin(bendy_pose* pose, const bendy_skin_options* options, const bendy_vertices* out,
                        bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        bendy_skin_options taken_options = BENDY_SKIN_OPTIONS_INIT;
        if (const bendy_status status = take(options, "options", taken_options, error)) return status;
        if (const bendy_status status = check_fields(taken_options, error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        bendy_vertices taken_out = BENDY_VERTICES_INIT;
        if (const bendy_status status = take(out, "out", taken_out, error)) return status;
        return bendy::capi::skin(pose, taken_options, taken_out, error);
    });
}

bendy_status bendy_prepare_skin(bendy_pose* pose, uint32_t method, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status =
                check_value(method, BENDY_SKIN_DUAL_QUATERNION + 1, "method", "bendy_skin_method", error))
            return status;
        return bendy::capi::prepare_skin(pose, method, error);
    });
}

bendy_crowd* bendy_crowd_new(const bendy_model* model, uint32_t workers, bendy_error* error) {
    bendy_crowd* made = nullptr;
    guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        return bendy::capi::crowd_new(model, workers, made, error);
    });
    return made;
}

void bendy_crowd_free(bendy_crowd* crowd) {
    delete crowd;
}

bendy_status bendy_crowd_play(bendy_crowd* crowd, const bendy_crowd_member* members, size_t count, uint32_t worker,
                              bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(crowd, "crowd", error)) return status;
        return bendy::capi::crowd_play(crowd, members, count, worker, error);
    });
}

bendy_status bendy_crowd_play_posed(bendy_crowd* crowd, const bendy_crowd_member* members, size_t count,
                                    uint32_t worker, bendy_pose_member pose_member, void* user, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(crowd, "crowd", error)) return status;
        if (const bendy_status status = check_pointer(pose_member, "pose_member", error)) return status;
        if (const bendy_status status = check_pointer(user, "user", error)) return status;
        return bendy::capi::crowd_play_posed(crowd, members, count, worker, pose_member, user, error);
    });
}

bendy_status bendy_set_kernel(const char* name, bendy_error* error) {
    return guarded(error, [&]() -> bendy_status {
        if (const bendy_status status = check_pointer(name, "name", error)) return status;
        return bendy::capi::set_kernel(name, error);
    });
}
