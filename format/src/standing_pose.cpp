#include <bendy/format/standing_pose.h>

#include <bendy/format/clip.h>
#include <bendy/format/read_record.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace bendy {
namespace {

double square_length(const std::array<float, 3>& v) {
    return double{v[0]} * v[0] + double{v[1]} * v[1] + double{v[2]} * v[2];
}

void check_pose(const StandingPoseRecord& pose, std::uint64_t offset, Faults& faults) {
    check_enum(pose.evidence, kStandingEvidence, offset, faults);
    check_reserved(pose.reserved, offset, faults);
    if (!is_unit(pose.axes, kUnitTolerance)) faults.add({ErrorCode::kRotationNotUnit, offset, 0});
    check_finite(std::array{pose.ground, pose.height}, offset, faults);
    if (pose.height < 0.0f) faults.add({ErrorCode::kBelowZero, offset, offsetof(StandingPoseRecord, height)});
}

/// Reports the first joint of each kind of fault.
void check_rotations(std::span<const StandingRotationRecord> rotations, std::uint32_t joints, std::uint64_t offset,
                     Faults& faults) {
    const auto first = [&](auto is_wrong) { return std::find_if(rotations.begin(), rotations.end(), is_wrong); };
    const auto missing = first([&](const StandingRotationRecord& each) { return each.joint >= joints; });
    if (missing != rotations.end()) faults.add({ErrorCode::kJointRange, offset, missing->joint, joints});
    const auto bent = first([](const StandingRotationRecord& each) {
        return !(square_length(each.rotation) <= 1.0 + 2.0 * kUnitTolerance);  // NaN is wrong, too
    });
    if (bent != rotations.end()) faults.add({ErrorCode::kRotationNotUnit, offset, bent->joint});
    const auto disordered =
        std::adjacent_find(rotations.begin(), rotations.end(),
                           [](const auto& before, const auto& after) { return before.joint >= after.joint; });
    if (disordered != rotations.end())
        faults.add({ErrorCode::kJointOrder, offset, disordered[1].joint, disordered->joint});
}

}  // namespace

std::optional<StandingPoseView> read_standing_pose(const ChunkTree& tree, std::uint32_t object, std::uint32_t joints,
                                                   Faults& faults) {
    const std::size_t faults_before = faults.count();
    const auto pose = read_child_record<StandingPoseRecord>(tree, object, FourCC("STND"), faults);
    if (!pose) return std::nullopt;
    const std::uint32_t number = tree.find(object, FourCC("STND"));
    const std::uint64_t offset = tree[number].offset;
    const Bytes payload = tree.payload(number);
    const std::uint64_t count = (payload.size() - sizeof(StandingPoseRecord)) / sizeof(StandingRotationRecord);
    const std::uint64_t size = sizeof(StandingPoseRecord) + count * sizeof(StandingRotationRecord);
    if (payload.size() != size) faults.add({ErrorCode::kRecordSize, offset, payload.size(), size});
    check_pose(*pose, offset, faults);
    const auto rotations = view_at<StandingRotationRecord>(payload, sizeof(StandingPoseRecord), count);
    check_rotations(rotations, joints, offset, faults);
    if (faults.count() != faults_before) return std::nullopt;
    return StandingPoseView{*pose, rotations};
}

std::array<float, 4> rotation_of(const StandingRotationRecord& record) {
    const std::array<float, 3>& v = record.rotation;
    return {v[0], v[1], v[2], static_cast<float>(std::sqrt(std::max(0.0, 1.0 - square_length(v))))};
}

StandingRotationRecord standing_rotation(std::uint32_t joint, std::array<float, 4> xyzw) {
    const float sign = xyzw[3] < 0.0f ? -1.0f : 1.0f;
    return {joint, {sign * xyzw[0], sign * xyzw[1], sign * xyzw[2]}};
}

std::vector<std::byte> write_standing_pose(const StandingPoseRecord& pose,
                                           std::span<const StandingRotationRecord> rotations) {
    std::vector<std::byte> payload(sizeof pose + rotations.size_bytes());
    std::memcpy(payload.data(), &pose, sizeof pose);
    if (!rotations.empty()) std::memcpy(payload.data() + sizeof pose, rotations.data(), rotations.size_bytes());
    return payload;
}

}  // namespace bendy
