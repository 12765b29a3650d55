// Where the graphics processor draws every vertex, held against the runtime's own skinning.
#include "camera.h"
#include "frame.h"
#include "opengl.h"
#include "renderer.h"
#include "runtime/build_model.h"
#include "viewer/example_model.h"

#include <bendy/viewer/picture.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace bendy::viewer::vertex_positions_test {
namespace {

constexpr std::uint32_t kSide = 500;

struct Projected {
    double x, y;  ///< pixels from the top left
    double depth;
};

class VertexPositions : public testing::Test {
protected:
    void SetUp() override {
        try {
            context = std::make_unique<OffscreenContext>();
        } catch (const ViewerError& problem) {
            GTEST_SKIP() << problem.what();
        }
    }

    /// The runtime's vertices, projected in double precision.
    static std::vector<Projected> project(const Model& model, Pose& pose, const Camera& camera) {
        std::vector<glm::vec3> positions(model.vertex_count());
        EXPECT_TRUE(skin(pose, {.out = {.positions = positions}}));
        const glm::dmat4 matrix(camera.view_projection());
        std::vector<Projected> out;
        for (const glm::vec3& p : positions) {
            const glm::dvec4 clip = matrix * glm::dvec4(glm::dvec3(p), 1.0);
            out.push_back(
                {(0.5 + 0.5 * clip.x / clip.w) * kSide, (0.5 - 0.5 * clip.y / clip.w) * kSide, clip.z / clip.w});
        }
        return out;
    }

    static std::optional<std::uint32_t> number_at(const Picture& picture, int x, int y) {
        if (x < 0 || y < 0 || x >= static_cast<int>(kSide) || y >= static_cast<int>(kSide)) return std::nullopt;
        const std::uint8_t* pixel =
            &picture.pixels[4 * (static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x))];
        if (pixel[3] == 0) return std::nullopt;
        return pixel[0] | static_cast<std::uint32_t>(pixel[1]) << 8u | static_cast<std::uint32_t>(pixel[2]) << 16u;
    }

    static void expect_same_places(const Model& model, Pose& pose, const Camera& camera, Renderer& renderer) {
        const Frame frame(kSide, kSide, 1, false);
        frame.bind();
        renderer.draw_numbers(pose, camera, false);
        const Picture picture = frame.read(false);
        const std::vector<Projected> expected = project(model, pose, camera);

        std::size_t drawn = 0;
        for (int y = 0; y < static_cast<int>(kSide); ++y) {
            for (int x = 0; x < static_cast<int>(kSide); ++x) {
                const auto number = number_at(picture, x, y);
                if (!number) continue;
                ++drawn;
                ASSERT_LT(*number, expected.size());
                EXPECT_LE(std::abs(expected[*number].x - (x + 0.5)), 1.0) << "vertex " << *number;
                EXPECT_LE(std::abs(expected[*number].y - (y + 0.5)), 1.0) << "vertex " << *number;
            }
        }
        EXPECT_GT(drawn, 0u);
        // Every vertex is there, or one that stands before it in the same pixel.
        std::size_t missing = 0;
        std::size_t outside = 0;
        for (const Projected& vertex : expected) {
            if (!(vertex.x > 1 && vertex.y > 1 && vertex.x < kSide - 1 && vertex.y < kSide - 1)) {
                ++outside;
                continue;
            }
            const auto shows = [&](int x, int y) {
                const auto number = number_at(picture, x, y);
                return number && expected[*number].depth <= vertex.depth + 1e-5;
            };
            bool found = false;
            for (int dy = -1; dy <= 1; ++dy) {
                for (int dx = -1; dx <= 1; ++dx)
                    found = found || shows(static_cast<int>(vertex.x) + dx, static_cast<int>(vertex.y) + dy);
            }
            missing += found ? 0 : 1;
        }
        EXPECT_EQ(missing, 0u) << "of " << expected.size();
        EXPECT_LT(outside, expected.size() / 10 + 1);  // the camera was fitted
    }

    /// The edges meet every vertex of the triangles, and nothing is drawn farther from a box round them than a pixel.
    static void expect_edges_there(const Model& model, Pose& pose, const Camera& camera, Renderer& renderer) {
        const Frame frame(kSide, kSide);
        DrawOptions options;
        options.background = glm::vec4(0.0f);
        options.wireframe = true;  // the surface itself has no back, unless its material says so
        frame.bind();
        renderer.draw(pose, camera, options, {}, {kSide, kSide});
        const Picture picture = frame.read(true);
        const auto is_covered = [&](int x, int y) {
            x = std::clamp(x, 0, static_cast<int>(kSide) - 1);
            y = std::clamp(y, 0, static_cast<int>(kSide) - 1);
            return picture.pixels[4 * (static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x)) + 3] != 0;
        };
        const std::vector<Projected> vertices = project(model, pose, camera);
        double left = kSide;
        double right = 0;
        double top = kSide;
        double bottom = 0;
        for (const Projected& vertex : vertices) {
            left = std::min(left, vertex.x);
            right = std::max(right, vertex.x);
            top = std::min(top, vertex.y);
            bottom = std::max(bottom, vertex.y);
        }
        std::size_t bare = 0;
        for (const Submesh& submesh : model.submeshes()) {
            if (submesh.topology != Topology::triangles) continue;
            for (std::uint32_t k = 0; k < submesh.count; ++k) {
                const Projected& vertex = vertices[model.first_vertex(submesh.mesh) +
                                                   model.meshes()[submesh.mesh].indices->index(submesh.first + k, 0)];
                bool found = false;
                for (int dy = -1; dy <= 1; ++dy) {
                    for (int dx = -1; dx <= 1; ++dx)
                        found = found || is_covered(static_cast<int>(vertex.x) + dx, static_cast<int>(vertex.y) + dy);
                }
                bare += found ? 0 : 1;
            }
        }
        EXPECT_EQ(bare, 0u);
        std::size_t astray = 0;
        for (int y = 0; y < static_cast<int>(kSide); ++y) {
            for (int x = 0; x < static_cast<int>(kSide); ++x) {
                const bool is_near = x + 1 >= left - 1 && x <= right + 1 && y + 1 >= top - 1 && y <= bottom + 1;
                if (!is_near && is_covered(x, y)) ++astray;
            }
        }
        EXPECT_EQ(astray, 0u);
    }

    static void check(const Model& model, const Clip* clip, float share) {
        Pose pose(model);
        if (clip != nullptr) {
            EXPECT_TRUE(sample(pose, clip, clip->start + share * (clip->end - clip->start)));
        }
        const Box box = bounding_box(model, clip);
        Renderer renderer(model, ReadableFolders(), [](const std::string& what) { ADD_FAILURE() << what; });
        for (const CameraOptions& options : {CameraOptions{0.6f, 0.2f, 1.2f}, CameraOptions{-2.2f, -0.5f, 1.2f}}) {
            Camera camera;
            camera.fit(box, options, 1.0f);
            expect_same_places(model, pose, camera, renderer);
            expect_edges_there(model, pose, camera, renderer);
        }
    }

    static void check_file(const std::filesystem::path& file) {
        if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
        const test::ExampleModel model(file);
        check(*model, nullptr, 0.0f);
        for (const Clip& clip : model->clips()) check(*model, &clip, 0.37f);
    }

    std::unique_ptr<OffscreenContext> context;
};

TEST_F(VertexPositions, Tentacle) {
    check_file(test::example("tentacle.glb"));
}
TEST_F(VertexPositions, MannequinWithTargetsAndARigidHead) {
    check_file(test::example("mannequin.glb"));
}
TEST_F(VertexPositions, Fox) {
    check_file(test::corpus("models/fox.glb"));
}
TEST_F(VertexPositions, RobotOfManyMeshes) {
    check_file(test::corpus("models/robot.glb"));
}
TEST_F(VertexPositions, EightInfluences) {
    check_file(test::corpus("generated/joints8.glb"));
}
TEST_F(VertexPositions, ThreeHundredJoints) {
    check_file(test::corpus("generated/joints_300.glb"));
}
TEST_F(VertexPositions, SparseTargets) {
    check_file(test::corpus("generated/morph_sparse.glb"));
}
TEST_F(VertexPositions, TargetsAndSkin) {
    check_file(test::corpus("generated/morph_and_skin.glb"));
}
TEST_F(VertexPositions, MirroredParts) {
    check_file(test::corpus("generated/negative_scale.glb"));
}

// Without the corpus: a strip with seven bones on every vertex, and more joints than uniforms could take.
TEST_F(VertexPositions, SevenInfluencesAndTwoThousandJoints) {
    constexpr std::uint32_t kJoints = 2000;
    constexpr std::uint16_t kInfluences = 7;
    constexpr std::uint32_t kColumns = 40;
    test::ModelSpec spec;
    spec.joints.push_back({kNone, {}, {test::submesh(0, 0, 6 * (kColumns - 1))}, "root"});
    for (std::uint32_t k = 1; k < kJoints; ++k) {
        RestRecord rest = test::turned(k % 360, k % 3);
        rest.translation = {0.2f * std::sin(0.1f * static_cast<float>(k)), 0.001f * static_cast<float>(k), 0.1f};
        spec.joints.push_back({0, rest, {}, ""});
    }
    test::MeshSpec mesh;
    mesh.joint = 0;
    std::vector<std::uint32_t> palette;
    for (std::uint32_t k = 0; k < kJoints; ++k) palette.push_back(k);
    std::vector<std::uint16_t> bones;
    std::vector<float> weights;
    for (std::uint32_t column = 0; column < kColumns; ++column) {
        for (const float y : {0.0f, 0.1f}) {
            mesh.positions.emplace_back(0.02f * static_cast<float>(column), y, 0.0f);
            for (std::uint32_t k = 0; k < kInfluences; ++k) {
                bones.push_back(static_cast<std::uint16_t>((column * 97 + k * 281) % kJoints));
                weights.push_back(k + 1 < kInfluences ? 0.125f : 0.25f);
            }
        }
    }
    for (std::uint32_t column = 0; column + 1 < kColumns; ++column) {
        for (const std::uint32_t corner : {0u, 2u, 1u, 1u, 2u, 3u}) mesh.indices.push_back(2 * column + corner);
    }
    mesh.more = {test::palette_leaf(palette, std::vector<glm::mat4>(kJoints, glm::mat4(1.0f))),
                 test::make_leaf(FourCC("BONE"), test::stream_payload<std::uint16_t>(kInfluences, bones)),
                 test::make_leaf(FourCC("WGHT"), test::stream_payload<float>(kInfluences, weights))};
    spec.meshes.push_back(mesh);
    const test::Owned model(test::build_file(spec));

    Pose pose(*model);
    const Box box = bounding_box(*model, nullptr);
    Renderer renderer(*model, ReadableFolders(), [](const std::string& what) { ADD_FAILURE() << what; });
    Camera camera;
    camera.fit(box, {0.6f, 0.2f, 1.2f}, 1.0f);
    expect_same_places(*model, pose, camera, renderer);
}

TEST(OffscreenContextTest, SaysWhatItTriedWhereThereIsNone) {
    try {
        const OffscreenContext context;
        EXPECT_TRUE(context.description().starts_with("EGL ")) << context.description();
    } catch (const ViewerError& problem) {
        EXPECT_NE(std::string(problem.what()).find("no OpenGL 3.3 here: "), std::string::npos);
    }
}

}  // namespace
}  // namespace bendy::viewer::vertex_positions_test
