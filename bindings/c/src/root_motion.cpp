// Root motion: how a clip moves the character.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"
#include "matrices.h"

#include <memory>

namespace bendy::capi {
namespace {

RootMotion motion_of(const bendy_root_motion& from) {
    RootMotion motion;
    from_c(from, motion);
    return motion;
}

const Clip& clip_of(const bendy_root_path* path, std::uint32_t clip) {
    return path->character->model.clips()[clip];
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy::capi::root_motion_matrix(const bendy_root_motion& motion, double* matrix, bendy_error* /*error*/) {
    const glm::dmat4 made = motion_of(motion).matrix();
    std::copy_n(glm::value_ptr(made), kMatrixNumbers, matrix);
    return BENDY_OK;
}

bendy_status bendy::capi::root_motion_compose(const bendy_root_motion& before, const bendy_root_motion& motion,
                                              bendy_root_motion& out, bendy_error* /*error*/) {
    to_c(bendy::compose(motion_of(before), motion_of(motion)), out);
    return BENDY_OK;
}

bendy_status bendy::capi::root_motion_inverse(const bendy_root_motion& motion, bendy_root_motion& out,
                                              bendy_error* /*error*/) {
    to_c(bendy::inverse(motion_of(motion)), out);
    return BENDY_OK;
}

bendy_status bendy::capi::root_motion_blend(const bendy_root_motion& motion, const bendy_root_motion& other,
                                            double weight, bendy_root_motion& out, bendy_error* /*error*/) {
    to_c(bendy::blend(motion_of(motion), motion_of(other), weight), out);
    return BENDY_OK;
}

bendy_status bendy::capi::root_motion_repeat(const bendy_root_motion& motion, uint64_t times, bendy_root_motion& out,
                                             bendy_error* /*error*/) {
    to_c(bendy::repeat(motion_of(motion), times), out);
    return BENDY_OK;
}

bendy_status bendy::capi::root_path_new(const bendy_model* model, uint32_t joint, const bendy_root_axes& axes,
                                        bendy_root_path*& made, bendy_error* /*error*/) {
    bendy::RootAxes taken;
    from_c(axes, taken);
    made = std::make_unique<bendy_root_path>(model->character, joint, taken).release();
    return BENDY_OK;
}

bendy_status bendy::capi::root_path_at(const bendy_root_path* path, uint32_t clip, double seconds,
                                       bendy_root_motion& out, bendy_error* /*error*/) {
    to_c(*path->path.at(clip_of(path, clip), seconds), out);
    return BENDY_OK;
}

bendy_status bendy::capi::root_path_between(const bendy_root_path* path, uint32_t clip, double from, double to,
                                            bendy_root_motion& out, bendy_error* /*error*/) {
    to_c(*path->path.between(clip_of(path, clip), from, to), out);
    return BENDY_OK;
}

bendy_status bendy::capi::root_path_over(const bendy_root_path* path, uint32_t clip, const bendy_played& played,
                                         bendy_root_motion& out, bendy_error* /*error*/) {
    bendy::PlayedInterval taken;
    from_c(played, taken);
    to_c(*path->path.over(clip_of(path, clip), taken), out);
    return BENDY_OK;
}

bendy_status bendy::capi::root_path_extract(const bendy_root_path* path, bendy_pose* pose, bendy_root_motion& out,
                                            bendy_error* /*error*/) {
    to_c(*path->path.extract(pose->pose), out);
    return BENDY_OK;
}
