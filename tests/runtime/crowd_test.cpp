#include <bendy/runtime.h>

#include "format/sample_file.h"
#include "runtime/build_model.h"
#include "runtime/local_joints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <thread>
#include <vector>

namespace bendy::crowd_test {
namespace {

constexpr std::size_t kFloats = 10;  // a vertex: position, normal, tangent, interleaved

/// Members of all kinds, and the memory that they write.
class Players {
public:
    Players(const Model& model, std::size_t count, const Lod* lod)
        : vertices_(count * model.vertex_count() * kFloats, -7.0f), members_(count) {
        const std::size_t each = model.vertex_count() * kFloats;
        palettes_.resize(count * Crowd(model).palette_size());
        for (std::size_t k = 0; k < count; ++k) {
            CrowdMember& member = members_[k];
            if (k % 5 != 4) member.clip = model.clip("run");
            member.seconds = 0.45f + 0.01f * static_cast<float>(k);
            if (k % 3 == 2) member.lod = lod;
            const std::span<float> own = std::span(vertices_).subspan(k * each, each);
            member.out = {{own, kFloats}, {own.subspan(3), kFloats}, {own.subspan(6), kFloats}};
            if (k % 7 == 6) member.out = {};
            if (k % 4 == 1) {
                const std::size_t entries = palettes_.size() / count;
                member.palette = std::span(palettes_).subspan(k * entries, entries);
            }
        }
    }

    [[nodiscard]] std::span<CrowdMember> members() { return members_; }
    [[nodiscard]] std::span<const float> vertices(std::size_t member) const {
        const std::size_t each = vertices_.size() / members_.size();
        return std::span(vertices_).subspan(member * each, each);
    }
    [[nodiscard]] bool operator==(const Players& other) const {
        return std::memcmp(vertices_.data(), other.vertices_.data(), vertices_.size() * sizeof(float)) == 0 &&
               std::memcmp(palettes_.data(), other.palettes_.data(), palettes_.size() * sizeof(PaletteMatrix)) == 0;
    }

private:
    std::vector<float> vertices_;
    std::vector<PaletteMatrix> palettes_;
    std::vector<CrowdMember> members_;
};

/// A thread mesh as a caller might have: each thread takes the next `grain` members until there are none.
void play_on_threads(Crowd& crowd, std::span<const CrowdMember> members, std::size_t grain) {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> is_good{true};
    std::vector<std::thread> threads;
    for (std::size_t worker = 0; worker < crowd.workers(); ++worker) {
        threads.emplace_back([&, worker] {
            for (;;) {
                const std::size_t first = next.fetch_add(grain);
                if (first >= members.size()) return;
                if (!crowd.play(members.subspan(first, std::min(grain, members.size() - first)), worker))
                    is_good = false;
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_TRUE(is_good);
}

TEST(Crowd, AMemberComesOutAsACharacterAlone) {
    const test::Owned model(test::sample_file());
    Lod lod(*model);
    lod.set_share(0.3f);
    constexpr std::size_t kMembers = 21;
    Players players(*model, kMembers, &lod);
    Crowd crowd(*model);
    ASSERT_TRUE(crowd.play(players.members()));
    for (std::size_t k = 0; k < kMembers; ++k) {
        const CrowdMember& member = players.members()[k];
        Pose pose(*model);
        (void)sample(pose, member.clip, member.seconds);
        std::vector<float> alone(model->vertex_count() * kFloats, -7.0f);
        const std::span<float> own(alone);
        const VertexBuffer out{{own, kFloats}, {own.subspan(3), kFloats}, {own.subspan(6), kFloats}};
        if (k % 7 == 6) {
            // Nothing was asked for.
        } else if (member.lod != nullptr) {
            ASSERT_TRUE(skin(pose, {.lod = &lod, .out = out}));
        } else {
            ASSERT_TRUE(skin(pose, {.out = out}));
        }
        EXPECT_EQ(std::memcmp(players.vertices(k).data(), alone.data(), alone.size() * sizeof(float)), 0) << k;
    }
}

TEST(Crowd, NeitherWorkersNorSplittingChangeWhatComesOut) {
    const test::Owned model(test::sample_file());
    const Lod lod(*model);
    constexpr std::size_t kMembers = 60;
    Players expected(*model, kMembers, &lod);
    Crowd alone(*model);
    ASSERT_TRUE(alone.play(expected.members()));
    for (const std::size_t workers : {1u, 2u, 3u, 4u}) {
        for (const std::size_t grain : {1u, 7u, 100u}) {
            Players players(*model, kMembers, &lod);
            Crowd crowd(*model, workers);
            for (int frame = 0; frame < 3; ++frame) play_on_threads(crowd, players.members(), grain);
            EXPECT_TRUE(players == expected) << workers << " workers, " << grain << " at a time";
        }
    }
}

TEST(Crowd, PalettesPlaceVerticesAsSkinningDoes) {
    const test::Owned model(test::sample_file());
    Crowd crowd(*model, 2);
    std::vector<PaletteMatrix> palette(crowd.palette_size());
    std::vector<glm::vec3> positions(model->vertex_count());
    CrowdMember member;
    member.clip = model->clip("run");
    member.seconds = 0.8f;
    member.palette = palette;
    ASSERT_TRUE(crowd.play({&member, 1}, 1));
    Pose pose(*model);
    (void)sample(pose, member.clip, member.seconds);
    std::size_t entries = 0;
    for (std::uint32_t number = 0; number < model->meshes().size(); ++number) {
        const Mesh& mesh = model->meshes()[number];
        EXPECT_EQ(crowd.first_entry(number), entries);
        const std::size_t count = mesh.is_rigid() ? 1 : mesh.palette.joints.size();
        for (std::size_t entry = 0; entry < count; ++entry) {
            const glm::mat4 expected =
                mesh.is_rigid() ? pose.model_space()[model->rigid_mover(number, 0)]
                                : pose.model_space()[mesh.palette.joints[entry]] * mesh.palette.inverse_bind()[entry];
            for (int row = 0; row < 3; ++row) {
                for (int column = 0; column < 4; ++column)
                    EXPECT_NEAR(palette[entries + entry].rows[row][column], expected[column][row], 1e-6);
            }
        }
        entries += count;
    }
    EXPECT_EQ(entries, palette.size());
    EXPECT_GT(entries, 1u);
}

/// Meshes of one vertex that follow two joints: the first two and the last with the same bind palette, the others with
/// the same joints or the same matrices only, and a rigid one in between.
test::ModelSpec with_equal_palettes() {
    const glm::mat4 one(1.0f);
    glm::mat4 two(1.0f);
    two[3] = {1.0f, 2.0f, 3.0f, 1.0f};
    test::ModelSpec spec;
    spec.joints.resize(2);
    spec.joints[1].parent = 0;
    spec.joints[1].rest.translation[1] = 8.0f;
    const auto add = [&](const test::Node& palette) {
        test::MeshSpec& mesh = spec.meshes.emplace_back();
        mesh.positions = {{1.0f, 2.0f, 3.0f}};
        mesh.more = {test::make_leaf(FourCC("BONE"), test::stream_payload<std::uint8_t>(1, {1})),
                     test::make_leaf(FourCC("WGHT"), test::stream_payload<float>(1, {1.0f})), palette};
    };
    add(test::palette_leaf({0, 1}, {one, two}));
    add(test::palette_leaf({0, 1}, {one, two}));
    add(test::palette_leaf({0, 1}, {two, one}));
    add(test::palette_leaf({1, 0}, {two, one}));
    test::MeshSpec& rigid = spec.meshes.emplace_back();
    rigid.joint = 1;
    rigid.positions = {{1.0f, 2.0f, 3.0f}};
    add(test::palette_leaf({1, 0}, {two, one}));
    add(test::palette_leaf({0, 1}, {one, two}));
    return spec;
}

TEST(Crowd, NeighboursWithTheSameBindPaletteShareTheirMatrices) {
    const Kernel before = kernel();
    const test::Owned model(test::build_file(with_equal_palettes()));
    for (const Kernel each : kernels()) {
        ASSERT_TRUE(set_kernel(each));
        SCOPED_TRACE(kernel_name(each));
        Crowd crowd(*model);
        EXPECT_EQ(crowd.first_entry(0), 0u);
        EXPECT_EQ(crowd.first_entry(1), 0u);
        EXPECT_EQ(crowd.first_entry(2), 2u);
        EXPECT_EQ(crowd.first_entry(3), 4u);
        EXPECT_EQ(crowd.first_entry(4), 6u);
        std::vector<PaletteMatrix> palette(crowd.palette_size());
        CrowdMember member;
        member.palette = palette;
        ASSERT_TRUE(crowd.play({&member, 1}));
        Pose pose(*model);
        for (std::uint32_t mesh = 0; mesh < model->meshes().size(); ++mesh) {
            const std::span<const PaletteMatrix> expected = pose.palette(mesh);
            for (std::size_t entry = 0; entry < expected.size(); ++entry) {
                EXPECT_EQ(
                    std::memcmp(&palette[crowd.first_entry(mesh) + entry], &expected[entry], sizeof expected[entry]), 0)
                    << "mesh " << mesh << ", entry " << entry;
            }
        }
        EXPECT_EQ(palette[crowd.first_entry(4)].rows[1][3], 8.0f);
    }
    EXPECT_TRUE(set_kernel(before));
}

/// 21 joints and two meshes: one that all of them move, and a rigid one.
/// \param far  metres from the origin to the first joint; so many that joint matrices need doubles
test::ModelSpec with_many_joints(float far) {
    test::ModelSpec spec;
    std::vector<std::uint32_t> joints(21);
    std::vector<glm::mat4> inverse_bind(joints.size(), glm::mat4(1.0f));
    for (std::uint32_t k = 0; k < joints.size(); ++k) {
        joints[k] = k;
        test::JointSpec joint;
        joint.parent = k == 0 ? kNone : k - 1 - (k % 5 == 4 ? 1 : 0);
        joint.rest.translation[1] = k == 0 ? far : 0.1f;
        spec.joints.push_back(joint);
        inverse_bind[k][3] = {0.3f, -0.1f * static_cast<float>(k) - far, 0.2f, 1.0f};
    }
    test::MeshSpec& skinned = spec.meshes.emplace_back();
    skinned.positions = {{1.0f, 2.0f, 3.0f}};
    skinned.more = {test::make_leaf(FourCC("BONE"), test::stream_payload<std::uint8_t>(1, {1})),
                    test::make_leaf(FourCC("WGHT"), test::stream_payload<float>(1, {1.0f})),
                    test::palette_leaf(joints, inverse_bind)};
    test::MeshSpec& rigid = spec.meshes.emplace_back();
    rigid.joint = 20;
    rigid.positions = {{1.0f, 2.0f, 3.0f}};
    return spec;
}

/// A pose that no other number gives.
void pose_by_number(float number, Pose& pose) {
    pose.set_rest();
    for (std::uint32_t joint = 0; joint < 21; ++joint) {
        const float angle = number + 0.3f * static_cast<float>(joint);
        test::local_of(pose, joint)->rotation = glm::angleAxis(angle, glm::normalize(glm::vec3(1.0f, angle, 0.5f)));
    }
}

TEST(Crowd, PalettesOfAnyNumberOfMembersAreThoseOfPosesAlone) {
    const Kernel before = kernel();
    for (const float far : {0.0f, 1e6f}) {
        const test::Owned model(test::build_file(with_many_joints(far)));
        Crowd crowd(*model);
        ASSERT_EQ(crowd.palette_size(), 22u);
        for (const Kernel each : kernels()) {
            ASSERT_TRUE(set_kernel(each));
            for (const std::size_t count : {1u, 2u, 3u, 7u, 8u, 9u, 11u, 24u}) {
                SCOPED_TRACE(testing::Message() << kernel_name(each) << ", " << count << " members, " << far);
                std::vector<PaletteMatrix> palettes(count * crowd.palette_size());
                std::vector<CrowdMember> members(count);
                for (std::size_t k = 0; k < count; ++k) {
                    members[k].seconds = static_cast<float>(k);
                    members[k].palette = std::span(palettes).subspan(k * crowd.palette_size(), crowd.palette_size());
                }
                const auto set = [](const CrowdMember& member, Pose& pose) { pose_by_number(member.seconds, pose); };
                ASSERT_TRUE(crowd.play(members, 0, set));
                Pose pose(*model);
                for (const CrowdMember& member : members) {
                    pose_by_number(member.seconds, pose);
                    const std::span<const PaletteMatrix> expected = pose.palette(0);
                    ASSERT_EQ(expected.size(), 21u);
                    EXPECT_EQ(std::memcmp(member.palette.data(), expected.data(), expected.size_bytes()), 0)
                        << "member " << member.seconds;
                    const glm::mat4 last = pose.model_space()[20];
                    EXPECT_EQ(member.palette[21].rows[2][1], last[1][2]) << "member " << member.seconds;
                }
            }
        }
    }
    EXPECT_TRUE(set_kernel(before));
}

TEST(Crowd, TheCallerMayPose) {
    const test::Owned model(test::sample_file());
    Crowd crowd(*model);
    std::vector<glm::vec3> positions(model->vertex_count());
    CrowdMember member;
    member.seconds = 0.7f;
    member.out.positions = {{&positions.front().x, positions.size() * 3}, 3};
    const auto lift = [&](const CrowdMember& of, Pose& pose) {
        EXPECT_TRUE(sample(pose, model->clip("run"), of.seconds));
        test::local_of(pose, 0)->translation.y += 2.0f;
    };
    ASSERT_TRUE(crowd.play({&member, 1}, 0, lift));
    Pose pose(*model);
    lift(member, pose);
    std::vector<glm::vec3> expected(model->vertex_count());
    ASSERT_TRUE(skin(pose, {.out = {.positions = expected}}));
    EXPECT_EQ(positions, expected);
}

TEST(Crowd, TooLittleMemoryIsLeftAloneAndAllElseIsWritten) {
    const test::Owned model(test::sample_file());
    Crowd crowd(*model, 0);
    EXPECT_EQ(crowd.workers(), 1u);
    EXPECT_TRUE(crowd.play({}));
    const std::size_t numbers = model->vertex_count() * 3;
    std::vector<float> first(numbers - 1, -7.0f), second(numbers, -7.0f);
    std::vector<PaletteMatrix> palette(crowd.palette_size() - 1, PaletteMatrix{{{-7.0f}}, {}});
    std::vector<CrowdMember> members(3);
    members[0].out.positions = {first, 3};
    members[1].palette = palette;
    members[2].out.positions = {second, 3};
    EXPECT_FALSE(crowd.play(members));
    EXPECT_TRUE(std::all_of(first.begin(), first.end(), [](float number) { return number == -7.0f; }));
    EXPECT_EQ(palette.front().rows[0][0], -7.0f);
    EXPECT_TRUE(std::none_of(second.begin(), second.end(), [](float number) { return number == -7.0f; }));
    EXPECT_TRUE(crowd.play(std::span(members).last(1)));
}

}  // namespace
}  // namespace bendy::crowd_test
