// Making poses, and changing them: clips, blending, local transforms and weights.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"
#include "matrices.h"

#include <bendy/runtime/blend.h>
#include <bendy/runtime/sample.h>

#include <algorithm>

namespace bendy::capi {
namespace {

/// One number per joint; empty for NULL.
bendy_status take_mask(const bendy_pose* pose, const float* mask, std::span<const float>& taken, bendy_error* error) {
    if (mask != nullptr) taken = {mask, parts(*pose).joint()};
    return check_finite(taken, "mask", error);
}

/// Checks a range of a pose's numbers, and the caller's memory for them.
bendy_status check_part(std::uint32_t first, std::uint32_t count, std::size_t all, const char* kind, const void* memory,
                        const char* name, bendy_error* error) {
    if (const bendy_status status = check_range(first, count, all, kind, error)) return status;
    return count == 0 ? BENDY_OK : check_pointer(memory, name, error);
}

}  // namespace

}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy::capi::pose_new(const bendy_model* model, bendy_pose*& made, bendy_error* /*error*/) {
    made = std::make_unique<bendy_pose>(model->character).release();
    return BENDY_OK;
}

bendy_status bendy::capi::pose_copy(const bendy_pose* pose, bendy_pose*& made, bendy_error* /*error*/) {
    made = std::make_unique<bendy_pose>(pose->character, pose->pose).release();
    return BENDY_OK;
}

bendy_status bendy::capi::stand(bendy_pose* pose, bendy_error* /*error*/) {
    (void)bendy::stand(pose->pose);
    return BENDY_OK;
}

bendy_status bendy::capi::set_rest(bendy_pose* pose, bendy_error* /*error*/) {
    pose->pose.set_rest();
    return BENDY_OK;
}

bendy_status bendy::capi::sample(bendy_pose* pose, uint32_t clip, float seconds, bendy_error* error) {
    const auto clips = pose->pose.model().clips();
    return from_call(bendy::sample(pose->pose, &clips[clip], seconds), error);
}

bendy_status bendy::capi::blend(bendy_pose* pose, const bendy_pose* other, float weight, const float* mask,
                                bendy_error* error) {
    std::span<const float> taken;
    if (const bendy_status status = take_mask(pose, mask, taken, error)) return status;
    return from_call(bendy::blend(pose->pose, other->pose, weight, taken), error);
}

bendy_status bendy::capi::make_additive(bendy_pose* pose, const bendy_pose* reference, bendy_error* error) {
    return from_call(bendy::make_additive(pose->pose, reference->pose), error);
}

bendy_status bendy::capi::add(bendy_pose* pose, const bendy_pose* difference, float weight, const float* mask,
                              bendy_error* error) {
    std::span<const float> taken;
    if (const bendy_status status = take_mask(pose, mask, taken, error)) return status;
    return from_call(bendy::add(pose->pose, difference->pose, weight, taken), error);
}

bendy_status bendy::capi::mask_below(const bendy_model* model, uint32_t joint, float inside, float outside, float* mask,
                                     size_t count, bendy_error* error) {
    const std::size_t joints = parts(*model).joint();
    if (const bendy_status status = check_room(count, joints, "mask", error)) return status;
    const std::vector<float> numbers = bendy::mask_below(model->get(), joint, inside, outside);
    std::copy(numbers.begin(), numbers.end(), mask);
    return BENDY_OK;
}

bendy_status bendy::capi::get_local(const bendy_pose* pose, uint32_t first, uint32_t count, bendy_transform* transforms,
                                    bendy_error* error) {
    const std::size_t joints = parts(*pose).joint();
    if (const bendy_status status = check_part(first, count, joints, "joint", transforms, "transforms", error))
        return status;
    for (std::uint32_t k = 0; k < count; ++k) to_c(pose->pose.local(first + k), transforms[k]);
    return BENDY_OK;
}

bendy_status bendy::capi::set_local(bendy_pose* pose, uint32_t first, uint32_t count, const bendy_transform* transforms,
                                    bendy_error* error) {
    const std::size_t joints = parts(*pose).joint();
    if (const bendy_status status = check_part(first, count, joints, "joint", transforms, "transforms", error))
        return status;
    for (const bendy_transform& transform : std::span(transforms, count)) {
        if (const bendy_status status = check_fields(transform, error)) return status;
    }
    for (std::uint32_t k = 0; k < count; ++k) {
        JointTransform local;
        from_c(transforms[k], local);
        pose->pose.set_local(first + k, local);
    }
    return BENDY_OK;
}

bendy_status bendy::capi::get_weights(const bendy_pose* pose, uint32_t first, uint32_t count, float* weights,
                                      bendy_error* error) {
    const auto all = pose->pose.morph_weights();
    if (const bendy_status status = check_part(first, count, all.size(), "target", weights, "weights", error))
        return status;
    std::copy_n(all.begin() + first, count, weights);
    return BENDY_OK;
}

bendy_status bendy::capi::set_weights(bendy_pose* pose, uint32_t first, uint32_t count, const float* weights,
                                      bendy_error* error) {
    const auto all = pose->pose.change_morph_weights();
    if (const bendy_status status = check_part(first, count, all.size(), "target", weights, "weights", error))
        return status;
    if (const bendy_status status = check_finite(std::span(weights, count), "weights", error)) return status;
    std::copy_n(weights, count, all.begin() + first);
    return BENDY_OK;
}

bendy_status bendy::capi::transform_matrix(const bendy_transform& transform, const float* shear, float* matrix,
                                           bendy_error* /*error*/) {
    JointTransform local;
    from_c(transform, local);
    const glm::vec3 sheared = shear == nullptr ? glm::vec3(0.0f) : glm::vec3(shear[0], shear[1], shear[2]);
    put_matrix(glm::mat4(bendy::to_matrix(local, sheared)), matrix);
    return BENDY_OK;
}
