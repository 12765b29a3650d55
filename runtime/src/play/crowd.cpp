#include <bendy/runtime/crowd.h>

#include <bendy/runtime/sample.h>
#include <bendy/runtime/skin.h>

#include "model/model_data.h"
#include "plan/palette_rows.h"
#include "plan/pose_plan.h"
#include "pose/pose_state.h"

#include <algorithm>

namespace bendy {
namespace {

bool is_wanted(const VertexBuffer& out) {
    return !out.positions.floats.empty() || !out.normals.floats.empty() || !out.tangents.floats.empty();
}

std::size_t entries_of(const Mesh& mesh) {
    return mesh.is_rigid() ? 1 : mesh.palette.joints.size();
}

}  // namespace

Crowd::Crowd(const Model& model, std::size_t workers) : model_(model) {
    workers = std::max<std::size_t>(workers, 1);
    poses_.reserve(workers);
    for (std::size_t worker = 0; worker < workers; ++worker) poses_.emplace_back(model);
    const PosePlan& plan = *ModelData::of(model).pose_plan;
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
    return play(members, worker, [](const CrowdMember& member, Pose& pose) {
        (void)sample(pose, member.clip, member.seconds);  // without a clip: the rest pose
    });
}

Result<void, CallError> Crowd::write(const CrowdMember& member, Pose& pose) const {
    Result<void, CallError> result;
    if (is_wanted(member.out)) result = skin(pose, {.lod = member.lod, .out = member.out});
    if (member.palette.empty()) return result;
    if (member.palette.size() < palette_size()) return CallError::output_too_short;
    write_palette(pose, member.palette);
    return result;
}

void Crowd::write_palette(Pose& pose, std::span<PaletteMatrix> palette) const {
    const std::span<const Mesh> meshes = model_.meshes();
    PoseState& state = PoseState::of(pose);
    state.refresh();
    std::size_t written = 0;
    for (std::uint32_t number = 0; number < meshes.size(); ++number) {
        if (first_entry_[number] < written) continue;  // a palette of an earlier mesh
        const Mesh& mesh = meshes[number];
        const auto entries = palette.subspan(written, entries_of(mesh));
        written += entries.size();
        if (mesh.is_rigid()) {
            const std::uint32_t joint = mesh.vertices == 0 ? kNone : model_.rigid_mover(number, 0);
            entries.front() = to_rows(joint == kNone ? glm::mat4(1.0f) : state.model_space[joint].matrix);
        } else {
            state.write_palette(number, entries);
        }
    }
}

}  // namespace bendy
