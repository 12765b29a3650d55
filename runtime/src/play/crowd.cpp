#include <bendy/runtime/crowd.h>

#include <bendy/runtime/sample.h>
#include <bendy/runtime/skin.h>

#include "plan/palette_rows.h"

#include <algorithm>

namespace bendy {
namespace {

bool is_wanted(const VertexBuffer& out) {
    return !out.positions.floats.empty() || !out.normals.floats.empty() || !out.tangents.floats.empty();
}

}  // namespace

Crowd::Crowd(const Model& model, std::size_t workers) : model_(model) {
    workers = std::max<std::size_t>(workers, 1);
    poses_.reserve(workers);
    for (std::size_t worker = 0; worker < workers; ++worker) poses_.emplace_back(model);
    first_entry_.push_back(0);
    for (const Mesh& mesh : model.meshes())
        first_entry_.push_back(first_entry_.back() + (mesh.is_rigid() ? 1 : mesh.palette.joints.size()));
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
    for (std::uint32_t number = 0; number < meshes.size(); ++number) {
        const Mesh& mesh = meshes[number];
        const auto entries = palette.subspan(first_entry_[number], first_entry_[number + 1] - first_entry_[number]);
        if (mesh.is_rigid()) {
            const std::uint32_t joint = mesh.vertices == 0 ? kNone : model_.rigid_mover(number, 0);
            entries.front() = to_rows(joint == kNone ? glm::mat4(1.0f) : pose.model_space()[joint]);
        } else {
            const auto bones = pose.palette(number);
            std::copy(bones.begin(), bones.end(), entries.begin());
        }
    }
}

}  // namespace bendy
