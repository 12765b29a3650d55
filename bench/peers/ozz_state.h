#pragma once

#include "ozz_character.h"

#include <ozz/animation/runtime/sampling_job.h>
#include <ozz/base/maths/soa_transform.h>

#include <cstddef>
#include <vector>

namespace bendy::bench {

/// The working memory of one ozz character, and its jobs.
struct OzzState {
    explicit OzzState(const OzzCharacter& played);

    const OzzCharacter& character;
    ozz::animation::SamplingJob::Context context;
    std::vector<ozz::math::SoaTransform> locals;  ///< at first the rest pose
    std::vector<ozz::math::Float4x4> models;
    std::vector<std::vector<ozz::math::Float4x4>> palettes;

    void sample(const ozz::animation::Animation& animation, float seconds);
    /// \param from  only the joint and its descendants
    void local_to_model(int from = ozz::animation::Skeleton::kNoParent);
    void make_palettes();
    void make_palette(std::size_t number, ozz::math::Float4x4* to) const;
    /// Writes all parts of all meshes, one after another.
    /// \param attributes  1: positions, 2: and normals, 3: and tangents
    void skin(int attributes, float* positions, float* normals, float* tangents) const;
};

}  // namespace bendy::bench
