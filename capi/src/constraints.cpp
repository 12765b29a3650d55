// Constraints of joints, the joints of IK chains, and the submeshes of joints.
#include "fail.h"
#include "handles.h"
#include "lookup.h"

#include <bendy/runtime/constrain.h>

#include <algorithm>
#include <array>

namespace bendy::capi {
namespace {

bendy_status check_constraint(const bendy_model* model, std::uint32_t constraint, bendy_error* error) {
    if (const bendy_status status = check_pointer(model, "model", error)) return status;
    return check_index(constraint, model->get().constraints().size(), "constraint", error);
}

template <std::size_t Size>
void copy(const std::array<float, Size>& from, float (&to)[Size]) {
    std::copy(from.begin(), from.end(), to);
}

/// Returns the number of one of the model's constraints, BENDY_NONE for null.
std::uint32_t number_of(const Constraint* constraint, const Model& model) {
    return constraint == nullptr ? BENDY_NONE : static_cast<std::uint32_t>(constraint - model.constraints().data());
}

/// Checks R, a unit quaternion, and takes it.
bendy_status take_rotation(const double* numbers, glm::dquat& R, bendy_error* error) {
    if (const bendy_status status = check_pointer(numbers, "R", error)) return status;
    if (const bendy_status status = check_rotation(numbers, error)) return status;
    R = glm::dquat(numbers[3], numbers[0], numbers[1], numbers[2]);
    return BENDY_OK;
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

uint32_t bendy_constraint_count(const bendy_model* model) {
    return model == nullptr ? 0 : static_cast<uint32_t>(model->get().constraints().size());
}

bendy_status bendy_get_constraint(const bendy_model* model, uint32_t constraint, bendy_constraint* out,
                                  bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_constraint(model, constraint, error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        const bendy::Constraint& view = model->get().constraints()[constraint];
        bendy_constraint value{};
        value.joint = view.joint;
        value.model = view.record.model;
        value.euler_order = view.record.euler_order;
        value.scope = view.record.scope;
        value.flags = view.record.flags;
        value.soft_zone = view.record.soft_zone;
        copy(view.record.frame, value.frame);
        copy(view.record.rotation_min, value.rotation_min);
        copy(view.record.rotation_max, value.rotation_max);
        copy(view.record.translation_min, value.translation_min);
        copy(view.record.translation_max, value.translation_max);
        copy(view.record.stiffness, value.stiffness);
        copy(view.record.preferred, value.preferred);
        put(*out, value);
        return BENDY_OK;
    });
}

uint32_t bendy_joint_constraint(const bendy_model* model, uint32_t joint) {
    if (model == nullptr || joint >= model->get().joints().size()) return BENDY_NONE;
    return number_of(model->get().constraint(joint), model->get());
}

uint32_t bendy_joint_ik_constraint(const bendy_model* model, uint32_t joint) {
    if (model == nullptr || joint >= model->get().joints().size()) return BENDY_NONE;
    return number_of(model->get().ik_constraint(joint), model->get());
}

bendy_status bendy_to_constraint_space(const bendy_model* model, uint32_t constraint, const float* rotation, double* R,
                                       bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_constraint(model, constraint, error)) return status;
        if (const bendy_status status = check_pointer(rotation, "rotation", error)) return status;
        if (const bendy_status status = check_rotation(rotation, error)) return status;
        if (const bendy_status status = check_pointer(R, "R", error)) return status;
        const bendy::Constraint& view = model->get().constraints()[constraint];
        const glm::quat local(rotation[3], rotation[0], rotation[1], rotation[2]);
        put_rotation(bendy::to_constraint_space(view, model->get().joints()[view.joint].rest.rotation, local), R);
        return BENDY_OK;
    });
}

bendy_status bendy_from_constraint_space(const bendy_model* model, uint32_t constraint, const double* R,
                                         float* rotation, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_constraint(model, constraint, error)) return status;
        glm::dquat taken;
        if (const bendy_status status = take_rotation(R, taken, error)) return status;
        if (const bendy_status status = check_pointer(rotation, "rotation", error)) return status;
        const bendy::Constraint& view = model->get().constraints()[constraint];
        const glm::quat& rest = model->get().joints()[view.joint].rest.rotation;
        put_rotation(bendy::from_constraint_space(view, rest, taken), rotation);
        return BENDY_OK;
    });
}

bendy_status bendy_clamp_rotation(const bendy_model* model, uint32_t constraint, const double* R, double* clamped,
                                  double* violation, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_constraint(model, constraint, error)) return status;
        glm::dquat taken;
        if (const bendy_status status = take_rotation(R, taken, error)) return status;
        const bendy::Constraint& view = model->get().constraints()[constraint];
        if (clamped != nullptr) put_rotation(bendy::clamp_rotation(view, taken), clamped);
        if (violation != nullptr) *violation = bendy::violation(view, taken);
        return BENDY_OK;
    });
}

bendy_status bendy_clamp_translation(const bendy_model* model, uint32_t constraint, const float* translation,
                                     float* clamped, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_constraint(model, constraint, error)) return status;
        if (const bendy_status status = check_pointer(translation, "translation", error)) return status;
        if (const bendy_status status = check_finite(std::span(translation, 3), "translation", error)) return status;
        if (const bendy_status status = check_pointer(clamped, "clamped", error)) return status;
        const bendy::Constraint& view = model->get().constraints()[constraint];
        const glm::vec3 legal = bendy::clamp_translation(view, model->get().joints()[view.joint].rest,
                                                         {translation[0], translation[1], translation[2]});
        for (int c = 0; c < 3; ++c) clamped[c] = legal[c];
        return BENDY_OK;
    });
}

bendy_status bendy_get_links(const bendy_model* model, uint32_t chain, uint32_t* joints, float* weights, size_t count,
                             bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        const auto chains = model->get().chains();
        if (const bendy_status status = check_index(chain, chains.size(), "chain", error)) return status;
        const bendy::Chain& view = chains[chain];
        if (const bendy_status status = check_pointer(joints, "joints", error)) return status;
        if (const bendy_status status = check_room(count, view.links, "joints", error)) return status;
        std::uint32_t joint = view.effector;
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
    });
}

const uint32_t* bendy_chain_order(const bendy_model* model) {
    return model == nullptr || model->get().chain_order().empty() ? nullptr : model->get().chain_order().data();
}

uint32_t bendy_joint_submesh_count(const bendy_model* model) {
    return model == nullptr ? 0 : static_cast<uint32_t>(model->get().joint_submeshes().size());
}

bendy_status bendy_get_joint_submesh(const bendy_model* model, uint32_t submesh, bendy_joint_submesh* out,
                                     bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        const auto submeshes = model->get().joint_submeshes();
        if (const bendy_status status = check_index(submesh, submeshes.size(), "submesh", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        const bendy::SubmeshView& view = submeshes[submesh];
        put(*out, {0, view.joint, view.mesh, view.material, static_cast<std::uint32_t>(view.topology), view.first,
                   view.count});
        return BENDY_OK;
    });
}
