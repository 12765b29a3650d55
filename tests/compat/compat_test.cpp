#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>
#include <bendy/format/file.h>
#include <bendy/runtime.h>

#include "source_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

// The files of every released version open, are valid and move as they did then.
namespace bendy::compat_test {
namespace {

const std::filesystem::path kFolder = source_folder() / "tests" / "compat";

std::vector<std::filesystem::path> all_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kFolder)) {
        if (entry.path().extension() == ".bendy") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

nlohmann::json read_poses(std::filesystem::path file) {
    std::ifstream stream(file.replace_extension(".json"));
    return nlohmann::json::parse(stream);
}

/// The largest difference of two lists of numbers, as a share of the numbers where they are above 1.
double distance(const float* found, const nlohmann::json& wanted, std::size_t first) {
    double most = 0.0;
    for (std::size_t k = first; k < wanted.size(); ++k) {
        const auto number = wanted[k].get<double>();
        const double apart = std::abs(double{found[k - first]} - number) / std::max(1.0, std::abs(number));
        most = apart <= most ? most : apart;  // a NaN counts
    }
    return most;
}

/// `bendy pose` as it was: the clip is a number or null for the rest pose.
void expect_pose(const Model& model, const nlohmann::json& wanted, double tolerance) {
    Pose pose(model);
    if (!wanted.at("clip").is_null()) {
        const Clip& clip = model.clips()[wanted.at("clip").get<std::size_t>()];
        ASSERT_TRUE(sample(pose, &clip, wanted.at("time").get<float>()));
    }
    const nlohmann::json& joints = wanted.at("joints");
    ASSERT_EQ(joints.size(), model.joints().size());
    for (std::size_t joint = 0; joint < joints.size(); ++joint)
        EXPECT_LE(distance(&pose.model_space()[joint][0][0], joints[joint], 0), tolerance) << "joint " << joint;
    const nlohmann::json& meshes = wanted.at("meshes");
    ASSERT_EQ(meshes.size(), model.meshes().size());
    for (std::uint32_t number = 0; number < meshes.size(); ++number) {
        std::vector<glm::vec3> positions(model.meshes()[number].vertices);
        ASSERT_EQ(meshes[number].at("vertices"), positions.size());
        ASSERT_TRUE(skin(pose, {.mesh = number, .out = {.positions = positions}}));
        for (const nlohmann::json& vertex : meshes[number].at("positions")) {
            const auto place = vertex.at(0).get<std::size_t>();
            EXPECT_LE(distance(&positions[place].x, vertex, 1), tolerance) << "mesh " << number << " vertex " << place;
        }
    }
}

TEST(Compat, OldFilesAreValid) {
    EXPECT_GE(all_files().size(), 12u);
    for (const auto& path : all_files()) {
        const Result<MappedFile> file = MappedFile::open(path);
        ASSERT_TRUE(file.has_value()) << path;
        const Faults faults = validate(file->bytes());
        for (const Error& fault : faults.list())
            ADD_FAILURE() << path << ": " << describe_with_place(fault, file->bytes());
    }
}

TEST(Compat, OldFilesMoveAsTheyDid) {
    for (const auto& path : all_files()) {
        SCOPED_TRACE(path.string());
        const nlohmann::json poses = read_poses(path);
        if (poses.at("poses").empty()) continue;  // without an object
        const Result<Model> model = Model::open(path);
        ASSERT_TRUE(model.has_value()) << describe(model.error());
        for (const nlohmann::json& pose : poses.at("poses"))
            expect_pose(*model, pose, poses.at("tolerance").get<double>());
    }
}

}  // namespace
}  // namespace bendy::compat_test
