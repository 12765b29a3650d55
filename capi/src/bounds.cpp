// What follows a pose: boxes around it, and things attached to its joints.
#include "fail.h"
#include "handles.h"
#include "lookup.h"
#include "matrices.h"

#include <bendy/runtime/socket.h>

#include <memory>

namespace bendy::capi {
namespace {

bendy_box to_c(const Box& box) {
    return {{box.minimum.x, box.minimum.y, box.minimum.z}, {box.maximum.x, box.maximum.y, box.maximum.z}};
}

bendy_status take_socket(const bendy_socket* socket, std::size_t joints, Socket& taken, bendy_error* error) {
    if (const bendy_status status = check_pointer(socket, "socket", error)) return status;
    bendy_socket values = BENDY_SOCKET_INIT;
    if (const bendy_status status = take(socket, "socket", values, error)) return status;
    if (values.joint != BENDY_NONE) {
        if (const bendy_status status = check_index(values.joint, joints, "joint", error)) return status;
    }
    taken.joint = values.joint;
    taken.offset = glm::make_mat4(values.offset);
    taken.keeps_size = values.keeps_size != 0;
    return BENDY_OK;
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy_socket_matrix(bendy_pose* pose, const bendy_socket* socket, const float* world, float* matrix,
                                 bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        bendy::Socket taken;
        if (const bendy_status status = take_socket(socket, pose->pose.model().joints().size(), taken, error))
            return status;
        if (const bendy_status status = check_pointer(matrix, "matrix", error)) return status;
        const glm::mat4 model_to_world = world == nullptr ? glm::mat4(1.0f) : glm::make_mat4(world);
        put_matrix(*bendy::socket_matrix(pose->pose, taken, model_to_world), matrix);
        return BENDY_OK;
    });
}

bendy_bounds* bendy_bounds_new(const bendy_model* model, bendy_error* error) {
    bendy_bounds* bounds = nullptr;
    guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        bounds = std::make_unique<bendy_bounds>(model->character).release();
        return BENDY_OK;
    });
    return bounds;
}

void bendy_bounds_free(bendy_bounds* bounds) {
    delete bounds;
}

bendy_status bendy_bounds_of_pose(const bendy_bounds* bounds, bendy_pose* pose, bendy_box* out, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(bounds, "bounds", error)) return status;
        if (const bendy_status status = check_pose_of(pose, *bounds->character, "pose", "bounds", error)) return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        *out = to_c(*bounds->bounds.of(pose->pose));
        return BENDY_OK;
    });
}

bendy_status bendy_bounds_of_joint(const bendy_bounds* bounds, bendy_pose* pose, uint32_t joint, bendy_box* out,
                                   bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(bounds, "bounds", error)) return status;
        const bendy::capi::Character& character = *bounds->character;
        if (pose != nullptr) {
            if (const bendy_status status = check_pose_of(pose, character, "pose", "bounds", error)) return status;
        }
        if (const bendy_status status = check_index(joint, character.model.joints().size(), "joint", error))
            return status;
        if (const bendy_status status = check_pointer(out, "out", error)) return status;
        *out = to_c(pose == nullptr ? bounds->bounds.joint(joint) : *bounds->bounds.of(pose->pose, joint));
        return BENDY_OK;
    });
}
