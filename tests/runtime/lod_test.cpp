#include <bendy/runtime/lod.h>
#include <bendy/runtime/skin.h>

#include "build_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <random>
#include <set>

namespace bendy::test::lod_test {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

JointSpec plain_joint(std::vector<SubmeshRecord> submeshes) {
    JointSpec joint;
    joint.submeshes = std::move(submeshes);
    return joint;
}

/// A mesh of random triangles with a random sequence; not pretty, but everything that may come.
struct RandomMesh {
    RandomMesh(std::uint32_t seed, std::uint32_t all, std::uint32_t kept, std::uint32_t triangles)
        : base(kept), vertices(all) {
        std::mt19937 random(seed);
        const auto below = [&](std::uint32_t limit) { return static_cast<std::uint32_t>(random() % limit); };
        for (std::uint32_t v = base; v < vertices; ++v) targets.push_back(below(v));
        for (std::uint32_t k = 0; k < triangles * 3; ++k) indices.push_back(below(vertices));
    }

    [[nodiscard]] MeshSpec spec() const {
        MeshSpec mesh;
        mesh.joint = 0;
        for (std::uint32_t v = 0; v < vertices; ++v) mesh.positions.emplace_back(v, 2 * v, 3 * v);
        mesh.indices = indices;
        return mesh;
    }
    /// Where a vertex goes, one step after another.
    [[nodiscard]] std::uint32_t at(std::uint32_t vertex, std::uint32_t alive) const {
        while (vertex >= alive) vertex = targets[vertex - base];
        return vertex;
    }
    /// The triangles from index `first` on that are left.
    [[nodiscard]] std::vector<Triangle> expected(std::size_t first, std::size_t count, std::uint32_t alive) const {
        std::vector<Triangle> list;
        for (std::size_t k = first; k < first + count; k += 3) {
            const Triangle t{at(indices[k], alive), at(indices[k + 1], alive), at(indices[k + 2], alive)};
            const bool is_flat = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
            if (!is_flat || alive == vertices) list.push_back(t);
        }
        return list;
    }

    std::uint32_t base, vertices;
    std::vector<std::uint32_t> targets, indices;
};

std::vector<Triangle> drawn(const Lod& lod, const Submesh& submesh) {
    std::vector<Triangle> list;
    const auto indices = lod.indices(submesh.mesh).subspan(submesh.first, submesh.count);
    for (std::size_t k = 0; k + 3 <= indices.size(); k += 3)
        list.push_back({indices[k], indices[k + 1], indices[k + 2]});
    return list;
}

TEST(Lod, EveryLevelIsWhatAPlainWalkGives) {
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
        const RandomMesh mesh(seed, 60, 4 + seed, 90);
        const Owned model(
            build_file({{plain_joint({submesh(0, 0, 120), submesh(0, 123, 147)})},
                        {mesh.spec()},
                        {},
                        {make_leaf(FourCC("LODD"), collapse_payload<std::uint16_t>(
                                                       0, mesh.base, {mesh.targets.begin(), mesh.targets.end()}))}}));
        Lod lod(*model);
        std::set<std::uint32_t> seen;
        for (int step = 200; step >= 0; --step) {
            const float share = static_cast<float>(step) / 200.0f;
            lod.set_share(share);
            const std::uint32_t alive = lod.vertices(0);
            seen.insert(alive);
            ASSERT_EQ(lod.submeshes().size(), 2u);
            EXPECT_EQ(drawn(lod, lod.submeshes()[0]), mesh.expected(0, 120, alive));
            EXPECT_EQ(drawn(lod, lod.submeshes()[1]), mesh.expected(123, 147, alive));
            EXPECT_EQ(lod.triangles(), lod.submeshes()[0].count / 3 + lod.submeshes()[1].count / 3);
            for (const std::uint32_t index : lod.indices(0)) ASSERT_LT(index, alive);
            EXPECT_EQ(lod.indices(0).size(), lod.triangles() * 3);
            if (alive > mesh.base) {
                EXPECT_LE(lod.triangles(), static_cast<std::uint64_t>(share * 89.0f + 0.001f));
            }
        }
        EXPECT_TRUE(seen.contains(60));
        EXPECT_TRUE(seen.contains(mesh.base));
        EXPECT_GT(seen.size(), 12u);
    }
}

/// A square of two triangles and a spare vertex, on which 3 and 4 collapse.
ModelSpec square(std::vector<std::uint16_t> targets, std::vector<std::uint8_t> joined = {}) {
    MeshSpec mesh;
    mesh.joint = 0;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5f, 0.5f, 0}};
    mesh.indices = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 0, 1, 2};
    const auto base = static_cast<std::uint32_t>(5 - targets.size());
    return {{plain_joint({submesh(0, 0, 12), submesh(0, 12, 2, kNone, Topology::lines),
                          submesh(0, 14, 1, kNone, Topology::points)})},
            {mesh},
            {},
            {make_leaf(FourCC("LODD"), collapse_payload<std::uint16_t>(0, base, targets, {}, joined))}};
}

TEST(Lod, TheSpecificationsExample) {
    const Owned model(build_file(square({2, 1})));
    Lod lod(*model);
    EXPECT_EQ(lod.triangles(), 4u);
    lod.set_share(0.5f);
    EXPECT_EQ(lod.vertices(0), 4u);
    EXPECT_EQ(drawn(lod, lod.submeshes()[0]), (std::vector<Triangle>{{2, 3, 1}, {3, 0, 1}}));
    lod.set_share(0.3f);
    EXPECT_EQ(lod.vertices(0), 3u);
    EXPECT_EQ(drawn(lod, lod.submeshes()[0]), (std::vector<Triangle>{{2, 0, 1}}));
}

TEST(Lod, LinesAndPointsStayAndAreNotCounted) {
    const Owned model(build_file(square({2, 1})));
    Lod lod(*model);
    for (const float share : {1.0f, 0.5f, 0.0f}) {
        lod.set_share(share);
        ASSERT_EQ(lod.submeshes().size(), 3u);
        const auto line = lod.indices(0).subspan(lod.submeshes()[1].first, lod.submeshes()[1].count);
        EXPECT_EQ(std::vector<std::uint32_t>(line.begin(), line.end()), (std::vector<std::uint32_t>{0, 1}));
        EXPECT_EQ(lod.submeshes()[2].count, 1u);
        EXPECT_EQ(lod.indices(0)[lod.submeshes()[2].first], 2u);
    }
    EXPECT_EQ(lod.triangles(), 1u);
}

TEST(Lod, VerticesThatGoTogetherAreNotParted) {
    const Owned model(build_file(square({2, 1}, {0b10})));
    Lod lod(*model);
    for (int step = 0; step <= 20; ++step) {
        lod.set_share(static_cast<float>(step) / 20.0f);
        EXPECT_NE(lod.vertices(0), 4u);
    }
}

TEST(Lod, StrangeSharesAreFullDetailOrTheLeast) {
    const Owned model(build_file(square({2, 1})));
    Lod lod(*model);
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const float share : {std::numeric_limits<float>::quiet_NaN(), 1.0f, 2.0f, kInfinity}) {
        lod.set_share(0.0f);
        lod.set_share(share);
        EXPECT_EQ(lod.vertices(0), 5u) << share;
        EXPECT_EQ(lod.triangles(), 4u) << share;
    }
    for (const float share : {0.0f, -1.0f, -kInfinity}) {
        lod.set_share(share);
        EXPECT_EQ(lod.vertices(0), 3u) << share;
    }
}

TEST(Lod, AModelWithoutASequenceHasOneLevel) {
    ModelSpec spec = square({2, 1});
    spec.more.clear();
    const Owned model(build_file(spec));
    EXPECT_EQ(model->collapse(), nullptr);
    Lod lod(*model);
    lod.set_share(0.0f);
    EXPECT_EQ(lod.vertices(0), 5u);
    EXPECT_EQ(lod.triangles(), 4u);
    EXPECT_EQ(lod.indices(0).size(), 15u);
    EXPECT_EQ(lod.error(), 0.0f);
}

TEST(Lod, TheTableSpreadsDetailOverMeshes) {
    const RandomMesh first(1, 40, 4, 100);
    const RandomMesh second(2, 40, 4, 100);
    CollapseRecord record;
    record.meshes = 2;
    record.levels = 3;
    std::vector<MeshCollapseRecord> meshes(2);
    for (std::uint32_t k = 0; k < 2; ++k) meshes[k] = {k, 4, 2, {}};
    struct Row {
        float error;
        std::uint32_t alive[2];
    };
    Buffer payload;
    append_padded(payload, std::vector{record});
    append_padded(payload, meshes);
    append_padded(payload, std::vector<Row>{{0.0f, {40, 40}}, {0.25f, {4, 40}}, {0.5f, {4, 4}}});
    for (const RandomMesh* mesh : {&first, &second}) {
        append_padded(payload, std::vector<std::uint16_t>(mesh->targets.begin(), mesh->targets.end()));
        append_padded(payload, std::vector<std::uint8_t>(5, 0));
    }
    const Owned model(build_file({{plain_joint({submesh(0, 0, 300), submesh(1, 0, 300)})},
                                  {first.spec(), second.spec()},
                                  {},
                                  {make_leaf(FourCC("LODD"), payload)}}));
    Lod lod(*model);
    for (int step = 100; step >= 0; --step) {
        lod.set_share(static_cast<float>(step) / 100.0f);
        // The first goes all the way before the second begins.
        EXPECT_TRUE(lod.vertices(0) == 4 || lod.vertices(1) == 40) << step;
        EXPECT_EQ(lod.error(), lod.vertices(1) < 40 ? 0.5f : lod.vertices(0) < 40 ? 0.25f : lod.error()) << step;
    }
    EXPECT_EQ(lod.vertices(1), 4u);
}

TEST(Lod, LongChainsOfTargetsTakeNoLonger) {
    constexpr std::uint32_t kVertices = 200'000;
    MeshSpec mesh;
    mesh.joint = 0;
    mesh.positions.resize(kVertices);
    std::vector<std::uint32_t> targets;
    for (std::uint32_t v = 1; v < kVertices; ++v) targets.push_back(v - 1);
    for (std::uint32_t k = 0; k < kVertices; ++k)
        mesh.indices.insert(mesh.indices.end(), {kVertices - 1, kVertices / 2, k % 7});
    const Owned model(build_file({{plain_joint({submesh(0, 0, kVertices * 3)})},
                                  {mesh},
                                  {},
                                  {make_leaf(FourCC("LODD"), collapse_payload<std::uint32_t>(0, 1, targets))}}));
    Lod lod(*model);
    lod.set_share(0.5f);
    EXPECT_LE(lod.triangles(), kVertices / 2);
    lod.set_share(0.0f);
    EXPECT_EQ(lod.triangles(), 0u);
}

TEST(Lod, SkinsOnlyTheLivingVertices) {
    ModelSpec spec = square({2, 1});
    spec.joints[0].rest = moved(10, 0, 0);
    const std::vector<glm::vec3> up(5, glm::vec3(0, 0, 1));
    Node target =
        make_container(FourCC("TARG"), {make_leaf(FourCC("TINF"), bytes_of(MorphTargetRecord{0.5f})),
                                        make_leaf(FourCC("INDX"), stream_payload<std::uint16_t>(1, {1, 2, 4})),
                                        vector_stream(FourCC("POSI"), std::vector<glm::vec3>(3, {0, 0, 2}))});
    spec.meshes[0].more = {target};
    const Owned model(build_file(spec));
    Pose pose(*model);
    std::vector<glm::vec3> all(5);
    ASSERT_TRUE(skin(pose, {.out = {.positions = all}}));
    Lod lod(*model);
    for (const float share : {1.0f, 0.5f, 0.0f}) {
        lod.set_share(share);
        const glm::vec3 untouched(77.0f);
        std::vector<glm::vec3> some(5, untouched);
        ASSERT_TRUE(skin(pose, {.lod = &lod, .out = {.positions = some}}));
        for (std::uint32_t v = 0; v < 5; ++v) EXPECT_EQ(some[v], v < lod.vertices(0) ? all[v] : untouched) << v;
        std::vector<glm::vec3> exact(lod.vertices(0));
        EXPECT_TRUE(skin(pose, {.mesh = 0, .lod = &lod, .out = {.positions = exact}}));
        exact.pop_back();
        EXPECT_FALSE(skin(pose, {.mesh = 0, .lod = &lod, .out = {.positions = exact}}));
    }
}

}  // namespace
}  // namespace bendy::test::lod_test
