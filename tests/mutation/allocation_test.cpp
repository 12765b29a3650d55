// Every allocation of the library made to fail once: std::bad_alloc passes through, nothing is left behind, and what
// was there before is as it was.
#include <bendy/format/diagnostics.h>
#include <bendy/format/pair_chunks.h>
#include <bendy/runtime.h>

#include "mutation/fail_each.h"
#include "mutation/seeds.h"
#include "runtime/packed_model.h"
#include "source_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bendy::test::allocation_test {
namespace {

/// What skinning gives in the middle of a model's first clip; sizes are set before, so that only the library
/// allocates.
std::vector<glm::vec3> pose_once(const Model& model) {
    Pose pose(model);
    std::vector<glm::vec3> positions(model.vertex_count());
    if (!model.clips().empty()) (void)sample(pose, model.clips().data(), model.clips()[0].start + 0.2f);
    constrain(pose);
    for (const Chain& chain : model.chains()) (void)reach(pose, &chain, glm::vec3(0.1f, 0.5f, 0.2f));
    (void)skin(pose, {.out = {.positions = positions}});
    return positions;
}

class FailedAllocation : public testing::TestWithParam<const char*> {
protected:
    const Buffer file_ = read_seed(GetParam());
};

TEST_P(FailedAllocation, OfOpeningLeavesNothingBehind) {
    const std::uint64_t failures = fail_each_allocation(
        [&] { ASSERT_TRUE(Model::from_memory(file_).has_value()) << "and no error of the file's"; });
    EXPECT_GE(failures, 10u);
}

TEST_P(FailedAllocation, OfValidatingLeavesNothingBehind) {
    EXPECT_GE(fail_each_allocation([&] { ASSERT_TRUE(validate(file_).empty()); }), 3u);
}

TEST_P(FailedAllocation, OfPosingLeavesTheModelGood) {
    const Result<Model> opened = Model::from_memory(file_);
    const Model& model = *opened;
    const std::vector<glm::vec3> expected = pose_once(model);
    EXPECT_GE(fail_each_allocation([&] { ASSERT_EQ(pose_once(model), expected); }), 5u);
    EXPECT_GE(fail_each_allocation([&] { ASSERT_EQ(Crowd(model, 2).workers(), 2u); }), 5u);
    fail_each_allocation([&] {
        Lod lod(model);
        lod.set_share(0.5f);
    });
    EXPECT_EQ(pose_once(model), expected);
}

// The first Pose makes what all share: where that fails, the next one makes it.
TEST_P(FailedAllocation, OfTheFirstPoseLeavesItToTheSecond) {
    const std::vector<glm::vec3> expected = pose_once(*Model::from_memory(file_));
    fail_each_allocation([&] {
        const Result<Model> model = Model::from_memory(file_);
        std::vector<glm::vec3> found;
        try {
            found = pose_once(*model);
        } catch (const std::bad_alloc&) {
            found = pose_once(*model);
        }
        ASSERT_EQ(found, expected);
    });
}

INSTANTIATE_TEST_SUITE_P(Seeds, FailedAllocation,
                         testing::Values("spec/examples/every_chunk", "tests/seeds/rope_compact_lod",
                                         "tests/seeds/rope_rigged_compact", "tests/seeds/plate_compact", "every_codec"),
                         [](const auto& seed) { return test_name(seed.param); });

TEST(FailedAllocation, OfOpeningAFileLeavesNothingBehind) {
    const std::string path = (source_folder() / "tests/seeds/rope.bendy").string();
    EXPECT_GE(fail_each_allocation([&] { ASSERT_TRUE(Model::open(path).has_value()); }), 10u);
}

TEST(FailedAllocation, OfWritingAFileLeavesTheOldOne) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "bendy_failed_allocation";
    std::filesystem::create_directory(folder);
    const Buffer old = read_seed("tests/seeds/plate");
    const Buffer renewed = read_seed("tests/seeds/rope");
    ASSERT_TRUE(write_file(folder / "file", old).has_value());
    const std::filesystem::path path = folder / "file";
    const std::uint64_t failures = fail_each_allocation([&] {
        try {
            ASSERT_TRUE(write_file(path, renewed).has_value());
        } catch (const std::bad_alloc&) {
            ASSERT_EQ(MappedFile::open(path)->bytes().size(), old.size());
            ASSERT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
            throw;
        }
        ASSERT_TRUE(write_file(path, old).has_value());
    });
    EXPECT_GE(failures, 1u);
    std::filesystem::remove_all(folder);
}

TEST(FailedAllocation, OfEncodingLeavesNothingBehind) {
    const Buffer expected = every_codec();
    EXPECT_GE(fail_each_allocation([&] { ASSERT_EQ(every_codec(), expected); }), 100u);
    const Buffer packed = build_file(packed_spec(4, 20, 8));
    EXPECT_GE(fail_each_allocation([&] { ASSERT_EQ(build_file(packed_spec(4, 20, 8)), packed); }), 50u);
}

TEST(FailedAllocation, OfDescribingAFaultLeavesNothingBehind) {
    Buffer file = read_seed("tests/seeds/rope");
    file[file.size() / 2] ^= std::byte{1};
    fail_each_allocation([&] {
        const Faults faults = validate(file);
        ASSERT_FALSE(faults.empty());
        ASSERT_FALSE(describe_with_place(faults.list().front(), file).empty());
    });
}

}  // namespace
}  // namespace bendy::test::allocation_test
