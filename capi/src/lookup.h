#pragma once

#include "fail.h"
#include "handles.h"

#include <cmath>
#include <string>
#include <vector>

// Finding what a call is about: the items of a model by their numbers.
namespace bendy::capi {

using NameList = std::vector<std::string> Names::*;

inline std::uint32_t count_of(const bendy_model* model, NameList list) {
    return model == nullptr ? 0 : static_cast<std::uint32_t>((model->character->names.*list).size());
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

template <class Out>
void put_json(const Json& json, Out& out) {
    out.extras = json.extras.c_str();
    out.more = json.more.c_str();
}

inline bendy_status check_mesh(const bendy_model* model, std::uint32_t mesh, bendy_error* error) {
    if (const bendy_status status = check_pointer(model, "model", error)) return status;
    return check_index(mesh, model->get().meshes().size(), "mesh", error);
}

/// Checks that a mesh has bones.
inline bendy_status check_skinned(const Mesh& mesh, std::uint32_t number, bendy_error* error) {
    if (!mesh.is_rigid()) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, "mesh " + std::to_string(number) + " is rigid: it has no bones");
}

inline bendy_status check_clip(const bendy_model* model, std::uint32_t clip, bendy_error* error) {
    if (const bendy_status status = check_pointer(model, "model", error)) return status;
    return check_index(clip, model->get().clips().size(), "clip", error);
}

/// Checks that a pose, which is called `name`, is one of the character that `what` belongs to.
inline bendy_status check_pose_of(const bendy_pose* pose, const Character& character, const char* name,
                                  const char* what, bendy_error* error) {
    if (const bendy_status status = check_pointer(pose, name, error)) return status;
    if (pose->character.get() == &character) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + " is a pose of another model than " + what);
}

inline bendy_status check_clip_of(const Character& character, std::uint32_t clip, bendy_error* error) {
    return check_index(clip, character.model.clips().size(), "clip", error);
}

/// Checks that a time is a number.
inline bendy_status check_seconds(float seconds, bendy_error* error) {
    return std::isnan(seconds) ? fail(error, BENDY_BAD_ARGUMENT, "seconds is not a number") : BENDY_OK;
}

/// Checks a clip, and the number of one of its `things`: a member of Clip.
template <class Things>
bendy_status check_in_clip(const bendy_model* model, std::uint32_t clip, Things Clip::*things, std::uint32_t number,
                           const char* kind, bendy_error* error) {
    if (const bendy_status status = check_clip(model, clip, error)) return status;
    return check_index(number, (model->get().clips()[clip].*things).size(), kind, error, "the clip");
}

template <class Things>
std::uint32_t count_in_clip(const bendy_model* model, std::uint32_t clip, Things Clip::*things) {
    if (model == nullptr || clip >= model->get().clips().size()) return 0;
    return static_cast<std::uint32_t>((model->get().clips()[clip].*things).size());
}

}  // namespace bendy::capi
