#include <bendy/runtime/crowd.h>

#include <bendy/runtime/local_to_model.h>
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

Crowd::Crowd(const Model& model, std::size_t workers) : model_(&model) {
    workers = std::max<std::size_t>(workers, 1);
    workers_.reserve(workers);
    for (std::size_t worker = 0; worker < workers; ++worker) workers_.emplace_back(model);
    first_entry_.push_back(0);
    for (const Pool& pool : model.pools())
        first_entry_.push_back(first_entry_.back() + (pool.is_rigid() ? 1 : pool.palette.joints.size()));
}

bool Crowd::play(std::span<const CrowdMember> members, std::size_t worker) {
    return play(members, worker,
                [](const CrowdMember& member, Pose& pose) { sample(member.cycle, member.seconds, pose); });
}

bool Crowd::write(const CrowdMember& member, Pose& pose) const {
    bool is_good = true;
    if (is_wanted(member.out)) {
        is_good = member.lod == nullptr ? skin_into(*model_, pose, member.out)
                                        : skin_into(*model_, pose, *member.lod, member.out);
    }
    if (member.palette.empty()) return is_good;
    if (member.palette.size() < palette_size()) return false;
    if (pose.is_stale()) local_to_model(pose);
    write_palette(pose, member.palette);
    return is_good;
}

void Crowd::write_palette(Pose& pose, std::span<PaletteMatrix> palette) const {
    for (std::uint32_t number = 0; number < model_->pools().size(); ++number) {
        const Pool& pool = model_->pools()[number];
        const auto entries = palette.subspan(first_entry_[number], first_entry_[number + 1] - first_entry_[number]);
        if (pool.is_rigid()) {
            const std::uint32_t joint = pool.vertices == 0 ? kNone : model_->rigid_mover(number, 0);
            entries.front() = to_rows(joint == kNone ? glm::mat4(1.0f) : pose.model_space()[joint]);
        } else {
            const auto bones = pose.palette(number);
            std::copy(bones.begin(), bones.end(), entries.begin());
        }
    }
}

}  // namespace bendy
