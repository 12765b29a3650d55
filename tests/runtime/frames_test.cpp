#include <bendy/runtime/blend.h>
#include <bendy/runtime/bounds.h>
#include <bendy/runtime/kernels.h>
#include <bendy/runtime/morph_targets.h>
#include <bendy/runtime/playback.h>
#include <bendy/runtime/sample.h>
#include <bendy/runtime/skin.h>

#include "source_folder.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <utility>
#include <vector>

// Frames and the clips that play them, of spec/examples/every_chunk.bendy: mesh 1 is a triangle (0 0 0, 1 0 0, 1 1 0)
// whose normals are 0 0 1. In frame 1 its last two vertices are at 1 0.5 0, in frame 2 at 1 1.5 0 and the first at 0
// 0.5 0; in both the last two have the normal 0 1 0. `flap` plays the mesh, frame 1 and frame 2, 2 a second, closed.
namespace bendy::frames_test {
namespace {

using Places = std::vector<glm::vec3>;

constexpr std::uint32_t kMesh = 1;
const Places kRest{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
const Places kUp{{0, 0, 0}, {1, 0.5f, 0}, {1, 0.5f, 0}};
const Places kHigh{{0, 0.5f, 0}, {1, 1.5f, 0}, {1, 1.5f, 0}};
const Places kForward(3, {0, 0, 1});
const Places kTurned{{0, 0, 1}, {0, 1, 0}, {0, 1, 0}};

class Frames : public testing::Test {
protected:
    void SetUp() override {
        auto opened = Model::open(source_folder() / "spec/examples/every_chunk.bendy");
        ASSERT_TRUE(opened) << static_cast<int>(opened.error().code);
        model_ = std::make_unique<Model>(std::move(*opened));
        flap_ = model_->clip("flap");
        ASSERT_NE(flap_, nullptr);
    }
    [[nodiscard]] const Mesh& mesh() const { return model_->meshes()[kMesh]; }

    /// Weights of the mesh's two frames.
    std::vector<float> weights_at(float seconds) {
        Pose pose(*model_);
        EXPECT_TRUE(sample(pose, flap_, seconds));
        const auto weights = pose.morph_weights().subspan(model_->first_morph_target(kMesh), 2);
        return {weights.begin(), weights.end()};
    }

    std::unique_ptr<Model> model_;
    const Clip* flap_ = nullptr;
};

TEST_F(Frames, AreTargetsWithNames) {
    ASSERT_EQ(mesh().targets.size(), 2u);
    EXPECT_EQ(mesh().frames(), 3u);
    EXPECT_EQ(mesh().targets[0].name, "up");
    EXPECT_EQ(mesh().targets[1].name, "high");
    EXPECT_EQ(mesh().targets[0].rest_weight, 0.0f);
    EXPECT_EQ(mesh().targets[0].touched(mesh().vertices), 3u);
    EXPECT_EQ(mesh().targets[1].displacement(*mesh().targets[1].positions, mesh().positions, 2), glm::vec3(0, 0.5f, 0));
    ASSERT_EQ(flap_->plays.size(), 1u);
    EXPECT_TRUE(flap_->plays[0].closed);
}

TEST_F(Frames, TwoShareTheWeightAndTheLastGoesOnToTheFirst) {
    using Weights = std::vector<float>;
    EXPECT_EQ(weights_at(0.0f), (Weights{0, 0}));
    EXPECT_EQ(weights_at(0.125f), (Weights{0.25f, 0}));
    EXPECT_EQ(weights_at(0.5f), (Weights{1, 0}));
    EXPECT_EQ(weights_at(0.625f), (Weights{0.75f, 0.25f}));
    EXPECT_EQ(weights_at(1.0f), (Weights{0, 1}));
    EXPECT_EQ(weights_at(1.375f), (Weights{0, 0.25f}));
    EXPECT_EQ(weights_at(1.5f), (Weights{0, 0}));
    EXPECT_EQ(weights_at(-3.0f), (Weights{0, 0})) << "held at the first frame";
    EXPECT_EQ(weights_at(9.0f), (Weights{0, 0}));
    EXPECT_EQ(weights_at(std::numeric_limits<float>::infinity()), (Weights{0, 0}));
}

TEST_F(Frames, OpenOnesAreHeldAtTheLast) {
    const PlayRecord open{kMesh, 1, 2, false};
    const auto at = [&](float seconds) {
        const FrameMix mix = mix_frames(open, *flap_, seconds);
        return std::vector<double>{static_cast<double>(mix.left), static_cast<double>(mix.right), mix.fraction};
    };
    EXPECT_EQ(at(-1.0f), (std::vector<double>{1, 1, 0}));
    EXPECT_EQ(at(0.25f), (std::vector<double>{1, 2, 0.5}));
    EXPECT_EQ(at(0.5f), (std::vector<double>{2, 2, 0}));
    EXPECT_EQ(at(1.5f), (std::vector<double>{2, 2, 0}));
    const PlayRecord one{kMesh, 2, 1, true};
    EXPECT_EQ(mix_frames(one, *flap_, 0.25f).left, 2u);
    EXPECT_EQ(mix_frames(one, *flap_, 0.25f).right, 2u);
}

TEST_F(Frames, AShapeWithAllTheWeightIsTheFilesToTheBit) {
    Places positions(3), normals(3);
    ASSERT_TRUE(apply_morph_targets(mesh(), std::vector<float>{0, 0}, {positions, normals, {}}));
    EXPECT_EQ(positions, kRest);
    EXPECT_EQ(normals, kForward);
    ASSERT_TRUE(apply_morph_targets(mesh(), std::vector<float>{1, 0}, {positions, normals, {}}));
    EXPECT_EQ(positions, kUp);
    EXPECT_EQ(normals, kTurned);
    ASSERT_TRUE(apply_morph_targets(mesh(), std::vector<float>{0, 1}, {positions, normals, {}}));
    EXPECT_EQ(positions, kHigh);
    ASSERT_TRUE(apply_morph_targets(mesh(), std::vector<float>{0.25f, 0}, {positions, normals, {}}));
    EXPECT_EQ(positions[1], glm::vec3(1, 0.125f, 0)) << "the mesh's own shape has the rest";
    EXPECT_EQ(normals[1], glm::vec3(0, 0.25f, 0.75f));
    ASSERT_TRUE(apply_morph_targets(mesh(), std::vector<float>{0.5f, 0.5f}, 2, {positions, normals, {}}));
    EXPECT_EQ(positions[0], glm::vec3(0, 0.25f, 0)) << "and only so many vertices as are wanted";
}

TEST_F(Frames, EveryKernelSkinsThem) {
    Pose pose(*model_);
    ASSERT_TRUE(sample(pose, flap_, 0.5f));
    const auto before = kernel();
    for (const Kernel kernel : kernels()) {
        ASSERT_TRUE(set_kernel(kernel));
        Places positions(3), normals(3);
        ASSERT_TRUE(skin(pose, {.mesh = kMesh, .out = {.positions = positions, .normals = normals}}));
        EXPECT_EQ(positions, kUp) << kernel_name(kernel);
        EXPECT_EQ(normals, kTurned) << kernel_name(kernel);
    }
    EXPECT_TRUE(set_kernel(before));
}

TEST_F(Frames, PlaybackGoesRound) {
    Playback playback(*flap_);
    playback.advance(1.25);  // frame 2 and half of the way to the first
    Pose pose(*model_);
    ASSERT_TRUE(sample(pose, flap_, playback.seconds()));
    EXPECT_EQ(pose.morph_weights()[model_->first_morph_target(kMesh) + 1], 0.5f);
    playback.advance(0.5);
    ASSERT_TRUE(sample(pose, flap_, playback.seconds()));
    EXPECT_EQ(pose.morph_weights()[model_->first_morph_target(kMesh)], 0.5f) << "1.75 s are 0.25 s";
}

TEST_F(Frames, BlendAndHaveBounds) {
    Pose a(*model_);
    Pose b(*model_);
    ASSERT_TRUE(sample(a, flap_, 0.5f));
    ASSERT_TRUE(sample(b, flap_, 1.0f));
    ASSERT_TRUE(blend(a, b, 0.5f));
    Places positions(3);
    ASSERT_TRUE(skin(a, {.mesh = kMesh, .out = {.positions = positions}}));
    EXPECT_EQ(positions[1], glm::vec3(1, 1, 0));
    const Bounds bounds(*model_);
    const Box box = *bounds.of(a);
    for (const glm::vec3& place : positions) EXPECT_TRUE(box.contains(place));
}

}  // namespace
}  // namespace bendy::frames_test
