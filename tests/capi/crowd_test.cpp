// Bindings of another file's clips, crowds, copies of poses, and kernels through the C API.
#include "capi/open_handles.h"
#include "mutation/allocations.h"
#include "runtime/human_model.h"

#include <array>
#include <cmath>
#include <string>

namespace bendy::test::crowd_test {
namespace {

class CCrowd : public testing::Test {
protected:
    std::string message(bendy_status status) {
        EXPECT_EQ(status, BENDY_BAD_ARGUMENT);
        return error_.message;
    }

    const ModelHandle model_ = open_copy(sample_file());
    bendy_error error_ = BENDY_ERROR_INIT;
};

/// A skeleton of other names and order than walker_file's: "tip" as the root, "other" below it.
Buffer other_skeleton_file() {
    ModelSpec spec;
    JointSpec root;
    root.name = "tip";
    JointSpec other;
    other.parent = 0;
    other.name = "other";
    spec.joints = {root, other};
    return build_file(spec);
}

TEST_F(CCrowd, BindingsPlayAnotherFilesClipsAsInCpp) {
    const ModelHandle animated = open_copy(walker_file());
    const ModelHandle posed = open_copy(other_skeleton_file());
    const Owned cpp_animated{walker_file()};
    const Owned cpp_posed{other_skeleton_file()};
    bendy_binding_options options = BENDY_BINDING_OPTIONS_INIT;
    options.translations = BENDY_TRANSLATIONS_ROOT_ONLY;
    options.root_scale = 2.0f;
    const BindingHandle binding(bendy_binding_new(animated.get(), posed.get(), &options, &error_));
    ASSERT_NE(binding, nullptr) << error_.message;
    Binding cpp(*cpp_animated, *cpp_posed, {BoundTranslations::root_only, kNone, 2.0f});
    EXPECT_EQ(bendy_binding_joints(binding.get())[0], BENDY_NONE);
    EXPECT_EQ(bendy_binding_joints(binding.get())[1], 0u);
    EXPECT_EQ(bendy_binding_targets(binding.get()), nullptr) << "there are none";
    std::size_t count = 9;
    const std::uint32_t* unmatched = bendy_binding_unmatched_joints(binding.get(), &count, &error_);
    ASSERT_EQ(count, 1u);
    EXPECT_EQ(unmatched[0], 0u);
    EXPECT_EQ(bendy_binding_unmatched_targets(binding.get(), &count, &error_), nullptr);
    EXPECT_EQ(count, 0u);
    const PoseHandle pose = new_pose(posed);
    Pose cpp_pose(*cpp_posed);
    ASSERT_EQ(bendy_sample_bound(pose.get(), binding.get(), 1, 1.0f, &error_), BENDY_OK) << error_.message;
    ASSERT_TRUE(sample(cpp_pose, cpp, &cpp_animated->clips()[1], 1.0f));
    bendy_transform local{};
    bendy_get_local(pose.get(), 0, 1, &local, nullptr);
    EXPECT_EQ(local.translation[2], cpp_pose.local(0).translation.z);
    EXPECT_EQ(local.translation[2], 1.0f) << "half a metre, twice";
}

TEST_F(CCrowd, BindingsRefuseBadArguments) {
    const ModelHandle animated = open_copy(walker_file());
    const ModelHandle posed = open_copy(other_skeleton_file());
    EXPECT_EQ(bendy_binding_new(nullptr, posed.get(), nullptr, &error_), nullptr);
    EXPECT_EQ(bendy_binding_new(animated.get(), nullptr, nullptr, &error_), nullptr);
    bendy_binding_options options = BENDY_BINDING_OPTIONS_INIT;
    options.root = 2;
    EXPECT_EQ(bendy_binding_new(animated.get(), posed.get(), &options, &error_), nullptr);
    EXPECT_STREQ(error_.message, "joint 2 does not exist: the model has 2 joints");
    options = BENDY_BINDING_OPTIONS_INIT;
    options.translations = 2;
    EXPECT_EQ(bendy_binding_new(animated.get(), posed.get(), &options, &error_), nullptr);
    options = BENDY_BINDING_OPTIONS_INIT;
    options.root_scale = NAN;
    EXPECT_EQ(bendy_binding_new(animated.get(), posed.get(), &options, &error_), nullptr);
    const BindingHandle binding(bendy_binding_new(animated.get(), posed.get(), nullptr, &error_));
    const PoseHandle pose = new_pose(posed);
    const PoseHandle wrong = new_pose(animated);
    EXPECT_EQ(message(bendy_sample_bound(wrong.get(), binding.get(), 0, 0.0f, &error_)),
              "binding is of another model than pose");
    message(bendy_sample_bound(pose.get(), binding.get(), 2, 0.0f, &error_));
    message(bendy_sample_bound(pose.get(), binding.get(), 0, NAN, &error_));
    message(bendy_sample_bound(pose.get(), nullptr, 0, 0.0f, &error_));
    EXPECT_EQ(bendy_binding_joints(nullptr), nullptr);
    EXPECT_EQ(bendy_binding_unmatched_joints(binding.get(), nullptr, &error_), nullptr);
    EXPECT_STREQ(error_.message, "count is NULL");
    bendy_binding_free(nullptr);
}

TEST_F(CCrowd, PalettesOfManyMembersAreThoseOfPoses) {
    constexpr std::uint32_t kMembers = 19;
    const CrowdHandle crowd(bendy_crowd_new(model_.get(), 1, &error_));
    std::array<std::array<float, 48>, kMembers> palettes{};
    std::array<bendy_crowd_member, kMembers> members;
    for (std::uint32_t k = 0; k < kMembers; ++k) {
        members[k] = BENDY_CROWD_MEMBER_INIT;
        members[k].clip = 0;
        members[k].seconds = 0.1f * static_cast<float>(k);
        if (k % 5 != 3) members[k].palette = palettes[k].data();
    }
    ASSERT_EQ(bendy_crowd_play(crowd.get(), members.data(), kMembers, 0, &error_), BENDY_OK) << error_.message;
    const PoseHandle pose = new_pose(model_);
    for (std::uint32_t k = 0; k < kMembers; ++k) {
        bendy_sample(pose.get(), 0, members[k].seconds, nullptr);
        std::array<float, 48> expected{};
        if (k % 5 != 3) {
            ASSERT_EQ(bendy_bone_matrices(pose.get(), 0, expected.data(), 2, &error_), BENDY_OK) << error_.message;
        }
        EXPECT_TRUE(std::equal(expected.begin(), expected.begin() + 32, palettes[k].begin())) << k;
    }
}

TEST_F(CCrowd, MembersAreSkinnedLikePoses) {
    const CrowdHandle crowd(bendy_crowd_new(model_.get(), 2, &error_));
    EXPECT_EQ(bendy_crowd_workers(crowd.get()), 2u);
    EXPECT_EQ(bendy_crowd_palette_size(crowd.get()), 3u) << "two bones, and the rigid mesh's joint";
    EXPECT_EQ(bendy_crowd_first_matrix(crowd.get(), 1), 2u);
    std::array<std::array<float, 30>, 3> positions{};
    std::array<bendy_vertices, 3> vertices;
    std::array<bendy_crowd_member, 3> members;
    std::array<float, 48> palette{};
    for (std::size_t k = 0; k < 3; ++k) {
        vertices[k] = BENDY_VERTICES_INIT;
        vertices[k].capacity = 10;
        vertices[k].positions = positions[k].data();
        members[k] = BENDY_CROWD_MEMBER_INIT;
        members[k].clip = k == 2 ? BENDY_NONE : 0u;
        members[k].seconds = k == 0 ? 0.6f : 0.9f;
        members[k].vertices = &vertices[k];
    }
    members[1].palette = palette.data();
    ASSERT_EQ(bendy_crowd_play(crowd.get(), members.data(), 2, 0, &error_), BENDY_OK) << error_.message;
    ASSERT_EQ(bendy_crowd_play(crowd.get(), &members[2], 1, 1, &error_), BENDY_OK) << error_.message;
    const PoseHandle pose = new_pose(model_);
    for (std::size_t k = 0; k < 3; ++k) {
        if (k < 2) bendy_sample(pose.get(), 0, members[k].seconds, nullptr);
        if (k == 2) bendy_set_rest(pose.get(), nullptr);
        const std::vector<float> expected = skinned(pose.get(), model_.get());
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), positions[k].begin())) << k;
    }
    bendy_sample(pose.get(), 0, 0.9f, nullptr);
    std::array<float, 48> expected{};
    ASSERT_EQ(bendy_bone_matrices(pose.get(), 0, expected.data(), 2, &error_), BENDY_OK);
    ASSERT_EQ(bendy_joint_matrices(pose.get(), 2, 1, nullptr, &expected[32], &error_), BENDY_OK);
    EXPECT_EQ(palette, expected);
}

/// Three skinned meshes, the first two with the same bind palette.
Buffer equal_palettes_file() {
    glm::mat4 bind(1.0f);
    bind[3] = {1.0f, 2.0f, 3.0f, 1.0f};
    ModelSpec spec;
    spec.joints.resize(1);
    for (const glm::mat4& matrix : {bind, bind, glm::mat4(1.0f)}) {
        MeshSpec& mesh = spec.meshes.emplace_back();
        mesh.positions = {{1.0f, 2.0f, 3.0f}};
        mesh.more = {make_leaf(FourCC("BONE"), stream_payload<std::uint8_t>(1, {0})),
                     make_leaf(FourCC("WGHT"), stream_payload<float>(1, {1.0f})), palette_leaf({0}, {matrix})};
    }
    return build_file(spec);
}

TEST_F(CCrowd, EqualPalettesAreWrittenOnce) {
    const ModelHandle model = open_copy(equal_palettes_file());
    const CrowdHandle crowd(bendy_crowd_new(model.get(), 1, &error_));
    ASSERT_EQ(bendy_crowd_palette_size(crowd.get()), 2u);
    EXPECT_EQ(bendy_crowd_first_matrix(crowd.get(), 1), 0u);
    EXPECT_EQ(bendy_crowd_first_matrix(crowd.get(), 2), 1u);
    std::array<float, 48> palette{};
    palette.back() = -7.0f;
    bendy_crowd_member member = BENDY_CROWD_MEMBER_INIT;
    member.palette = palette.data();
    ASSERT_EQ(bendy_crowd_play(crowd.get(), &member, 1, 0, &error_), BENDY_OK) << error_.message;
    const PoseHandle pose = new_pose(model);
    std::array<float, 48> expected{};
    expected.back() = -7.0f;
    ASSERT_EQ(bendy_bone_matrices(pose.get(), 1, expected.data(), 1, &error_), BENDY_OK);
    ASSERT_EQ(bendy_bone_matrices(pose.get(), 2, &expected[16], 1, &error_), BENDY_OK);
    EXPECT_EQ(palette, expected) << "and nothing beyond two matrices";
}

void pose_member(void* user, std::size_t member, bendy_pose* pose) {
    const float seconds = static_cast<const float*>(user)[member];
    EXPECT_EQ(bendy_sample(pose, 0, seconds, nullptr), BENDY_OK);
    const std::array<float, 2> weights{1.0f, 0.0f};
    EXPECT_EQ(bendy_set_weights(pose, 0, 2, weights.data(), nullptr), BENDY_OK);
}

TEST_F(CCrowd, CallersMayPoseTheMembers) {
    const CrowdHandle crowd(bendy_crowd_new(model_.get(), 0, &error_));
    EXPECT_EQ(bendy_crowd_workers(crowd.get()), 1u);
    std::array<float, 2> seconds{0.6f, 0.9f};
    std::array<std::array<float, 30>, 2> positions{};
    std::array<bendy_vertices, 2> vertices;
    std::array<bendy_crowd_member, 2> members;
    for (std::size_t k = 0; k < 2; ++k) {
        vertices[k] = BENDY_VERTICES_INIT;
        vertices[k].capacity = 10;
        vertices[k].positions = positions[k].data();
        members[k] = BENDY_CROWD_MEMBER_INIT;
        members[k].vertices = &vertices[k];
    }
    ASSERT_EQ(bendy_crowd_play_posed(crowd.get(), members.data(), 2, 0, pose_member, seconds.data(), &error_), BENDY_OK)
        << error_.message;
    const PoseHandle pose = new_pose(model_);
    for (std::size_t k = 0; k < 2; ++k) {
        pose_member(seconds.data(), k, pose.get());
        const std::vector<float> expected = skinned(pose.get(), model_.get());
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), positions[k].begin())) << k;
    }
    EXPECT_EQ(message(bendy_crowd_play_posed(crowd.get(), members.data(), 2, 0, nullptr, nullptr, &error_)),
              "pose_member is NULL");
}

TEST_F(CCrowd, PlayingAllocatesNothing) {
    const CrowdHandle crowd(bendy_crowd_new(model_.get(), 1, &error_));
    std::array<float, 30> positions{};
    bendy_vertices vertices = BENDY_VERTICES_INIT;
    vertices.capacity = 10;
    vertices.positions = positions.data();
    bendy_crowd_member member = BENDY_CROWD_MEMBER_INIT;
    member.clip = 0;
    member.vertices = &vertices;
    float seconds = 0.6f;
    restart_count();
    ASSERT_EQ(bendy_crowd_play(crowd.get(), &member, 1, 0, &error_), BENDY_OK);
    ASSERT_EQ(bendy_crowd_play_posed(crowd.get(), &member, 1, 0, pose_member, &seconds, &error_), BENDY_OK);
#ifndef _WIN32  // where the library's operator new is not this program's
    EXPECT_EQ(allocations().count, 0u);
    EXPECT_NE(CrowdHandle(bendy_crowd_new(model_.get(), 1, &error_)), nullptr);
    EXPECT_GT(allocations().count, 0u) << "or nothing is counted";
#endif
}

TEST_F(CCrowd, BadMembersAreErrorsAndNothingIsWritten) {
    const CrowdHandle crowd(bendy_crowd_new(model_.get(), 1, &error_));
    std::array<float, 30> positions{};
    bendy_vertices good = BENDY_VERTICES_INIT;
    good.capacity = 10;
    good.positions = positions.data();
    bendy_vertices small = good;
    small.capacity = 9;
    std::array<bendy_crowd_member, 2> members{bendy_crowd_member BENDY_CROWD_MEMBER_INIT,
                                              bendy_crowd_member BENDY_CROWD_MEMBER_INIT};
    members[0].vertices = &good;
    members[1].vertices = &small;
    EXPECT_EQ(message(bendy_crowd_play(crowd.get(), members.data(), 2, 0, &error_)),
              "out has room for 9, 10 are needed");
    members[1] = members[0];
    members[1].clip = 1;
    EXPECT_EQ(message(bendy_crowd_play(crowd.get(), members.data(), 2, 0, &error_)),
              "clip 1 does not exist: the model has 1 clip");
    members[1].clip = 0;
    members[1].seconds = NAN;
    message(bendy_crowd_play(crowd.get(), members.data(), 2, 0, &error_));
    members[1].seconds = 0;
    members[1].size += 8;
    message(bendy_crowd_play(crowd.get(), members.data(), 2, 0, &error_));
    members[1].size -= 8;
    const ModelHandle other = open_copy(sample_file());
    const LodHandle lod(bendy_lod_new(other.get(), nullptr));
    members[1].lod = lod.get();
    EXPECT_EQ(message(bendy_crowd_play(crowd.get(), members.data(), 2, 0, &error_)),
              "lod is of another model than the crowd");
    members[1].lod = nullptr;
    EXPECT_EQ(message(bendy_crowd_play(crowd.get(), members.data(), 2, 1, &error_)),
              "worker 1 does not exist: the crowd has 1 worker");
    message(bendy_crowd_play(crowd.get(), nullptr, 2, 0, &error_));
    message(bendy_crowd_play(nullptr, members.data(), 2, 0, &error_));
    members[0].size = 44;
    message(bendy_crowd_play(crowd.get(), members.data(), 2, 0, &error_));
    EXPECT_EQ(positions, (std::array<float, 30>{}));
    EXPECT_EQ(bendy_crowd_play(crowd.get(), nullptr, 0, 0, &error_), BENDY_OK) << "no members are no mistake";
    EXPECT_EQ(bendy_crowd_new(nullptr, 1, &error_), nullptr);
    EXPECT_EQ(bendy_crowd_new(model_.get(), 0xffffffff, &error_), nullptr);
    EXPECT_STREQ(error_.message, "expected at most 4096 workers, found 4294967295");
    EXPECT_EQ(bendy_crowd_workers(nullptr), 0u);
    EXPECT_EQ(bendy_crowd_palette_size(nullptr), 0u);
    EXPECT_EQ(bendy_crowd_first_matrix(crowd.get(), 2), 0u);
    bendy_crowd_free(nullptr);
}

// A program whose struct has grown: members lie farther apart than this library's.
TEST_F(CCrowd, MembersOfALaterVersionAreFoundByTheirSize) {
    struct Newer {
        bendy_crowd_member now = BENDY_CROWD_MEMBER_INIT;
        std::uint64_t added = 0;
    };
    std::array<float, 60> positions{};
    std::array<bendy_vertices, 2> vertices;
    std::array<Newer, 2> members;
    for (std::size_t k = 0; k < 2; ++k) {
        vertices[k] = BENDY_VERTICES_INIT;
        vertices[k].capacity = 10;
        vertices[k].positions = &positions[30 * k];
        members[k].now.size = sizeof(Newer);
        members[k].now.vertices = &vertices[k];
    }
    const CrowdHandle crowd(bendy_crowd_new(model_.get(), 1, &error_));
    ASSERT_EQ(bendy_crowd_play(crowd.get(), &members[0].now, 2, 0, &error_), BENDY_OK) << error_.message;
    EXPECT_NE(positions[3 + 30], 0.0f);
    EXPECT_TRUE(std::equal(positions.begin(), positions.begin() + 30, positions.begin() + 30));
}

TEST_F(CCrowd, PosesAreCopied) {
    const PoseHandle pose = new_pose(model_);
    bendy_sample(pose.get(), 0, 0.7f, nullptr);
    const PoseHandle copy(bendy_pose_copy(pose.get(), &error_));
    ASSERT_NE(copy, nullptr);
    const std::vector<float> before = skinned(pose.get(), model_.get());
    bendy_set_rest(pose.get(), nullptr);
    EXPECT_EQ(skinned(copy.get(), model_.get()), before);
    EXPECT_NE(skinned(pose.get(), model_.get()), before);
    EXPECT_EQ(bendy_pose_copy(nullptr, &error_), nullptr);
}

TEST_F(CCrowd, PreparedDualQuaternionsAllocateNothing) {
    const PoseHandle pose = new_pose(model_);
    std::vector<float> positions(30);
    bendy_vertices out = BENDY_VERTICES_INIT;
    out.capacity = 10;
    out.positions = positions.data();
    bendy_skin_options options = BENDY_SKIN_OPTIONS_INIT;
    options.method = BENDY_SKIN_DUAL_QUATERNION;
    restart_count();
    ASSERT_EQ(bendy_prepare_skin(pose.get(), BENDY_SKIN_DUAL_QUATERNION, &error_), BENDY_OK);
#ifndef _WIN32
    EXPECT_GT(allocations().count, 0u);
#endif
    restart_count();
    ASSERT_EQ(bendy_skin(pose.get(), &options, &out, &error_), BENDY_OK);
    EXPECT_EQ(allocations().count, 0u);
    EXPECT_EQ(message(bendy_prepare_skin(pose.get(), 2, &error_)), "method 2 is not a bendy_skin_method");
    message(bendy_prepare_skin(nullptr, 0, &error_));
}

TEST_F(CCrowd, LocalMatricesAreAsInCpp) {
    const bendy_transform transform{{0.6f, 0, 0, 0.8f}, {1, 2, 3}, {2, 3, 4}};
    const std::array<float, 3> shear{0.5f, 0.25f, 0.125f};
    std::array<float, 16> matrix{};
    ASSERT_EQ(bendy_transform_matrix(&transform, shear.data(), matrix.data(), &error_), BENDY_OK);
    const JointTransform cpp{glm::quat(0.8f, 0.6f, 0, 0), {1, 2, 3}, {2, 3, 4}};
    const glm::mat4 expected(to_matrix(cpp, {0.5f, 0.25f, 0.125f}));
    for (int k = 0; k < 16; ++k) EXPECT_EQ(matrix[static_cast<std::size_t>(k)], expected[k / 4][k % 4]) << k;
    const bendy_transform bad{{0, 0, 0, 0}, {1, 2, 3}, {2, 3, 4}};
    message(bendy_transform_matrix(&bad, nullptr, matrix.data(), &error_));
    message(bendy_transform_matrix(nullptr, nullptr, matrix.data(), &error_));
    message(bendy_transform_matrix(&transform, nullptr, nullptr, &error_));
}

TEST_F(CCrowd, KernelsAreListedAndChosen) {
    ASSERT_EQ(bendy_kernel_count(), kernels().size());
    for (std::uint32_t number = 0; number < bendy_kernel_count(); ++number)
        EXPECT_EQ(bendy_kernel_name(number), kernel_name(kernels()[number]));
    EXPECT_EQ(bendy_kernel_name(bendy_kernel_count()), nullptr);
    const std::string before = bendy_kernel();
    for (std::uint32_t number = 0; number < bendy_kernel_count(); ++number) {
        ASSERT_EQ(bendy_set_kernel(bendy_kernel_name(number), &error_), BENDY_OK);
        EXPECT_STREQ(bendy_kernel(), bendy_kernel_name(number));
    }
    EXPECT_EQ(bendy_set_kernel("abacus", &error_), BENDY_NOT_FOUND);
    ASSERT_EQ(bendy_set_kernel(before.c_str(), &error_), BENDY_OK);
}

#if defined(__cpp_exceptions) && !defined(_WIN32)
/// Makes a handle while each allocation fails once: NULL and an error then, and nothing leaks.
template <class Handle, class Make>
void make_without_memory(const Make& make) {
    std::uint64_t failures = 0;
    for (std::uint64_t number = 1;; ++number) {
        bendy_error error = BENDY_ERROR_INIT;
        const std::int64_t live = allocations().live;
        fail_allocation(number);
        Handle handle(make(&error));
        const bool is_through = is_failure_pending();
        fail_allocation(0);
        if (is_through) {
            EXPECT_NE(handle, nullptr);
            break;
        }
        if (handle != nullptr) continue;  // std::stable_sort does without
        ++failures;
        ASSERT_EQ(error.status, BENDY_OUT_OF_MEMORY) << number;
        ASSERT_EQ(allocations().live, live) << number;
    }
    EXPECT_GT(failures, 0u);
}

TEST_F(CCrowd, MemoryThatRunsOutIsAnErrorInEveryConstructor) {
    const ModelHandle walker = open_copy(walker_file());
    const bendy_model* const m = walker.get();
    const PoseHandle pose = new_pose(walker);
    make_without_memory<PoseHandle>([&](bendy_error* e) { return bendy_pose_copy(pose.get(), e); });
    make_without_memory<PlaybackHandle>([&](bendy_error* e) { return bendy_playback_new(m, 0, e); });
    make_without_memory<PlaybackHandle>([&](bendy_error* e) { return bendy_playback_new_range(0, 1, 0, e); });
    make_without_memory<FadeHandle>([&](bendy_error* e) { return bendy_fade_new(0, e); });
    make_without_memory<CrossfadeHandle>([&](bendy_error* e) { return bendy_crossfade_new(m, e); });
    make_without_memory<RootPathHandle>([&](bendy_error* e) { return bendy_root_path_new(m, 1, nullptr, e); });
    make_without_memory<BoundsHandle>([&](bendy_error* e) { return bendy_bounds_new(m, e); });
    make_without_memory<BindingHandle>([&](bendy_error* e) { return bendy_binding_new(m, m, nullptr, e); });
    make_without_memory<CrowdHandle>([&](bendy_error* e) { return bendy_crowd_new(m, 3, e); });
    make_without_memory<RetargetStateHandle>([](bendy_error* e) { return bendy_retarget_state_new(e); });
    const ModelHandle human = open_copy(HumanModel(HumanSpec{}).file());
    const bendy_model* const h = human.get();
    const PoseHandle first = new_pose(human);  // the model keeps what it makes for its first pose
    make_without_memory<RetargetHandle>([&](bendy_error* e) { return bendy_retarget_new(h, h, nullptr, e); });
}
#endif

}  // namespace
}  // namespace bendy::test::crowd_test
