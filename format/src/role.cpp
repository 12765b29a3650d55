#include <bendy/format/role.h>

#include <bendy/format/read_record.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace bendy {
namespace {

void check_record(const RoleRecord& record, std::uint32_t joints, std::uint64_t offset, Faults& faults) {
    if (record.role == 0 || record.role >= kRoles) {
        faults.add({ErrorCode::kEnumRange, offset, record.role, kRoles});
    } else if (record.joint >= joints) {
        faults.add({ErrorCode::kJointRange, offset, record.joint, joints});
    } else if (record.place != 0 && record.role < static_cast<unsigned>(kFirstChainRole)) {
        faults.add({ErrorCode::kRolePlace, offset, record.joint, record.place});
    }
}

void check_order(std::span<const RoleRecord> roles, std::uint64_t offset, Faults& faults) {
    for (std::size_t k = 1; k < roles.size(); ++k) {
        if (roles[k - 1].joint >= roles[k].joint)
            faults.add({ErrorCode::kJointOrder, offset, roles[k].joint, roles[k - 1].joint});
    }
}

void check_repeated(std::span<const RoleRecord> roles, std::uint64_t offset, Faults& faults) {
    std::vector<std::uint64_t> sorted;  // role and place, then joint
    sorted.reserve(roles.size());
    for (const RoleRecord& record : roles)
        sorted.push_back(std::uint64_t{record.role} << 48 | std::uint64_t{record.place} << 32 | record.joint);
    std::sort(sorted.begin(), sorted.end());
    const auto joint = [&](std::size_t k) { return static_cast<std::uint32_t>(sorted[k]); };
    for (std::size_t k = 1; k < sorted.size(); ++k) {
        if (sorted[k - 1] >> 32 == sorted[k] >> 32)
            faults.add({ErrorCode::kRoleRepeated, offset, joint(k), joint(k - 1)});
    }
}

}  // namespace

std::span<const RoleRecord> read_roles(const ChunkTree& tree, std::uint32_t object, std::uint32_t joints,
                                       Faults& faults) {
    const std::uint32_t number = tree.find(object, FourCC("ROLE"));
    if (number == kNone || tree[number].is_container()) return {};
    const std::uint64_t offset = tree[number].offset;
    if (const auto fault = tree.encoding_fault(number)) {
        faults.add(*fault);
        return {};
    }
    const Bytes payload = tree.payload(number);
    const std::uint64_t count = payload.size() / sizeof(RoleRecord);
    if (payload.size() % sizeof(RoleRecord) != 0) {
        faults.add({ErrorCode::kRecordSize, offset, payload.size(), count * sizeof(RoleRecord)});
        return {};
    }
    const std::span<const RoleRecord> roles = view_at<RoleRecord>(payload, 0, count);
    const std::size_t faults_before = faults.count();
    for (const RoleRecord& record : roles) check_record(record, joints, offset, faults);
    if (faults.count() == faults_before) {
        check_order(roles, offset, faults);
        check_repeated(roles, offset, faults);
    }
    return faults.count() == faults_before ? roles : std::span<const RoleRecord>();
}

const RoleRecord* role_of(std::span<const RoleRecord> roles, std::uint32_t joint) {
    const auto record = std::partition_point(roles.begin(), roles.end(),
                                             [joint](const RoleRecord& other) { return other.joint < joint; });
    return record == roles.end() || record->joint != joint ? nullptr : &*record;
}

std::string role_text(const RoleRecord& record) {
    std::string text(kValueNames<Role>[record.role]);
    if (record.role >= static_cast<unsigned>(kFirstChainRole)) text += ' ' + std::to_string(record.place);
    return text;
}

}  // namespace bendy
