// Root motion: what a clip moves the character by.
#include "fail.h"
#include "handles.h"
#include "lookup.h"
#include "matrices.h"
#include "played.h"

#include <memory>

namespace bendy::capi {
namespace {

bendy_root_motion to_c(const RootMotion& motion) {
    return {{motion.translation.x, motion.translation.y, motion.translation.z},
            {motion.rotation.x, motion.rotation.y, motion.rotation.z, motion.rotation.w}};
}

bendy_status take_motion(const bendy_root_motion* motion, const char* name, RootMotion& taken, bendy_error* error) {
    if (const bendy_status status = check_pointer(motion, name, error)) return status;
    if (const bendy_status status = check_finite(motion->translation, name, error)) return status;
    if (const bendy_status status = check_rotation(motion->rotation, error)) return status;
    taken.translation = {motion->translation[0], motion->translation[1], motion->translation[2]};
    taken.rotation = glm::dquat(motion->rotation[3], motion->rotation[0], motion->rotation[1], motion->rotation[2]);
    return BENDY_OK;
}

bendy_status take_axes(const bendy_root_axes* axes, RootAxes& taken, bendy_error* error) {
    bendy_root_axes values = BENDY_ROOT_AXES_INIT;
    if (const bendy_status status = take(axes, "axes", values, error)) return status;
    if (const bendy_status status = check_value(values.turn, BENDY_TURN_ALL + 1, "turn", error)) return status;
    taken = {values.x != 0, values.y != 0, values.z != 0, static_cast<RootTurn>(values.turn)};
    return BENDY_OK;
}

bendy_status check_path(const bendy_root_path* path, std::uint32_t clip, const bendy_root_motion* out,
                        bendy_error* error) {
    if (const bendy_status status = check_pointer(path, "path", error)) return status;
    if (const bendy_status status = check_clip_of(*path->character, clip, error)) return status;
    return check_pointer(out, "out", error);
}

const Clip& clip_of(const bendy_root_path* path, std::uint32_t clip) {
    return path->character->model.clips()[clip];
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy_root_motion_matrix(const bendy_root_motion* motion, double* matrix, bendy_error* error) {
    return guarded(error, [&] {
        bendy::RootMotion taken;
        if (const bendy_status status = take_motion(motion, "motion", taken, error)) return status;
        if (const bendy_status status = check_pointer(matrix, "matrix", error)) return status;
        const glm::dmat4 made = taken.matrix();
        std::copy_n(glm::value_ptr(made), kMatrixNumbers, matrix);
        return BENDY_OK;
    });
}

bendy_status bendy_root_motion_compose(const bendy_root_motion* before, const bendy_root_motion* motion,
                                       bendy_root_motion* out, bendy_error* error) {
    return guarded(error, [&] {
        bendy::RootMotion first;
        bendy::RootMotion second;
        if (const bendy_status status = take_motion(before, "before", first, error)) return status;
        if (const bendy_status status = take_motion(motion, "motion", second, error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        *out = to_c(bendy::compose(first, second));
        return BENDY_OK;
    });
}

bendy_status bendy_root_motion_inverse(const bendy_root_motion* motion, bendy_root_motion* out, bendy_error* error) {
    return guarded(error, [&] {
        bendy::RootMotion taken;
        if (const bendy_status status = take_motion(motion, "motion", taken, error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        *out = to_c(bendy::inverse(taken));
        return BENDY_OK;
    });
}

bendy_status bendy_root_motion_blend(const bendy_root_motion* motion, const bendy_root_motion* other, double weight,
                                     bendy_root_motion* out, bendy_error* error) {
    return guarded(error, [&] {
        bendy::RootMotion first;
        bendy::RootMotion second;
        if (const bendy_status status = take_motion(motion, "motion", first, error)) return status;
        if (const bendy_status status = take_motion(other, "other", second, error)) return status;
        if (const bendy_status status = check_double(weight, "weight", error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        *out = to_c(bendy::blend(first, second, weight));
        return BENDY_OK;
    });
}

bendy_status bendy_root_motion_repeat(const bendy_root_motion* motion, uint64_t times, bendy_root_motion* out,
                                      bendy_error* error) {
    return guarded(error, [&] {
        bendy::RootMotion taken;
        if (const bendy_status status = take_motion(motion, "motion", taken, error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        *out = to_c(bendy::repeat(taken, times));
        return BENDY_OK;
    });
}

bendy_root_path* bendy_root_path_new(const bendy_model* model, uint32_t joint, const bendy_root_axes* axes,
                                     bendy_error* error) {
    bendy_root_path* path = nullptr;
    guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        if (const bendy_status status = check_index(joint, model->get().joints().size(), "joint", error)) return status;
        bendy::RootAxes taken;
        if (const bendy_status status = take_axes(axes, taken, error)) return status;
        path = std::make_unique<bendy_root_path>(model->character, joint, taken).release();
        return BENDY_OK;
    });
    return path;
}

void bendy_root_path_free(bendy_root_path* path) {
    delete path;
}

bendy_status bendy_root_path_at(const bendy_root_path* path, uint32_t clip, double seconds, bendy_root_motion* out,
                                bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_path(path, clip, out, error)) return status;
        if (const bendy_status status = check_double(seconds, "seconds", error)) return status;
        *out = to_c(*path->path.at(clip_of(path, clip), seconds));
        return BENDY_OK;
    });
}

bendy_status bendy_root_path_between(const bendy_root_path* path, uint32_t clip, double from, double to,
                                     bendy_root_motion* out, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_path(path, clip, out, error)) return status;
        if (const bendy_status status = check_double(from, "from", error)) return status;
        if (const bendy_status status = check_double(to, "to", error)) return status;
        *out = to_c(*path->path.between(clip_of(path, clip), from, to));
        return BENDY_OK;
    });
}

bendy_status bendy_root_path_over(const bendy_root_path* path, uint32_t clip, const bendy_played* played,
                                  bendy_root_motion* out, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_path(path, clip, out, error)) return status;
        bendy::PlayedInterval taken;
        if (const bendy_status status = take_played(played, taken, error)) return status;
        *out = to_c(*path->path.over(clip_of(path, clip), taken));
        return BENDY_OK;
    });
}

bendy_status bendy_root_path_extract(const bendy_root_path* path, bendy_pose* pose, bendy_root_motion* out,
                                     bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(path, "path", error)) return status;
        if (const bendy_status status = check_pose_of(pose, *path->character, "pose", "path", error)) return status;
        const bendy::RootMotion motion = *path->path.extract(pose->pose);
        if (out != nullptr) *out = to_c(motion);
        return BENDY_OK;
    });
}
