#include "optimise/collapse/collapse_vertices.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/format/document.h>
#include <bendy/runtime.h>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <vector>

namespace bendy::converter::collapse_vertices_test {
namespace {

using Place = std::tuple<float, float, float>;
using Edges = std::map<std::pair<Place, Place>, int>;

Place place_of(const glm::vec3& p) {
    return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
}

Scene scene_of(std::vector<Mesh> meshes) {
    Scene scene;
    scene.joints.emplace_back();
    scene.meshes = std::move(meshes);
    for (Mesh& mesh : scene.meshes) mesh.joint = 0;
    scene.materials.resize(3);
    return scene;
}

/// A sphere of `rings` rings of `rings` quads. With `seam` the vertices of the meridian are doubled and have texture
/// coordinates that jump there; without, the sphere is closed in its vertices too.
Mesh sphere(std::uint32_t rings, bool seam) {
    Mesh mesh;
    const std::uint32_t columns = seam ? rings + 1 : rings;
    Stream coords{"", 0, 2, {}};
    const auto add = [&](float u, float v) {
        const float a = u == 1.0f ? 0.0f : 2.0f * 3.14159265f * u;
        const float b = 3.14159265f * v;
        const glm::vec3 p(std::cos(a) * std::sin(b), std::cos(b), std::sin(a) * std::sin(b));
        mesh.positions.push_back(p);
        mesh.normals.push_back(p);
        coords.values.insert(coords.values.end(), {u, v});
    };
    for (std::uint32_t row = 1; row < rings; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            add(static_cast<float>(column) / static_cast<float>(rings),
                static_cast<float>(row) / static_cast<float>(rings));
        }
    }
    const auto north = static_cast<std::uint32_t>(mesh.positions.size());
    add(0.5f, 0.0f);
    mesh.positions.back() = {0, 1, 0};
    add(0.5f, 1.0f);
    mesh.positions.back() = {0, -1, 0};
    Submesh submesh;
    for (std::uint32_t column = 0; column < rings; ++column) {
        const std::uint32_t next = seam ? column + 1 : (column + 1) % columns;
        submesh.indices.insert(submesh.indices.end(), {north, next, column});
        for (std::uint32_t row = 0; row + 2 < rings; ++row) {
            const std::uint32_t a = row * columns + column;
            const std::uint32_t b = row * columns + next;
            submesh.indices.insert(submesh.indices.end(), {a, b, a + columns, b, b + columns, a + columns});
        }
        const std::uint32_t last = (rings - 2) * columns;
        submesh.indices.insert(submesh.indices.end(), {north + 1, last + column, last + next});
    }
    mesh.submeshes.push_back(submesh);
    if (seam) mesh.texture_coords.push_back(coords);
    return mesh;
}

/// A wavy square of n by n quads.
Mesh sheet(std::uint32_t n) {
    Mesh mesh;
    Submesh submesh;
    for (std::uint32_t y = 0; y <= n; ++y) {
        for (std::uint32_t x = 0; x <= n; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(n);
            const float v = static_cast<float>(y) / static_cast<float>(n);
            mesh.positions.emplace_back(u, v, 0.1f * std::sin(6.0f * u) * std::cos(5.0f * v));
            if (x == n || y == n) continue;
            const std::uint32_t at = y * (n + 1) + x;
            submesh.indices.insert(submesh.indices.end(), {at, at + 1, at + n + 2, at, at + n + 2, at + n + 1});
        }
    }
    mesh.submeshes.push_back(submesh);
    return mesh;
}

/// Edges by place, and in how many triangles each is.
Edges edges_of(const Model& model, const Lod& lod, std::uint32_t mesh) {
    Edges edges;
    const auto positions = model.meshes()[mesh].positions.as<float>();
    const auto at = [&](std::uint32_t v) {
        return Place{positions[v * 3] + 0.0f, positions[v * 3 + 1] + 0.0f, positions[v * 3 + 2] + 0.0f};
    };
    for (const bendy::Submesh& submesh : lod.submeshes()) {
        if (submesh.mesh != mesh || submesh.topology != Topology::triangles) continue;
        const auto indices = lod.indices(mesh).subspan(submesh.first, submesh.count);
        for (std::size_t k = 0; k < indices.size(); k += 3) {
            for (std::size_t side = 0; side < 3; ++side) {
                Place a = at(indices[k + side]);
                Place b = at(indices[k + (side + 1) % 3]);
                if (b < a) std::swap(a, b);
                ++edges[{a, b}];
            }
        }
    }
    return edges;
}

std::size_t count_borders(const Edges& edges) {
    return static_cast<std::size_t>(
        std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second == 1; }));
}

struct Built {
    explicit Built(Scene made) : scene(std::move(made)) {
        collapse_vertices(scene);
        Report report;
        bytes = build_chunks(scene, "test", report);
        EXPECT_TRUE(validate(bytes).empty());
        auto opened = Model::from_memory(bytes);
        model = std::make_unique<Model>(*std::move(opened));
    }
    Scene scene;
    std::vector<std::byte> bytes;
    std::unique_ptr<Model> model;
};

/// Every triangle as places, sorted.
std::vector<std::array<Place, 3>> triangles_of(const Mesh& mesh) {
    std::vector<std::array<Place, 3>> list;
    for (const Submesh& submesh : mesh.submeshes) {
        for (std::size_t k = 0; k + 3 <= submesh.indices.size(); k += 3) {
            std::array<Place, 3> t{};
            for (std::size_t c = 0; c < 3; ++c) t[c] = place_of(mesh.positions[submesh.indices[k + c]]);
            list.push_back(t);
        }
    }
    return list;
}

void expect_good(const Mesh& mesh) {
    ASSERT_EQ(mesh.collapse.size(), mesh.positions.size());
    for (std::uint32_t v = 0; v < mesh.collapse.size(); ++v) {
        if (v < mesh.base) {
            EXPECT_EQ(mesh.collapse[v], v);
        } else {
            EXPECT_LT(mesh.collapse[v], v);
        }
    }
}

TEST(CollapseVertices, AClosedSphereStaysClosedToTheEnd) {
    const Built built(scene_of({sphere(24, false)}));
    expect_good(built.scene.meshes[0]);
    Lod lod(*built.model);
    for (int step = 50; step >= 0; --step) {
        lod.set_share(static_cast<float>(step) / 50.0f);
        for (const auto& [edge, count] : edges_of(*built.model, lod, 0)) ASSERT_EQ(count, 2) << step;
    }
    EXPECT_LE(lod.triangles(), 20u);
    EXPECT_GE(lod.triangles(), 4u);
}

TEST(CollapseVertices, NoCrackOpensAtASeam) {
    const Built built(scene_of({sphere(24, true)}));
    const Mesh& mesh = built.scene.meshes[0];
    expect_good(mesh);
    EXPECT_GT(std::count(mesh.joined.begin(), mesh.joined.end(), 1), 10);
    Lod lod(*built.model);
    for (std::uint32_t n = 100; n-- > 0;) {
        lod.set_share(static_cast<float>(n) / 100.0f);
        EXPECT_EQ(count_borders(edges_of(*built.model, lod, 0)), 0u) << n;
        // Down to a fifth next to no triangle spans the texture's jump; at the poles a turn is no way.
        if (n < 20) continue;
        std::size_t jumps = 0;
        const auto indices = lod.indices(0);
        const StreamView& coords = built.model->meshes()[0].texture_coords[0];
        for (std::size_t k = 0; k < indices.size(); k += 3) {
            const float a = coords.number(indices[k], 0);
            const float b = coords.number(indices[k + 1], 0);
            const float c = coords.number(indices[k + 2], 0);
            jumps += std::max({a, b, c}) - std::min({a, b, c}) > 0.75f ? 1 : 0;
        }
        EXPECT_LE(jumps, 4u) << n;
    }
}

TEST(CollapseVertices, ABorderKeepsItsCornersAndStaysOne) {
    const Built built(scene_of({sheet(20)}));
    Lod lod(*built.model);
    const std::size_t whole = count_borders(edges_of(*built.model, lod, 0));
    EXPECT_EQ(whole, 80u);
    for (int step = 40; step >= 2; --step) {
        lod.set_share(static_cast<float>(step) / 40.0f);
        const Edges edges = edges_of(*built.model, lod, 0);
        EXPECT_LE(count_borders(edges), whole);
        std::set<Place> places;
        for (const auto& [edge, count] : edges) places.insert({edge.first, edge.second});
        for (const float x : {0.0f, 1.0f}) {
            for (const float y : {0.0f, 1.0f}) {
                const bool has_corner = std::any_of(places.begin(), places.end(), [&](const Place& p) {
                    return std::get<0>(p) == x && std::get<1>(p) == y;
                });
                EXPECT_TRUE(has_corner) << step;
            }
        }
    }
}

TEST(CollapseVertices, ReordersEveryStreamAndKeepsEveryTriangle) {
    Mesh mesh = sphere(12, true);
    const std::size_t vertices = mesh.positions.size();
    mesh.tangents.resize(vertices);
    mesh.attributes.push_back({"_ID", 0, 1, std::vector<float>(vertices)});
    mesh.colours.push_back({"", 0, 4, std::vector<float>(vertices * 4, 1.0f)});
    mesh.targets.emplace_back();
    mesh.targets[0].positions.resize(vertices);
    mesh.influences = 1;
    mesh.bones.assign(vertices, 0);
    mesh.weights.assign(vertices, 1.0f);
    mesh.palette = {{0}, {glm::mat4(1.0f)}};
    for (std::size_t v = 0; v < vertices; ++v) {
        const auto id = static_cast<float>(v);
        mesh.tangents[v] = {id, 0, 0, 1};
        mesh.attributes[0].values[v] = id;
        mesh.colours[0].values[v * 4 + 1] = id / 1000.0f;
        mesh.targets[0].positions[v] = {0, 0.001f * id, 0};
    }
    const Mesh before = mesh;
    Scene scene = scene_of({mesh});
    collapse_vertices(scene);
    const Mesh& after = scene.meshes[0];
    EXPECT_EQ(triangles_of(after), triangles_of(before));
    for (std::size_t v = 0; v < vertices; ++v) {
        const auto old = static_cast<std::size_t>(after.attributes[0].values[v]);
        EXPECT_EQ(after.positions[v], before.positions[old]);
        EXPECT_EQ(after.normals[v], before.normals[old]);
        EXPECT_EQ(after.tangents[v], before.tangents[old]);
        EXPECT_EQ(after.colours[0].values[v * 4 + 1], before.colours[0].values[old * 4 + 1]);
        EXPECT_EQ(after.texture_coords[0].values[v * 2], before.texture_coords[0].values[old * 2]);
        EXPECT_EQ(after.targets[0].positions[v], before.targets[0].positions[old]);
    }
}

TEST(CollapseVertices, MaterialsKeepTheirBorder) {
    Mesh mesh = sheet(16);
    Submesh left;
    Submesh right;
    right.material = 1;
    left.material = 0;
    for (std::size_t k = 0; k < mesh.submeshes[0].indices.size(); k += 3) {
        float x = 0.0f;
        for (std::size_t c = 0; c < 3; ++c) x += mesh.positions[mesh.submeshes[0].indices[k + c]].x;
        Submesh& submesh = x < 1.5f ? left : right;
        for (std::size_t c = 0; c < 3; ++c) submesh.indices.push_back(mesh.submeshes[0].indices[k + c]);
    }
    mesh.submeshes = {left, right};
    const Built built(scene_of({mesh}));
    Lod lod(*built.model);
    const auto positions = built.model->meshes()[0].positions.as<float>();
    for (int step = 20; step >= 0; --step) {
        lod.set_share(static_cast<float>(step) / 20.0f);
        for (const bendy::Submesh& submesh : lod.submeshes()) {
            for (const std::uint32_t v : lod.indices(0).subspan(submesh.first, submesh.count)) {
                const float x = positions[std::size_t{v} * 3];
                EXPECT_TRUE(submesh.material == 0 ? x <= 0.5f : x >= 0.5f);
            }
        }
    }
    EXPECT_LT(lod.triangles(), 40u);
}

TEST(CollapseVertices, TargetsArePartOfTheMetric) {
    // A flat sheet whose middle rises with the target: what is flat at rest must not be thrown away there.
    Mesh mesh = sheet(20);
    for (glm::vec3& p : mesh.positions) p.z = 0.0f;
    MorphTarget target;
    for (const glm::vec3& p : mesh.positions) {
        const float apart = glm::length(glm::vec2(p) - glm::vec2(0.25f));
        target.positions.emplace_back(0.0f, 0.0f, std::max(0.0f, 0.2f - apart));
    }
    mesh.targets.push_back(target);
    Scene scene = scene_of({mesh});
    collapse_vertices(scene);
    const Mesh& after = scene.meshes[0];
    float lowest_peak = 0.0f;
    for (std::uint32_t v = 0; v < 60; ++v) lowest_peak = std::max(lowest_peak, after.targets[0].positions[v].z);
    EXPECT_GT(lowest_peak, 0.19f);
}

TEST(CollapseVertices, StrangeMeshesSurvive) {
    Mesh fins =
        sheet(6);  // a third triangle on an edge, a bow tie, degenerate and doubled triangles, lines, loose vertices
    const auto first = static_cast<std::uint32_t>(fins.positions.size());
    fins.positions.insert(fins.positions.end(), {{0.5f, 0.5f, 1}, {2, 2, 2}, {3, 3, 3}, {2, 3, 2}, {9, 9, 9}});
    auto& list = fins.submeshes[0].indices;
    list.insert(list.end(),
                {8, 9, first, 0, 0, 1, 3, 3, 3, 0, first + 1, first + 2, 0, 1, 8, 8, 1, 0, first, first, first});
    Submesh line;
    line.topology = Topology::lines;
    line.indices = {24, first + 3};
    fins.submeshes.push_back(line);
    Mesh one;  // all vertices at one place
    one.positions.assign(30, glm::vec3(1.0f));
    one.submeshes.emplace_back();
    for (std::uint32_t k = 0; k < 30; ++k) one.submeshes[0].indices.push_back(k);
    Mesh loose;  // nothing is drawn
    loose.positions.resize(5);
    Mesh fan;  // one vertex with very many triangles
    fan.positions.emplace_back(0.0f, 0.0f, 1.0f);
    fan.submeshes.emplace_back();
    for (std::uint32_t k = 0; k < 500; ++k) {
        const float a = 2.0f * 3.14159265f * static_cast<float>(k) / 500.0f;
        fan.positions.emplace_back(std::cos(a), std::sin(a), 0.0f);
        fan.submeshes[0].indices.insert(fan.submeshes[0].indices.end(), {0, 1 + k, 1 + (k + 1) % 500});
    }
    const Built built(scene_of({fins, one, loose, fan, Mesh{}}));
    Lod lod(*built.model);
    for (int step = 10; step >= 0; --step) {
        lod.set_share(static_cast<float>(step) / 10.0f);
        for (std::uint32_t mesh = 0; mesh < 5; ++mesh) {
            for (const std::uint32_t v : lod.indices(mesh)) ASSERT_LT(v, lod.vertices(mesh));
        }
    }
    // The line is still from the same place to the same place.
    const bendy::Submesh& submesh =
        *std::find_if(lod.submeshes().begin(), lod.submeshes().end(),
                      [](const bendy::Submesh& d) { return d.topology == Topology::lines; });
    const auto positions = built.model->meshes()[0].positions.as<float>();
    EXPECT_EQ(positions[std::size_t{lod.indices(0)[submesh.first + 1]} * 3], 2.0f);
    EXPECT_LT(lod.vertices(0), fins.positions.size());
}

TEST(CollapseVertices, BordersOfTwoMeshesAtOnePlaceStay) {
    Mesh left = sheet(12);
    Mesh right = sheet(12);
    for (glm::vec3& p : left.positions) p.z = 0.0f;
    for (glm::vec3& p : right.positions) p = {2.0f - p.x, p.y, 0.0f};
    const Built built(scene_of({left, right}));
    Lod lod(*built.model);
    lod.set_share(0.0f);
    std::array<std::set<Place>, 2> shared;
    for (std::uint32_t mesh = 0; mesh < 2; ++mesh) {
        for (const auto& [edge, count] : edges_of(*built.model, lod, mesh)) {
            if (std::get<0>(edge.first) == 1.0f) shared[mesh].insert(edge.first);
            if (std::get<0>(edge.second) == 1.0f) shared[mesh].insert(edge.second);
        }
    }
    EXPECT_EQ(shared[0].size(), 13u);
    EXPECT_EQ(shared[0], shared[1]);
}

TEST(CollapseVertices, ErrorIsNotBelowTheDistanceOfTheVertices) {
    const Built built(scene_of({sphere(24, false)}));
    ASSERT_GE(built.scene.levels.size(), 5u);
    float before = 0.0f;
    for (const LodLevel& level : built.scene.levels) {
        EXPECT_GE(level.error, before);
        before = level.error;
    }
    EXPECT_EQ(built.scene.levels.front().error, 0.0f);
    EXPECT_GT(before, 0.05f);
    EXPECT_LT(before, 2.0f);
}

TEST(CollapseVertices, IsTheSameEachTime) {
    Scene a = scene_of({sphere(16, true), sheet(9)});
    Scene b = a;
    collapse_vertices(a);
    collapse_vertices(b);
    Report report;
    EXPECT_EQ(build_chunks(a, "test", report), build_chunks(b, "test", report));
}

}  // namespace
}  // namespace bendy::converter::collapse_vertices_test
