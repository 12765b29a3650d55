#include "ozz_state.h"

#include "peer_timing.h"

#include <ozz/animation/runtime/local_to_model_job.h>
#include <ozz/geometry/runtime/skinning_job.h>

#include <algorithm>
#include <cstdint>

namespace bendy::bench {

OzzState::OzzState(const OzzCharacter& played)
    : character(played),
      context(static_cast<int>(played.joints())),
      locals(played.soa_joints()),
      models(played.joints()) {
    const auto rest = character.skeleton->joint_rest_poses();
    std::copy(rest.begin(), rest.end(), locals.begin());
    for (const OzzPalette& palette : character.palettes) palettes.emplace_back(palette.joints.size());
}

void OzzState::sample(const ozz::animation::Animation& animation, float seconds) {
    ozz::animation::SamplingJob job;
    job.animation = &animation;
    job.context = &context;
    job.ratio = seconds / animation.duration();
    job.output = ozz::make_span(locals);
    check(job.Run(), "ozz's SamplingJob");
}

void OzzState::local_to_model(int from) {
    ozz::animation::LocalToModelJob job;
    job.skeleton = character.skeleton.get();
    job.input = ozz::make_span(locals);
    job.output = ozz::make_span(models);
    job.from = from;
    check(job.Run(), "ozz's LocalToModelJob");
}

void OzzState::make_palettes() {
    for (std::size_t number = 0; number < palettes.size(); ++number) make_palette(number, palettes[number].data());
}

void OzzState::make_palette(std::size_t number, ozz::math::Float4x4* to) const {
    const OzzPalette& palette = character.palettes[number];
    for (std::size_t entry = 0; entry < palette.joints.size(); ++entry)
        to[entry] = models[palette.joints[entry]] * palette.inverse_bind[entry];
}

void OzzState::skin(int attributes, float* positions, float* normals, float* tangents) const {
    for (const OzzMesh& mesh : character.meshes) {
        for (const OzzPart& part : mesh.parts) {
            ozz::geometry::SkinningJob job;
            job.vertex_count = static_cast<int>(part.size());
            job.influences_count = static_cast<int>(part.influences);
            job.joint_matrices = ozz::make_span(palettes[mesh.palette]);
            job.joint_indices = ozz::make_span(part.joints);
            job.joint_indices_stride = sizeof(std::uint16_t) * part.influences;
            if (part.influences > 1) {
                job.joint_weights = ozz::make_span(part.weights);
                job.joint_weights_stride = sizeof(float) * (part.influences - 1);
            }
            const std::size_t numbers = 3 * part.size();
            const auto give = [&](const std::vector<float>& from, float*& to, auto& in, auto& in_stride, auto& out,
                                  auto& out_stride) {
                in = ozz::make_span(from);
                out = {to, numbers};
                in_stride = out_stride = 3 * sizeof(float);
                to += numbers;
            };
            give(part.positions, positions, job.in_positions, job.in_positions_stride, job.out_positions,
                 job.out_positions_stride);
            if (attributes > 1) {
                give(part.normals, normals, job.in_normals, job.in_normals_stride, job.out_normals,
                     job.out_normals_stride);
            }
            if (attributes > 2) {
                give(part.tangents, tangents, job.in_tangents, job.in_tangents_stride, job.out_tangents,
                     job.out_tangents_stride);
            }
            check(job.Run(), "ozz's SkinningJob");
        }
    }
}

}  // namespace bendy::bench
