#include "optimise/collapse/collapse_vertices.h"
#include "optimise/compact/compact_geometry.h"
#include "source_folder.h"

#include <bendy/converter/import.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace bendy::converter::order_levels_test {
namespace {

/// How many of the levels' counts are at most `vertex`: the same for two vertices between the same two levels.
std::size_t level_of(const Scene& scene, std::size_t mesh, std::uint32_t vertex) {
    std::size_t level = vertex < scene.meshes[mesh].base ? 0 : 1;
    for (const LodLevel& one : scene.levels) level += one.alive[mesh] <= vertex ? 1 : 0;
    return level;
}

TEST(OrderLevels, VerticesStayBetweenTheirLevelsBehindWhatTheyCollapseOnto) {
    Report report;
    auto exact = import_gltf(source_folder() / "examples" / "mannequin.glb", {}, report);
    ASSERT_TRUE(exact.has_value());
    collapse_vertices(*exact);
    Scene scene = *exact;
    const CompactGeometry geometry = compact_geometry(scene, 1e-3, {});
    std::size_t moved = 0;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const Mesh& before = exact->meshes[m];
        const Mesh& after = scene.meshes[m];
        const std::vector<std::uint32_t>& place_of = geometry.meshes[m].vertex_of;
        std::vector<std::uint32_t> sorted = place_of;
        std::sort(sorted.begin(), sorted.end());
        for (std::uint32_t v = 0; v < before.collapse.size(); ++v) {
            const std::uint32_t place = place_of[v];
            ASSERT_EQ(sorted[v], v);
            moved += place != v ? 1 : 0;
            ASSERT_EQ(level_of(*exact, m, v), level_of(*exact, m, place));
            ASSERT_EQ(after.collapse[place], place_of[before.collapse[v]]);
            ASSERT_EQ(after.joined[place], before.joined[v]);
            ASSERT_TRUE(before.joined[v] == 0 || place == place_of[v - 1] + 1);
            ASSERT_TRUE(v < before.base || after.collapse[v] < v);
            ASSERT_LT(glm::distance(after.positions[place], before.positions[v]), 1e-3f);
        }
        EXPECT_EQ(after.base, before.base);
    }
    EXPECT_GT(moved, 1000u);
}

}  // namespace
}  // namespace bendy::converter::order_levels_test
