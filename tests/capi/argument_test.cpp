// The C API takes anything: what is wrong with arguments and files is said, and nothing is touched.
#include <bendy/format/file.h>

#include "capi/open_handles.h"
#include "mutation/allocations.h"

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>

namespace bendy::test::argument_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class CArguments : public testing::Test {
protected:
    /// The message of the call's error, which must be the caller's fault.
    std::string message(bendy_status status) {
        EXPECT_EQ(status, BENDY_BAD_ARGUMENT);
        EXPECT_EQ(error_.status, BENDY_BAD_ARGUMENT);
        EXPECT_STREQ(error_.code, "BAD_ARGUMENT");
        const std::string text = error_.message;
        error_ = BENDY_ERROR_INIT;
        return text;
    }

    const ModelHandle model_ = open_copy(sample_file());
    const PoseHandle pose_ = new_pose(model_);
    const LodHandle lod_{bendy_lod_new(model_.get(), nullptr)};
    bendy_error error_ = BENDY_ERROR_INIT;
    std::array<float, 400> numbers_{};
    bendy_transform transform_{{0, 0, 0, 1}, {}, {1, 1, 1}};
};

TEST_F(CArguments, NullIsAnErrorEverywhere) {
    bendy_model* const none = nullptr;
    bendy_pose* const no_pose = nullptr;
    bendy_error* const e = &error_;
    EXPECT_EQ(message(bendy_check_sums(none, e)), "model is NULL");
    EXPECT_EQ(bendy_open(nullptr, nullptr, e), nullptr);
    EXPECT_STREQ(error_.message, "path is NULL");
    EXPECT_EQ(bendy_open_copy(nullptr, 5, nullptr, e), nullptr);
    EXPECT_STREQ(error_.message, "bytes is NULL");
    EXPECT_EQ(bendy_pose_new(none, e), nullptr);
    EXPECT_EQ(bendy_lod_new(none, e), nullptr);
    EXPECT_EQ(bendy_find_joint(none, "a", e), BENDY_NONE);
    EXPECT_STREQ(error_.message, "model is NULL");
    EXPECT_EQ(bendy_find_joint(model_.get(), nullptr, e), BENDY_NONE);
    EXPECT_STREQ(error_.message, "name is NULL");
    EXPECT_EQ(bendy_joint_count(none) + bendy_clip_count(none) + bendy_submesh_count(none) + bendy_vertex_count(none),
              0u);
    EXPECT_EQ(bendy_joint_parents(none), nullptr);
    EXPECT_EQ(bendy_model_name(none), nullptr);
    EXPECT_EQ(bendy_model_extras(none), nullptr);
    EXPECT_EQ(bendy_file_extras(none), nullptr);
    EXPECT_EQ(bendy_lod_vertices(nullptr, 0), 0u);
    EXPECT_EQ(bendy_lod_indices(lod_.get(), 0, nullptr, e), nullptr);
    EXPECT_STREQ(error_.message, "count is NULL");
    EXPECT_EQ(message(bendy_get_joint(model_.get(), 0, nullptr, e)), "out is NULL");
    for (const bendy_status status :
         {bendy_set_rest(no_pose, e), bendy_sample(no_pose, 0, 0, e), bendy_blend(no_pose, pose_.get(), 0, nullptr, e),
          bendy_make_additive(no_pose, pose_.get(), e), bendy_add(no_pose, pose_.get(), 0, nullptr, e),
          bendy_constrain(no_pose, e), bendy_get_local(no_pose, 0, 0, nullptr, e),
          bendy_set_local(no_pose, 0, 0, nullptr, e), bendy_reach_all(no_pose, nullptr, 0, e),
          bendy_get_weights(no_pose, 0, 0, nullptr, e), bendy_set_weights(no_pose, 0, 0, nullptr, e),
          bendy_reach(no_pose, 0, nullptr, nullptr, nullptr, nullptr, e),
          bendy_bone_matrices(no_pose, 0, nullptr, 0, e), bendy_joint_matrices(no_pose, 0, 0, nullptr, nullptr, e),
          bendy_skin(no_pose, nullptr, nullptr, e)}) {
        EXPECT_EQ(status, BENDY_BAD_ARGUMENT);
        EXPECT_STREQ(error_.message, "pose is NULL");
    }
    EXPECT_EQ(message(bendy_blend(pose_.get(), nullptr, 0, nullptr, e)), "other is NULL");
    EXPECT_EQ(message(bendy_get_local(pose_.get(), 0, 1, nullptr, e)), "transforms is NULL");
    EXPECT_EQ(message(bendy_set_weights(pose_.get(), 0, 1, nullptr, e)), "weights is NULL");
    EXPECT_EQ(message(bendy_reach(pose_.get(), 0, nullptr, nullptr, nullptr, nullptr, e)), "position is NULL");
    EXPECT_EQ(message(bendy_joint_matrices(pose_.get(), 0, 1, nullptr, nullptr, e)), "matrices is NULL");
    EXPECT_EQ(message(bendy_skin(pose_.get(), nullptr, nullptr, e)), "out is NULL");
    EXPECT_EQ(message(bendy_lod_set_share(nullptr, 1, e)), "lod is NULL");
    EXPECT_EQ(message(bendy_set_kernel(nullptr, e)), "name is NULL");
    bendy_close(nullptr);
    bendy_pose_free(nullptr);
    bendy_lod_free(nullptr);
    EXPECT_EQ(bendy_sample(no_pose, 0, 0, nullptr), BENDY_BAD_ARGUMENT) << "without an error to fill";
}

TEST_F(CArguments, IndicesOutOfRangeAreErrors) {
    auto joint = sized<bendy_joint>();
    EXPECT_EQ(message(bendy_get_joint(model_.get(), 4, &joint, &error_)),
              "joint 4 does not exist: the model has 4 joints");
    EXPECT_EQ(joint.name, nullptr) << "nothing is written";
    auto mesh = sized<bendy_mesh>();
    EXPECT_EQ(message(bendy_get_mesh(model_.get(), 2, &mesh, &error_)),
              "mesh 2 does not exist: the model has 2 meshes");
    EXPECT_EQ(message(bendy_sample(pose_.get(), 1, 0, &error_)), "clip 1 does not exist: the model has 1 clip");
    EXPECT_EQ(message(bendy_sample(pose_.get(), BENDY_NONE, 0, &error_)),
              "clip is BENDY_NONE: there is none of the name that was looked for");
    auto submesh = sized<bendy_submesh>();
    message(bendy_get_submesh(model_.get(), bendy_submesh_count(model_.get()), &submesh, &error_));
    message(bendy_lod_submesh(lod_.get(), bendy_submesh_count(model_.get()), &submesh, &error_));
    message(bendy_get_indices(model_.get(), 2, nullptr, 0, &error_));
    message(bendy_bone_matrices(pose_.get(), 2, numbers_.data(), 20, &error_));
    const std::array<float, 3> target{};
    message(
        bendy_reach(pose_.get(), bendy_chain_count(model_.get()), target.data(), nullptr, nullptr, nullptr, &error_));
    bendy_vertices out = BENDY_VERTICES_INIT;
    bendy_skin_options options = BENDY_SKIN_OPTIONS_INIT;
    options.mesh = 2;
    EXPECT_EQ(message(bendy_skin(pose_.get(), &options, &out, &error_)),
              "mesh 2 does not exist: the model has 2 meshes");
    EXPECT_EQ(message(bendy_get_local(pose_.get(), 3, 2, &transform_, &error_)),
              "the model has 4 joints; asked for 2 from number 3");
    message(bendy_set_local(pose_.get(), 0xffff'ffff, 2, &transform_, &error_));  // which would wrap
    message(bendy_get_weights(pose_.get(), 1, 2, numbers_.data(), &error_));
    message(bendy_joint_matrices(pose_.get(), 4, 1, nullptr, numbers_.data(), &error_));
    message(bendy_mask_below(model_.get(), 4, 1, 0, numbers_.data(), numbers_.size(), &error_));
    EXPECT_EQ(bendy_get_local(pose_.get(), 4, 0, nullptr, &error_), BENDY_OK) << "none at the end is no mistake";
}

TEST_F(CArguments, MemoryThatIsTooShortIsAnErrorAndUntouched) {
    numbers_.fill(5.0f);
    bendy_vertices out = BENDY_VERTICES_INIT;
    out.positions = numbers_.data();
    out.capacity = 9;
    EXPECT_EQ(message(bendy_skin(pose_.get(), nullptr, &out, &error_)), "out has room for 9, 10 are needed");
    out.capacity = 10;
    out.position_stride = 8;
    EXPECT_EQ(message(bendy_skin(pose_.get(), nullptr, &out, &error_)),
              "positions: a stride of 8 bytes is not a multiple of 4 that holds 3 floats");
    out.position_stride = 14;
    message(bendy_skin(pose_.get(), nullptr, &out, &error_));
    out.position_stride = std::numeric_limits<std::size_t>::max() - 3;
    message(bendy_skin(pose_.get(), nullptr, &out, &error_));
    out.position_stride = 0;
    out.positions = reinterpret_cast<float*>(reinterpret_cast<char*>(numbers_.data()) + 1);
    EXPECT_EQ(message(bendy_skin(pose_.get(), nullptr, &out, &error_)),
              "positions does not start on a 4-byte boundary");
    message(bendy_get_texture_coords(model_.get(), 0, 9, numbers_.data(), 400, &error_));
    message(bendy_bone_matrices(pose_.get(), 0, numbers_.data(), 0, &error_));
    message(bendy_mask_below(model_.get(), 0, 1, 0, numbers_.data(), 3, &error_));
    EXPECT_EQ(std::count(numbers_.begin(), numbers_.end(), 5.0f), 400);
}

TEST_F(CArguments, NumbersThatAreNoneAreErrors) {
    EXPECT_EQ(message(bendy_sample(pose_.get(), 0, kNan, &error_)), "seconds is not a number");
    message(bendy_blend(pose_.get(), pose_.get(), kNan, nullptr, &error_));
    numbers_[2] = kNan;
    EXPECT_EQ(message(bendy_blend(pose_.get(), pose_.get(), 1, numbers_.data(), &error_)),
              "mask holds a number that is not finite");
    EXPECT_EQ(message(bendy_reach(pose_.get(), 0, numbers_.data(), nullptr, nullptr, nullptr, &error_)),
              "position holds a number that is not finite");
    const std::array<float, 4> no_rotation{};
    EXPECT_EQ(message(bendy_reach(pose_.get(), 0, &numbers_[5], no_rotation.data(), nullptr, nullptr, &error_)),
              "rotation is not a unit quaternion (x, y, z, w)");
    transform_.rotation[3] = 2;
    message(bendy_set_local(pose_.get(), 0, 1, &transform_, &error_));
    transform_.rotation[3] = 1;
    transform_.translation[0] = INFINITY;
    message(bendy_set_local(pose_.get(), 0, 1, &transform_, &error_));
    message(bendy_set_weights(pose_.get(), 0, 1, &numbers_[2], &error_));
    message(bendy_lod_set_share(lod_.get(), kNan, &error_));
    message(bendy_lod_set_share(lod_.get(), 1.5f, &error_));
    bendy_reach_options options = BENDY_REACH_OPTIONS_INIT;
    options.solver = 7;
    EXPECT_EQ(message(bendy_reach(pose_.get(), 0, &numbers_[5], nullptr, &options, nullptr, &error_)),
              "solver 7 is not a bendy_solver");
    options = BENDY_REACH_OPTIONS_INIT;
    options.influence = kNan;
    message(bendy_reach(pose_.get(), 0, &numbers_[5], nullptr, &options, nullptr, &error_));
}

TEST_F(CArguments, WhatBelongsToAnotherModelIsAnError) {
    const ModelHandle other = open_copy(sample_file());
    const PoseHandle other_pose = new_pose(other);
    EXPECT_EQ(message(bendy_blend(pose_.get(), other_pose.get(), 1, nullptr, &error_)),
              "other is of another model than pose");
    bendy_vertices out = BENDY_VERTICES_INIT;
    out.capacity = 10;
    out.positions = numbers_.data();
    bendy_skin_options options = BENDY_SKIN_OPTIONS_INIT;
    options.lod = lod_.get();
    EXPECT_EQ(message(bendy_skin(other_pose.get(), &options, &out, &error_)), "lod is of another model than pose");
}

TEST_F(CArguments, StructsOfOtherVersionsAreTakenAsFarAsBothKnowThem) {
    bendy_joint unset{};
    EXPECT_EQ(message(bendy_get_joint(model_.get(), 0, &unset, &error_)), "out: its size is 0, set it to its sizeof");
    unset.size = 0x7fff'0000;
    message(bendy_get_joint(model_.get(), 0, &unset, &error_));

    struct Newer {  // what a later version may have
        bendy_reach_result now;
        std::uint32_t added;
    } result{};
    result.now.size = sizeof result;
    result.added = 9;
    const std::array<float, 3> target{};
    ASSERT_EQ(bendy_reach(pose_.get(), 0, target.data(), nullptr, nullptr, &result.now, &error_), BENDY_OK);
    EXPECT_EQ(result.added, 0u);
    EXPECT_EQ(result.now.size, sizeof result);

    struct NewerOptions {
        bendy_reach_options now = BENDY_REACH_OPTIONS_INIT;
        std::uint64_t added = 0;  // without padding after it, which could hold anything
    } options;
    options.now.size = sizeof options;
    EXPECT_EQ(bendy_reach(pose_.get(), 0, target.data(), nullptr, &options.now, nullptr, &error_), BENDY_OK);
    options.added = 1;
    EXPECT_EQ(message(bendy_reach(pose_.get(), 0, target.data(), nullptr, &options.now, nullptr, &error_)),
              "options asks for something that this version of the library does not know");
}

TEST_F(CArguments, SuccessLeavesTheErrorAsItIs) {
    std::strcpy(error_.message, "as it was");
    EXPECT_EQ(bendy_set_rest(pose_.get(), &error_), BENDY_OK);
    EXPECT_STREQ(error_.message, "as it was");
}

TEST(CFiles, FaultsComeWithCodePathAndOffset) {
    bendy_error error = BENDY_ERROR_INIT;
    Buffer file = sample_file();
    file[100] ^= std::byte{1};
    EXPECT_EQ(bendy_open_copy(file.data(), file.size(), nullptr, &error), nullptr);
    EXPECT_EQ(error.status, BENDY_MALFORMED);
    EXPECT_STREQ(error.code, "SUM_MISMATCH");
    EXPECT_NE(std::string(error.message).find("HEAD"), std::string::npos) << error.message;

    EXPECT_EQ(bendy_open("/nowhere/fox.bendy", nullptr, &error), nullptr);
    EXPECT_EQ(error.status, BENDY_IO);
    EXPECT_STREQ(error.code, "CANNOT_OPEN");
    EXPECT_STREQ(error.message, "the file cannot be opened: No such file or directory");

    EXPECT_EQ(bendy_open_copy("no", 2, nullptr, &error), nullptr);
    EXPECT_STREQ(error.code, "NOT_A_BENDY_FILE");
    EXPECT_EQ(bendy_open_copy(nullptr, 0, nullptr, &error), nullptr) << "no bytes are no file";

    const Buffer good = sample_file();
    Buffer shifted(good.size() + 1);
    std::copy(good.begin(), good.end(), shifted.begin() + 1);
    EXPECT_EQ(bendy_open_borrowed(&shifted[1], good.size(), nullptr, &error), nullptr);
    EXPECT_EQ(error.status, BENDY_BAD_ARGUMENT);
    EXPECT_STREQ(error.code, "UNALIGNED_BUFFER");
    EXPECT_NE(ModelHandle(bendy_open_copy(&shifted[1], good.size(), nullptr, &error)), nullptr) << "a copy is aligned";

    bendy_open_options options = BENDY_OPEN_OPTIONS_INIT;
    options.object = 1;
    EXPECT_EQ(bendy_open_copy(good.data(), good.size(), &options, &error), nullptr);
    EXPECT_STREQ(error.code, "CHUNK_MISSING");
}

TEST(CFiles, SumsMayBeCheckedLater) {
    Buffer file = sample_file();
    const std::size_t at = file.size() - 40;  // in text at the file's end
    file[at] ^= std::byte{1};
    bendy_open_options options = BENDY_OPEN_OPTIONS_INIT;
    options.sums_later = 1;
    bendy_error error = BENDY_ERROR_INIT;
    const ModelHandle model(bendy_open_copy(file.data(), file.size(), &options, &error));
    ASSERT_NE(model, nullptr) << error.message;
    EXPECT_EQ(bendy_check_sums(model.get(), &error), BENDY_MALFORMED);
    EXPECT_STREQ(error.code, "SUM_MISMATCH");
    EXPECT_GT(error.offset, 0u);
}

TEST(CFiles, LongMessagesAreCutBetweenCharacters) {
    std::string name(1000, 'x');
    for (int k = 0; k < 3; ++k) {
        const ModelHandle model = open_copy(two_joint_file());
        bendy_error error = BENDY_ERROR_INIT;
        std::string odd = name.substr(0, 420 + static_cast<std::size_t>(k));
        for (int e = 0; e < 40; ++e) odd += "\xc3\xa9";
        EXPECT_EQ(bendy_find_joint(model.get(), odd.c_str(), &error), BENDY_NONE);
        const std::string message = error.message;
        EXPECT_GE(message.size(), sizeof error.message - 3);
        EXPECT_LT(message.size(), sizeof error.message);
        EXPECT_EQ(message.back(), '\xa9') << "not half a character";
    }
}

TEST(CFiles, MayBeReadIntoMemory) {
    const auto file = std::filesystem::path(testing::TempDir()) / "bendy_capi_copied.bendy";
    const Buffer bytes = sample_file();
    ASSERT_TRUE(write_file(file, bytes).has_value());
    const std::u8string name = file.u8string();
    bendy_open_options options = BENDY_OPEN_OPTIONS_INIT;
    options.copied = 1;
    bendy_error error = BENDY_ERROR_INIT;
    const ModelHandle model(bendy_open(reinterpret_cast<const char*>(name.c_str()), &options, &error));
    ASSERT_NE(model, nullptr) << error.message;
    std::filesystem::resize_file(file, 0);  // would end the program by SIGBUS if it were mapped
    EXPECT_EQ(bendy_check_sums(model.get(), &error), BENDY_OK) << error.message;
    std::filesystem::remove(file);
    // A program that was compiled before there was the field.
    options.size = offsetof(bendy_open_options, copied);
    EXPECT_NE(ModelHandle(bendy_open_copy(bytes.data(), bytes.size(), &options, &error)), nullptr);
}

TEST(CFiles, NamesAreUtf8OnEverySystem) {
    const auto folder = std::filesystem::path(testing::TempDir());
    const std::filesystem::path file = folder / u8"bendy_capi_\u2764.bendy";
    ASSERT_TRUE(write_file(file, sample_file()).has_value());
    const std::u8string name = file.u8string();
    bendy_error error = BENDY_ERROR_INIT;
    EXPECT_NE(ModelHandle(bendy_open(reinterpret_cast<const char*>(name.c_str()), nullptr, &error)), nullptr)
        << error.message;
    std::filesystem::remove(file);
#ifdef _WIN32
    EXPECT_EQ(bendy_open("\xff.bendy", nullptr, &error), nullptr);
    EXPECT_EQ(error.status, BENDY_BAD_ARGUMENT);
    EXPECT_STREQ(error.message, "path is not UTF-8");
#endif
}

#if defined(__cpp_exceptions) && !defined(_WIN32)
// The library's operator new is this program's, but on Windows: each allocation fails once.
TEST(CFiles, MemoryThatRunsOutIsAnError) {
    const Buffer file = sample_file();
    std::uint64_t failures = 0;
    for (std::uint64_t number = 1;; ++number) {
        bendy_error error = BENDY_ERROR_INIT;
        fail_allocation(number);
        bendy_model* const model = bendy_open_copy(file.data(), file.size(), nullptr, &error);
        bendy_pose* const pose = bendy_pose_new(model, model == nullptr ? nullptr : &error);
        const bool is_through = is_failure_pending();
        fail_allocation(0);
        bendy_pose_free(pose);
        bendy_close(model);
        if (is_through) break;
        if (model != nullptr && pose != nullptr) continue;  // std::stable_sort does without
        ++failures;
        ASSERT_EQ(error.status, BENDY_OUT_OF_MEMORY) << number;
        ASSERT_STREQ(error.message, "there is not enough memory");
    }
    EXPECT_GT(failures, 20u);
}
#endif

}  // namespace
}  // namespace bendy::test::argument_test
