// Boxes around a pose, and sockets on its joints.
#include "calls.h"
#include "fail.h"
#include "fields.h"
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

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy::capi::socket_matrix(bendy_pose* pose, const bendy_socket& socket, const float* world, float* matrix,
                                        bendy_error* error) {
    if (socket.joint != BENDY_NONE) {
        if (const bendy_status status = check_index(socket.joint, parts(*pose).joint(), "joint", error)) return status;
    }
    bendy::Socket taken;
    from_c(socket, taken);
    const glm::mat4 model_to_world = world == nullptr ? glm::mat4(1.0f) : glm::make_mat4(world);
    put_matrix(*bendy::socket_matrix(pose->pose, taken, model_to_world), matrix);
    return BENDY_OK;
}

bendy_status bendy::capi::bounds_new(const bendy_model* model, bendy_bounds*& made, bendy_error* /*error*/) {
    made = std::make_unique<bendy_bounds>(model->character).release();
    return BENDY_OK;
}

bendy_status bendy::capi::bounds_of_pose(const bendy_bounds* bounds, bendy_pose* pose, bendy_box& out,
                                         bendy_error* /*error*/) {
    out = to_c(*bounds->bounds.of(pose->pose));
    return BENDY_OK;
}

bendy_status bendy::capi::bounds_of_joint(const bendy_bounds* bounds, bendy_pose* pose, uint32_t joint, bendy_box& out,
                                          bendy_error* /*error*/) {
    out = to_c(pose == nullptr ? bounds->bounds.joint(joint) : *bounds->bounds.of(pose->pose, joint));
    return BENDY_OK;
}
