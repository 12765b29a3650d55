#include <bendy/runtime/crowd.h>

#include <bendy/runtime/sample.h>
#include <bendy/runtime/skin.h>

#include "kernels/flush_denormals.h"
#include "kernels/kernel_table.h"
#include "model/model_data.h"
#include "plan/layout.h"
#include "plan/pose_plan.h"
#include "pose/pose_state.h"

#include <algorithm>
#include <utility>

namespace bendy {
namespace {

static_assert(Crowd::kAtOnce == PosesBlock::kPoses);

bool is_wanted(const VertexBuffer& out) {
    return !out.positions.floats.empty() || !out.normals.floats.empty() || !out.tangents.floats.empty();
}

std::size_t entries_of(const Mesh& mesh) {
    return mesh.is_rigid() ? 1 : mesh.palette.joints.size();
}

/// Returns the joint that moves a rigid mesh's first vertex; kNone if there is none.
std::uint32_t mover_of(const Model& model, std::uint32_t mesh) {
    return model.meshes()[mesh].vertices == 0 ? kNone : model.rigid_mover(mesh, 0);
}

/// Calls write(number, mesh, first entry) for each mesh that does not share an earlier one's matrices.
template <class Write>
void each_palette(const Model& model, std::span<const std::size_t> first_entry, const Write& write) {
    std::size_t end = 0;
    for (std::uint32_t number = 0; number < model.meshes().size(); ++number) {
        const Mesh& mesh = model.meshes()[number];
        if (first_entry[number] < end) continue;
        write(number, mesh, first_entry[number]);
        end = first_entry[number] + entries_of(mesh);
    }
}

}  // namespace

Crowd::Crowd(const Model& model, std::size_t workers) : model_(model) {
    workers = std::max<std::size_t>(workers, 1);
    poses_.reserve(workers);
    for (std::size_t worker = 0; worker < workers; ++worker) poses_.emplace_back(model);
    const PosePlan& plan = *ModelData::of(model).pose_plan;
    batches_.resize(workers);
    if (plan.fits_floats) {
        locals_.assign(workers * kAtOnce, plan.rest);
        model_space_.resize(workers * model.joints().size());
    }
    std::size_t entries = 0;
    for (std::uint32_t number = 0; number < model.meshes().size(); ++number) {
        const Mesh& mesh = model.meshes()[number];
        const std::uint32_t same = plan.same_palette[number];
        const bool is_shared = same != number && !mesh.is_rigid();
        first_entry_.push_back(is_shared ? first_entry_[same] : entries);
        if (!is_shared) entries += entries_of(mesh);
    }
    first_entry_.push_back(entries);
}

Result<void, CallError> Crowd::play(std::span<const CrowdMember> members, std::size_t worker) {
    return play_each(members, worker, [](const CrowdMember& member, Pose& pose) -> Result<void, CallError> {
        if (member.clip != nullptr) return sample(pose, member.clip, member.seconds);
        pose.set_rest();
        return {};
    });
}

Result<void, CallError> Crowd::write(const CrowdMember& member, std::size_t worker) {
    Pose& pose = poses_[worker];
    if (member.lod != nullptr && member.lod->model() != model_) return CallError::other_model;
    Result<void, CallError> result;
    const bool is_skinned = is_wanted(member.out);
    if (is_skinned) result = skin(pose, {.lod = member.lod, .out = member.out});
    if (member.palette.empty()) return result;
    if (member.palette.size() < palette_size()) return CallError::output_too_short;
    Batch& batch = batches_[worker];
    if (is_skinned || model_space_.empty()) {
        write_palette(pose, member.palette.data());
        return result;
    }
    PoseState& state = PoseState::of(pose);
    state.stale.mark_all();
    state.local.swap(locals_[worker * kAtOnce + batch.count]);
    batch.palettes[batch.count++] = member.palette.data();
    if (batch.count == kAtOnce) write_batch(worker);
    return result;
}

void Crowd::write_batch(std::size_t worker) {
    constexpr std::size_t kFew = 2;  // faster one by one
    Batch& batch = batches_[worker];
    const std::size_t count = std::exchange(batch.count, 0);
    if (count <= kFew) {
        for (std::size_t k = 0; k < count; ++k) {
            PoseState& state = PoseState::of(poses_[worker]);
            state.stale.mark_all();
            state.local.swap(locals_[worker * kAtOnce + k]);
            write_palette(poses_[worker], batch.palettes[k]);
        }
        return;
    }
    const ModelData& data = ModelData::of(model_);
    float* const matrices = model_space_[worker * data.joints.size()].numbers.data();
    PosesBlock block{data.joints.size(), {}, data.parents.data(), matrices};
    for (std::size_t k = 0; k < kAtOnce; ++k) {
        const std::size_t member = std::min(k, count - 1);  // the last one fills the lanes that are left
        block.local[k] = &locals_[worker * kAtOnce + member].front().rotation[0][0];
        batch.palettes[k] = batch.palettes[member];
    }
    const KernelTable& kernels = kernel_table();
    const FlushDenormals flush(kernels.flushes_denormals);
    kernels.poses(block);
    each_palette(model_, first_entry_, [&](std::uint32_t number, const Mesh& mesh, std::size_t first) {
        PalettesBlock palettes{1, matrices, nullptr, nullptr, {}};
        for (std::size_t k = 0; k < kAtOnce; ++k) palettes.palette[k] = batch.palettes[k] + first;
        const std::uint32_t mover = mesh.is_rigid() ? mover_of(model_, number) : kNone;
        if (!mesh.is_rigid()) {
            palettes.entries = mesh.palette.joints.size();
            palettes.joints = mesh.palette.joints.data();
            palettes.inverse_bind = data.pose_plan->inverse_bind[number].data();
        } else if (mover != kNone) {
            palettes.joints = &mover;
        } else {
            for (PaletteMatrix* const palette : palettes.palette) *palette = to_rows(glm::mat4(1.0f));
            return;
        }
        kernels.palettes(palettes);
    });
}

void Crowd::write_palette(Pose& pose, PaletteMatrix* palette) const {
    PoseState& state = PoseState::of(pose);
    state.refresh();
    each_palette(model_, first_entry_, [&](std::uint32_t number, const Mesh& mesh, std::size_t first) {
        if (!mesh.is_rigid()) return state.write_palette(number, {palette + first, entries_of(mesh)});
        const std::uint32_t mover = mover_of(model_, number);
        palette[first] = to_rows(mover == kNone ? glm::mat4(1.0f) : state.model_space[mover].matrix);
    });
}

}  // namespace bendy
