// Making poses, and changing them: clips, blending, local transforms and weights.
#include "fail.h"
#include "handles.h"
#include "lookup.h"
#include "matrices.h"

#include <bendy/runtime/blend.h>
#include <bendy/runtime/sample.h>

#include <algorithm>

namespace bendy::capi {
namespace {

JointTransform from_c(const bendy_transform& from) {
    return {glm::quat(from.rotation[3], from.rotation[0], from.rotation[1], from.rotation[2]),
            {from.translation[0], from.translation[1], from.translation[2]},
            {from.scale[0], from.scale[1], from.scale[2]}};
}

/// Whether two poses can be put together.
bendy_status check_poses(const bendy_pose* pose, const bendy_pose* other, const char* name, bendy_error* error) {
    if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
    if (const bendy_status status = check_pointer(other, name, error)) return status;
    if (pose->character == other->character) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + " is a pose of another model");
}

/// The joints' numbers; none for NULL.
std::span<const float> mask_of(const bendy_pose* pose, const float* mask) {
    return mask == nullptr ? std::span<const float>() : std::span(mask, pose->pose.model().joints().size());
}

/// Of a range of a pose's numbers and the caller's memory for them.
bendy_status check_part(std::uint32_t first, std::uint32_t count, std::size_t all, const char* kind, const void* memory,
                        const char* name, bendy_error* error) {
    if (const bendy_status status = check_range(first, count, all, kind, error)) return status;
    return count == 0 ? BENDY_OK : check_pointer(memory, name, error);
}

bendy_status check_transforms(std::span<const bendy_transform> transforms, bendy_error* error) {
    for (const bendy_transform& transform : transforms) {
        if (const bendy_status status = check_rotation(transform.rotation, error)) return status;
        if (const bendy_status status = check_finite(transform.translation, "translation", error)) return status;
        if (const bendy_status status = check_finite(transform.scale, "scale", error)) return status;
    }
    return BENDY_OK;
}

}  // namespace

}  // namespace bendy::capi

using namespace bendy::capi;

bendy_pose* bendy_pose_new(const bendy_model* model, bendy_error* error) {
    bendy_pose* pose = nullptr;
    guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        pose = std::make_unique<bendy_pose>(model->character).release();
        return BENDY_OK;
    });
    return pose;
}

bendy_pose* bendy_pose_copy(const bendy_pose* pose, bendy_error* error) {
    bendy_pose* copy = nullptr;
    guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        copy = std::make_unique<bendy_pose>(pose->character, pose->pose).release();
        return BENDY_OK;
    });
    return copy;
}

void bendy_pose_free(bendy_pose* pose) {
    delete pose;
}

bendy_status bendy_set_rest(bendy_pose* pose, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        pose->pose.set_rest();
        return BENDY_OK;
    });
}

bendy_status bendy_sample(bendy_pose* pose, uint32_t clip, float seconds, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        const auto clips = pose->pose.model().clips();
        if (const bendy_status status = check_index(clip, clips.size(), "clip", error)) return status;
        if (const bendy_status status = check_seconds(seconds, error)) return status;
        return from_call(bendy::sample(pose->pose, &clips[clip], seconds), error);
    });
}

bendy_status bendy_blend(bendy_pose* pose, const bendy_pose* other, float weight, const float* mask,
                         bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_poses(pose, other, "other", error)) return status;
        if (const bendy_status status = check_finite({&weight, 1}, "weight", error)) return status;
        if (const bendy_status status = check_finite(mask_of(pose, mask), "mask", error)) return status;
        return from_call(bendy::blend(pose->pose, other->pose, weight, mask_of(pose, mask)), error);
    });
}

bendy_status bendy_make_additive(bendy_pose* pose, const bendy_pose* reference, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_poses(pose, reference, "reference", error)) return status;
        return from_call(bendy::make_additive(pose->pose, reference->pose), error);
    });
}

bendy_status bendy_add(bendy_pose* pose, const bendy_pose* difference, float weight, const float* mask,
                       bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_poses(pose, difference, "difference", error)) return status;
        if (const bendy_status status = check_finite({&weight, 1}, "weight", error)) return status;
        if (const bendy_status status = check_finite(mask_of(pose, mask), "mask", error)) return status;
        return from_call(bendy::add(pose->pose, difference->pose, weight, mask_of(pose, mask)), error);
    });
}

bendy_status bendy_mask_below(const bendy_model* model, uint32_t joint, float inside, float outside, float* mask,
                              size_t count, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        const std::size_t joints = model->get().joints().size();
        if (const bendy_status status = check_index(joint, joints, "joint", error)) return status;
        if (const bendy_status status = check_pointer(mask, "mask", error)) return status;
        if (const bendy_status status = check_room(count, joints, "mask", error)) return status;
        const std::vector<float> made = bendy::mask_below(model->get(), joint, inside, outside);
        std::copy(made.begin(), made.end(), mask);
        return BENDY_OK;
    });
}

bendy_status bendy_get_local(const bendy_pose* pose, uint32_t first, uint32_t count, bendy_transform* transforms,
                             bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        const std::size_t joints = pose->pose.model().joints().size();
        if (const bendy_status status = check_part(first, count, joints, "joint", transforms, "transforms", error))
            return status;
        for (std::uint32_t k = 0; k < count; ++k) transforms[k] = to_c(pose->pose.local(first + k));
        return BENDY_OK;
    });
}

bendy_status bendy_set_local(bendy_pose* pose, uint32_t first, uint32_t count, const bendy_transform* transforms,
                             bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        const std::size_t joints = pose->pose.model().joints().size();
        if (const bendy_status status = check_part(first, count, joints, "joint", transforms, "transforms", error))
            return status;
        if (count == 0) return BENDY_OK;
        if (const bendy_status status = check_transforms({transforms, count}, error)) return status;
        for (std::uint32_t k = 0; k < count; ++k) pose->pose.set_local(first + k, from_c(transforms[k]));
        return BENDY_OK;
    });
}

bendy_status bendy_get_weights(const bendy_pose* pose, uint32_t first, uint32_t count, float* weights,
                               bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        const auto all = pose->pose.morph_weights();
        if (const bendy_status status = check_part(first, count, all.size(), "target", weights, "weights", error))
            return status;
        std::copy_n(all.begin() + first, count, weights);
        return BENDY_OK;
    });
}

bendy_status bendy_set_weights(bendy_pose* pose, uint32_t first, uint32_t count, const float* weights,
                               bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        const auto all = pose->pose.change_morph_weights();
        if (const bendy_status status = check_part(first, count, all.size(), "target", weights, "weights", error))
            return status;
        if (count == 0) return BENDY_OK;
        if (const bendy_status status = check_finite({weights, count}, "weights", error)) return status;
        std::copy_n(weights, count, all.begin() + first);
        return BENDY_OK;
    });
}

bendy_status bendy_transform_matrix(const bendy_transform* transform, const float* shear, float* matrix,
                                    bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(transform, "transform", error)) return status;
        if (const bendy_status status = check_transforms({transform, 1}, error)) return status;
        if (const bendy_status status = check_pointer(matrix, "matrix", error)) return status;
        const glm::vec3 taken = shear == nullptr ? glm::vec3(0.0f) : glm::vec3(shear[0], shear[1], shear[2]);
        if (const bendy_status status = check_finite(std::span(&taken.x, 3), "shear", error)) return status;
        put_matrix(glm::mat4(bendy::to_matrix(from_c(*transform), taken)), matrix);
        return BENDY_OK;
    });
}
