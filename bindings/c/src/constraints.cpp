// Constraints of joints, the joints of IK chains, and the submeshes of joints.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"

#include <bendy/runtime/constrain.h>

#include <algorithm>
#include <array>

namespace bendy::capi {
namespace {

/// Returns the index of one of the model's constraints, BENDY_NONE for null.
std::uint32_t number_of(const Constraint* constraint, const Model& model) {
    return constraint == nullptr ? BENDY_NONE : static_cast<std::uint32_t>(constraint - model.constraints().data());
}

glm::dquat quaternion(const double* R) {
    return {R[3], R[0], R[1], R[2]};
}

template <class Quaternion, class Number>
void put_rotation(const Quaternion& rotation, Number* out) {
    out[0] = rotation.x;
    out[1] = rotation.y;
    out[2] = rotation.z;
    out[3] = rotation.w;
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy::capi::get_constraint(const bendy_model* model, uint32_t constraint, bendy_constraint& out,
                                         bendy_error* /*error*/) {
    const bendy::Constraint& view = model->get().constraints()[constraint];
    to_c(view.record, out);
    out.joint = view.joint;
    return BENDY_OK;
}

uint32_t bendy_joint_constraint(const bendy_model* model, uint32_t joint) {
    if (model == nullptr || joint >= model->get().joints().size()) return BENDY_NONE;
    return number_of(model->get().constraint(joint), model->get());
}

uint32_t bendy_joint_ik_constraint(const bendy_model* model, uint32_t joint) {
    if (model == nullptr || joint >= model->get().joints().size()) return BENDY_NONE;
    return number_of(model->get().ik_constraint(joint), model->get());
}

bendy_status bendy::capi::to_constraint_space(const bendy_model* model, uint32_t constraint, const float* rotation,
                                              double* R, bendy_error* /*error*/) {
    const bendy::Constraint& view = model->get().constraints()[constraint];
    const glm::quat local(rotation[3], rotation[0], rotation[1], rotation[2]);
    put_rotation(bendy::to_constraint_space(view, model->get().joints()[view.joint].rest.rotation, local), R);
    return BENDY_OK;
}

bendy_status bendy::capi::from_constraint_space(const bendy_model* model, uint32_t constraint, const double* R,
                                                float* rotation, bendy_error* /*error*/) {
    const bendy::Constraint& view = model->get().constraints()[constraint];
    const glm::quat& rest = model->get().joints()[view.joint].rest.rotation;
    put_rotation(bendy::from_constraint_space(view, rest, quaternion(R)), rotation);
    return BENDY_OK;
}

bendy_status bendy::capi::clamp_rotation(const bendy_model* model, uint32_t constraint, const double* R,
                                         double* clamped, double* violation, bendy_error* /*error*/) {
    const bendy::Constraint& view = model->get().constraints()[constraint];
    if (clamped != nullptr) put_rotation(bendy::clamp_rotation(view, quaternion(R)), clamped);
    if (violation != nullptr) *violation = bendy::violation(view, quaternion(R));
    return BENDY_OK;
}

bendy_status bendy::capi::clamp_translation(const bendy_model* model, uint32_t constraint, const float* translation,
                                            float* clamped, bendy_error* /*error*/) {
    const bendy::Constraint& view = model->get().constraints()[constraint];
    const glm::vec3 legal = bendy::clamp_translation(view, model->get().joints()[view.joint].rest,
                                                     {translation[0], translation[1], translation[2]});
    for (int c = 0; c < 3; ++c) clamped[c] = legal[c];
    return BENDY_OK;
}

bendy_status bendy::capi::get_links(const bendy_model* model, uint32_t chain, uint32_t* joints, float* weights,
                                    size_t count, bendy_error* error) {
    const auto chains = model->get().chains();
    const bendy::Chain& view = chains[chain];
    if (const bendy_status status = check_room(count, view.links, "joints", error)) return status;
    std::uint32_t joint = view.record.effector;
    for (std::uint32_t k = view.links; k-- > 0; joint = model->get().parents()[joint]) {
        joints[k] = joint;
        if (weights != nullptr) weights[k] = 1.0f;
    }
    if (weights == nullptr) return BENDY_OK;
    for (const bendy::ChainWeightView& weight : model->get().chain_weights(view)) {
        // Ascending: a parent's number is smaller than its children's.
        const auto* const link = std::lower_bound(joints, joints + view.links, weight.joint);
        if (link != joints + view.links && *link == weight.joint) weights[link - joints] = weight.weight;
    }
    return BENDY_OK;
}

const uint32_t* bendy_chain_order(const bendy_model* model) {
    return model == nullptr ? nullptr : first_of(model->get().chain_order());
}

bendy_status bendy::capi::get_joint_submesh(const bendy_model* model, uint32_t joint_submesh, bendy_joint_submesh& out,
                                            bendy_error* /*error*/) {
    const auto submeshes = model->get().joint_submeshes();
    to_c(submeshes[joint_submesh], out);
    return BENDY_OK;
}
