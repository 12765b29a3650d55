#include <bendy/format/role.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace bendy::role_test {
namespace {

using namespace test;

constexpr std::uint16_t kHips = static_cast<std::uint16_t>(Role::hips);
constexpr std::uint16_t kTail = static_cast<std::uint16_t>(Role::tail);
constexpr std::uint16_t kLastBone = static_cast<std::uint16_t>(Role::right_little_distal);

/// The sample, whose object has four joints, with this payload.
Node with_payload(Bytes payload) {
    Node root = sample();
    at(root, "HEAD/OBJE").children.push_back(make_leaf(FourCC("ROLE"), payload));
    return root;
}

Lines faults_with(const std::vector<RoleRecord>& roles) {
    return faults_in(with_payload(bytes_of_all(roles)));
}

Lines one_fault(const std::string& code) {
    return {code + " HEAD/OBJE/ROLE"};
}

TEST(Roles, AreReadInPlace) {
    const std::vector<RoleRecord> roles{{0, kHips, 0}, {2, kTail, 7}, {3, kTail, 4}};
    const Loaded loaded(to_file(with_payload(bytes_of_all(roles))));
    ASSERT_EQ(loaded.lines(), Lines{});
    const std::span<const RoleRecord> read = loaded.document.objects.at(0).roles;
    ASSERT_EQ(read.size(), 3u);
    for (std::size_t k = 0; k < read.size(); ++k) {
        EXPECT_EQ(read[k].joint, roles[k].joint);
        EXPECT_EQ(read[k].role, roles[k].role);
        EXPECT_EQ(read[k].place, roles[k].place);
    }
    const auto* const first = reinterpret_cast<const std::byte*>(read.data());
    EXPECT_EQ(first, loaded.tree.payload(loaded.tree.find(loaded.document.objects.at(0).chunk, FourCC("ROLE"))).data());
}

TEST(Roles, MayBeNone) {
    EXPECT_EQ(faults_with({}), Lines{});
    const Loaded loaded(sample_file());
    EXPECT_TRUE(loaded.document.objects.at(0).roles.empty());
}

TEST(Roles, AreTheBonesOfVrmAndChainsAfterThem) {
    EXPECT_EQ(kLastBone, 55);
    EXPECT_EQ(static_cast<unsigned>(kFirstChainRole), 56u);
    EXPECT_EQ(kRoles, 65u);
    EXPECT_EQ(kValueNames<Role>[18], "left_shoulder");
    EXPECT_EQ(kValueNames<Role>[kLastBone], "right_little_distal");
}

TEST(Roles, RefuseAPayloadOfAnotherSize) {
    const std::vector<RoleRecord> roles{{0, kHips, 0}, {1, kTail, 0}};
    for (const std::size_t size : {1u, 7u, 9u, 15u})
        EXPECT_EQ(faults_in(with_payload(bytes_of_all(roles).first(size))), one_fault("RECORD_SIZE")) << size;
}

TEST(Roles, RefuseJointsAndRolesThatDoNotExist) {
    EXPECT_EQ(faults_with({{4, kHips, 0}}), one_fault("JOINT_RANGE"));
    EXPECT_EQ(faults_with({{kNone, kHips, 0}}), one_fault("JOINT_RANGE"));
    EXPECT_EQ(faults_with({{0, 0, 0}}), one_fault("ENUM_RANGE"));
    EXPECT_EQ(faults_with({{0, kRoles, 0}}), one_fault("ENUM_RANGE"));
    EXPECT_EQ(faults_with({{0, kRoles - 1, 0}}), Lines{});
    EXPECT_EQ(faults_with({{0, 0, 0}, {9, kHips, 0}}),
              (Lines{"ENUM_RANGE HEAD/OBJE/ROLE", "JOINT_RANGE HEAD/OBJE/ROLE"}));
}

TEST(Roles, HavePlacesInChainsOnly) {
    EXPECT_EQ(faults_with({{0, kLastBone, 1}}), one_fault("ROLE_PLACE"));
    EXPECT_EQ(faults_with({{0, kLastBone + 1, 1}}), Lines{});
}

TEST(Roles, AscendByJoint) {
    EXPECT_EQ(faults_with({{1, kHips, 0}, {0, kTail, 0}}), one_fault("JOINT_ORDER"));
    EXPECT_EQ(faults_with({{1, kHips, 0}, {1, kTail, 0}}), one_fault("JOINT_ORDER"));
}

TEST(Roles, AreGivenOnce) {
    EXPECT_EQ(faults_with({{0, kHips, 0}, {1, kTail, 0}, {3, kHips, 0}}), one_fault("ROLE_REPEATED"));
    EXPECT_EQ(faults_with({{0, kTail, 5}, {1, kTail, 6}, {3, kTail, 5}}), one_fault("ROLE_REPEATED"));
}

}  // namespace
}  // namespace bendy::role_test
