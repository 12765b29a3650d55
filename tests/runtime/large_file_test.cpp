#include <bendy/runtime.h>

#include "runtime/build_model.h"
#include "runtime/sparse_file.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

// Files of more than 4 GiB: sparse ones, so that next to nothing is written.
namespace bendy::large_file_test {
namespace {

constexpr std::uint64_t kHole = (std::uint64_t{1} << 32) + (std::uint64_t{1} << 29);  // bytes

struct Header {
    FourCC id;
    std::uint32_t sum = 0;  // of 4.5 GB of zeros; nobody looks
    std::uint64_t size_and_flags = 0;
};
static_assert(sizeof(Header) == kChunkHeaderSize);

template <class T>
void put(std::ofstream& out, const T& value) {
    out.write(reinterpret_cast<const char*>(&value), sizeof value);  // NOLINT(*-reinterpret-cast)
}

/// A good file's bytes behind a leaf of kHole bytes that no reader knows. False where files cannot have holes.
bool write_behind_hole(Bytes good, const std::filesystem::path& path) {
    test::make_sparse_file(path);
    {
        std::ofstream out(path, std::ios::binary | std::ios::in);
        Header root;
        std::memcpy(&root, good.data(), sizeof root);
        root.size_and_flags += kChunkHeaderSize + kHole;
        put(out, root);
        put(out, Header{FourCC("HOLE"), 0, pack_size_and_flags(kHole, 0)});
        out.seekp(static_cast<std::streamoff>(kHole), std::ios::cur);
        const Bytes children = good.subspan(kChunkHeaderSize);
        out.write(as_text(children).data(), static_cast<std::streamsize>(children.size()));
        if (!out.flush()) return false;
    }
    constexpr std::uint64_t kLittle = std::uint64_t{1} << 26;
    return test::room_of(path) < kLittle;
}

std::vector<glm::vec3> pose_in_run(const Model& model) {
    Pose pose(model);
    EXPECT_TRUE(sample(pose, model.clip("run"), 0.6f));
    std::vector<glm::vec3> positions(model.vertex_count());
    EXPECT_TRUE(skin(pose, {.out = {.positions = positions}}));
    return positions;
}

TEST(LargeFile, StreamsBeyondFourGigabytesArePosed) {
    const test::Buffer good = test::sample_file();
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "large.bendy";
    if (!write_behind_hole(good, file)) GTEST_SKIP() << "no sparse files here";
    OpenOptions options;
    options.sums = Sums::later;
    const Result<Model> model = Model::open(file, options);
    ASSERT_TRUE(model.has_value()) << describe_with_place(model.error(), good);
    const test::Owned same(good);
    EXPECT_EQ(model->joints().size(), same->joints().size());
    EXPECT_EQ(pose_in_run(*model), pose_in_run(*same));
    EXPECT_GT(std::filesystem::file_size(file), kHole);
}

TEST(LargeFile, AFaultBeyondFourGigabytesHasItsPlace) {
    test::Buffer bad = test::sample_file();
    const std::uint64_t indices = test::place_of(bad, "HEAD/OBJE/VECT/INDX");
    test::patch(bad, indices + kChunkHeaderSize + sizeof(StreamRecord), std::uint16_t{999});
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "large.bendy";
    if (!write_behind_hole(bad, file)) GTEST_SKIP() << "no sparse files here";
    OpenOptions options;
    options.sums = Sums::later;
    const Result<Model> model = Model::open(file, options);
    ASSERT_FALSE(model.has_value());
    EXPECT_EQ(model.error().code, ErrorCode::kIndexRange);
    EXPECT_EQ(model.error().offset, indices + kChunkHeaderSize + kHole);
}

}  // namespace
}  // namespace bendy::large_file_test
