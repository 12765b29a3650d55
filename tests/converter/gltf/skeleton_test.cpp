#include "build_gltf.h"

#include <gtest/gtest.h>

namespace bendy::converter::skeleton_test {
namespace {

using namespace test;

/// "name<parent's name" of each joint in order.
std::vector<std::string> tree_of(const Scene& scene) {
    std::vector<std::string> lines;
    for (const Joint& joint : scene.joints) {
        lines.push_back(joint.parent == kNone ? joint.name : joint.name + '<' + scene.joints[joint.parent].name);
    }
    return lines;
}

Import import_nodes(const std::string& members, const GltfOptions& options = {}) {
    return import_text(R"({"asset":{"version":"2.0"},)" + members + "}", options);
}

TEST(GltfSkeleton, IsInPreOrderWithSiblingsAsInTheSource) {
    const Import import =
        import_nodes(R"("scenes":[{"name":"S","nodes":[3,0]}],"nodes":[{"name":"a","children":[2,1]},{"name":"b"},)"
                     R"({"name":"c","children":[4]},{"name":"d"},{"name":"e"}])");
    EXPECT_EQ(tree_of(*import), (std::vector<std::string>{"d", "a", "c<a", "e<c", "b<a"}));
    EXPECT_EQ(import->name, "S");
}

TEST(GltfSkeleton, WithoutScenesAllRootsAreTaken) {
    const Import import = import_nodes(R"("nodes":[{"name":"a"},{"name":"b","children":[2]},{"name":"c"}])");
    EXPECT_EQ(tree_of(*import), (std::vector<std::string>{"a", "b", "c<b"}));
}

TEST(GltfSkeleton, SceneByDefaultByNameAndByIndex) {
    const std::string members =
        R"("scene":1,"scenes":[{"name":"one","nodes":[0]},{"name":"two","nodes":[1]}],"nodes":[{"name":"a"},{"name":"b"}])";
    EXPECT_EQ(tree_of(*import_nodes(members)), (std::vector<std::string>{"b"}));
    GltfOptions options;
    options.scene = "one";
    EXPECT_EQ(tree_of(*import_nodes(members, options)), (std::vector<std::string>{"a"}));
    options.scene = "0";
    EXPECT_EQ(tree_of(*import_nodes(members, options)), (std::vector<std::string>{"a"}));
    for (const char* name : {"three", "2", "-1", "", "1x"}) {
        options.scene = name;
        EXPECT_EQ(import_nodes(members, options).message(),
                  "there is no scene \"" + std::string(name) + "\"; there are \"one\" and \"two\"");
    }
}

TEST(GltfSkeleton, NodesOutsideTheSceneAreCounted) {
    const Import import = import_nodes(R"("scenes":[{"nodes":[0]}],"nodes":[{"name":"a"},{"name":"b"},{"name":"c"}])");
    EXPECT_EQ(tree_of(*import), (std::vector<std::string>{"a"}));
    EXPECT_EQ(import.warned("outside the chosen scene"), 2u);
}

TEST(GltfSkeleton, SceneRootsThatHaveParentsKeepThem) {
    const Import import = import_nodes(
        R"("scenes":[{"nodes":[1]}],"nodes":[{"name":"a","translation":[1,0,0],"children":[1,2]},{"name":"b"},{"name":"c"}])");
    EXPECT_EQ(tree_of(*import), (std::vector<std::string>{"a", "b<a"}));
    EXPECT_EQ(import.warned("lists a node that has a parent"), 1u);
}

TEST(GltfSkeleton, JointsOfSkinsOutsideTheSceneComeWithTheirAncestors) {
    Gltf gltf = make_skinned(2, {{{1, 0, 0, 0}, {1, 0, 0, 0}}});
    gltf.json["nodes"][0]["children"].push_back(gltf.add_node({{"name", "not needed"}}));
    gltf.json["scenes"] = {{{"nodes", {2}}}};
    const Import import = gltf.import();
    ASSERT_EQ(import->joints.size(), 3u);
    EXPECT_EQ(import->joints[2].parent, 1u);
    EXPECT_EQ(import->meshes.at(0).palette.joints, (std::vector<std::uint32_t>{1, 2}));
}

TEST(GltfSkeleton, MeshesOfAncestorsOutsideTheSceneAreNotDrawn) {
    Gltf gltf = make_triangle();
    gltf.json["nodes"][0]["children"] = {1};
    gltf.add_node({{"mesh", 0}});
    gltf.json["scenes"] = {{{"nodes", {1}}}};
    const Import import = gltf.import();
    EXPECT_EQ(import->joints.size(), 2u);
    ASSERT_EQ(import->meshes.size(), 1u);
    EXPECT_EQ(import->meshes[0].joint, 1u);
}

TEST(GltfSkeleton, CyclesAndSecondParentsAreRefused) {
    const auto error_of = [](const std::string& nodes) {
        const Import import = import_nodes("\"nodes\":" + nodes);
        return import.place() + ": " + import.message();
    };
    EXPECT_EQ(error_of(R"([{},{"children":[2]},{"children":[1]}])"), "nodes[1]: the node is its own ancestor (a loop)");
    EXPECT_EQ(error_of(R"([{"children":[0]}])"), "nodes[0]: the node is its own ancestor (a loop)");
    EXPECT_EQ(error_of(R"([{"children":[2]},{"children":[2]},{}])"),
              "nodes[1].children[0]: node 2 has two parents, the other is node 0");
    EXPECT_EQ(error_of(R"([{"children":[1,1]},{}])"),
              "nodes[0].children[1]: node 1 has two parents, the other is node 0");
}

TEST(GltfSkeleton, EmptyScenesAreRefused) {
    EXPECT_EQ(import_nodes(R"("scenes":[{}],"nodes":[{}])").place(), "scenes[0]");
    EXPECT_EQ(import_nodes(R"("extras":0)").message(), "there is nothing to convert: the scene has no nodes");
}

TEST(GltfSkeleton, HierarchiesMayBeDeep) {
    constexpr std::size_t kDepth = 10'000;
    Json nodes = Json::array();
    for (std::size_t i = 0; i < kDepth; ++i)
        nodes.push_back(i + 1 < kDepth ? Json{{"children", {i + 1}}} : Json::object());
    const Import import = import_nodes("\"nodes\":" + nodes.dump());
    ASSERT_EQ(import->joints.size(), kDepth);
    for (std::uint32_t i = 1; i < kDepth; ++i) ASSERT_EQ(import->joints[i].parent, i - 1);
}

TEST(GltfSkeleton, RotationsAreUnit) {
    const Import import =
        import_nodes(R"("nodes":[{"rotation":[0,0,0,2]},{"rotation":[0,0,0,0]},{"rotation":[0.6,0,0,0.8]}])");
    EXPECT_EQ(import->joints[0].rest.rotation, glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(import->joints[1].rest.rotation, glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(import->joints[2].rest.rotation, glm::vec4(0.6f, 0, 0, 0.8f));
    EXPECT_EQ(import.warned("rotation of a node is not a unit quaternion"), 1u);
    EXPECT_EQ(import.warned("rotation of a node is (0, 0, 0, 0)"), 1u);
}

TEST(GltfSkeleton, MatricesMustBeAffine) {
    const Import import = import_nodes(R"("nodes":[{},{"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0.5, 0,0,0,1]}])");
    EXPECT_EQ(import.place(), "nodes[1].matrix");
    const Import good = import_nodes(R"("nodes":[{"matrix":[2,0,0,0, 0,-1,0,0, 0,0,1,0, 4,5,6,1]}])");
    EXPECT_EQ(good->joints.at(0).rest.translation, glm::vec3(4, 5, 6));
}

TEST(GltfSkeleton, NamesAreKeptAsTheyAre) {
    const std::vector<std::string> names = {"",
                                            "a/b",
                                            "..",
                                            "\xe9\xaa\xa8",
                                            "\xd0\x9a\xd0\xbe\xd1\x81\xd1\x82\xd1\x8c",
                                            "same",
                                            "same",
                                            std::string("nul\0inside", 10),
                                            "\xef\xbb\xbfmark",
                                            std::string(5000, 'x')};
    Json nodes = Json::array();
    for (const std::string& name : names) nodes.push_back({{"name", name}});
    const Import import = import_nodes("\"nodes\":" + nodes.dump());
    ASSERT_EQ(import->joints.size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(import->joints[i].name, names[i]);
}

}  // namespace
}  // namespace bendy::converter::skeleton_test
