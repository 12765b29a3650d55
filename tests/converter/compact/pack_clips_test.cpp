#include "optimise/compact/pack_clips.h"

#include "optimise/compact/grid.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/format/document.h>
#include <bendy/format/packed_clip.h>
#include <bendy/runtime.h>

#include <gtest/gtest.h>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace bendy::converter::pack_clips_test {
namespace {

constexpr double kBound = 1e-4;

/// A chain of joints 0.2 m apart, each with a rigid mesh of two points beside it.
Scene chain(std::uint32_t joints, glm::vec3 scale = glm::vec3(1.0f)) {
    Scene scene;
    for (std::uint32_t j = 0; j < joints; ++j) {
        Joint joint;
        joint.parent = j == 0 ? kNone : j - 1;
        joint.rest.translation = {0.0f, j == 0 ? 0.0f : 0.2f, 0.0f};
        const glm::quat turn =
            glm::angleAxis(0.3f * static_cast<float>(j), glm::normalize(glm::vec3(1.0f, 0.5f, 0.2f)));
        joint.rest.rotation = {turn.x, turn.y, turn.z, turn.w};
        if (j == 1) joint.rest.scale = scale;
        scene.joints.push_back(joint);
        Mesh mesh;
        mesh.joint = j;
        mesh.positions = {{0.05f, 0.1f, 0.0f}, {-0.05f, 0.1f, 0.05f}};
        scene.meshes.push_back(mesh);
    }
    scene.clips.emplace_back();
    return scene;
}

void rotate(Scene& scene, std::uint32_t joint, const std::vector<float>& times,
            const std::function<glm::vec3(float)>& vector) {
    Track track;
    track.path = TrackPath::rotation;
    track.target = joint;
    track.components = 4;
    track.times = times;
    for (const float time : times) {
        const glm::vec3 v = vector(time);
        const float angle = glm::length(v);
        const glm::quat q = angle > 0.0f ? glm::angleAxis(angle, v / angle) : glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
        track.values.insert(track.values.end(), {q.x, q.y, q.z, q.w});
    }
    scene.clips[0].tracks.push_back(std::move(track));
}

void move(Scene& scene, TrackPath path, std::uint32_t joint, const std::vector<float>& times,
          const std::function<glm::vec3(float)>& value) {
    Track track;
    track.path = path;
    track.target = joint;
    track.components = 3;
    track.times = times;
    for (const float time : times) {
        const glm::vec3 v = value(time);
        track.values.insert(track.values.end(), {v.x, v.y, v.z});
    }
    scene.clips[0].tracks.push_back(std::move(track));
}

std::vector<float> frames(int count, double rate, double start = 0.0) {
    std::vector<float> times;
    for (int f = 0; f < count; ++f) times.push_back(static_cast<float>(start + f / rate));
    return times;
}

/// A scene as a file, opened by the runtime: what plays it here shares nothing with the packer but the format. With the
/// plain kernel, since others round more on long chains, whatever the file's numbers are.
class Played {
public:
    explicit Played(const Scene& scene) : bytes_(build(scene)), model_(open(bytes_)), pose_(model_) {
        EXPECT_TRUE(set_kernel(Kernel::plain));
    }
    ~Played() { EXPECT_TRUE(set_kernel(before_)); }
    Played(const Played&) = delete;
    Played& operator=(const Played&) = delete;

    std::vector<glm::mat4> at(float seconds) {
        EXPECT_TRUE(sample(pose_, &model_.clips()[0], seconds));
        return {pose_.model_space().begin(), pose_.model_space().end()};
    }
    [[nodiscard]] const ClipView& clip() const { return model_.clips()[0]; }

private:
    static std::vector<std::byte> build(const Scene& scene) {
        Report report;
        auto bytes = build_chunks(scene, "test", report);
        EXPECT_TRUE(validate(bytes).empty());
        return bytes;
    }
    static Model open(Bytes bytes) {
        auto model = Model::from_memory(bytes);
        EXPECT_TRUE(model.has_value());
        return *std::move(model);
    }

    Kernel before_ = kernel();
    std::vector<std::byte> bytes_;
    Model model_;
    Pose pose_;
};

/// Packs, and holds the result against the original at 1000 odd times, with points on each joint that the packer has
/// been promised to.
PackedReport pack_and_check(Scene scene, double bound = kBound) {
    Played original(scene);
    const auto probes = find_probes(scene, Probes::skin_and_shell);
    const PackedReport report = pack_clips(scene, std::vector(scene.clips.size(), bound)).at(0);
    EXPECT_LE(report.worst_error, bound);
    Played packed(scene);
    const float start = original.clip().start;
    const float end = original.clip().end;
    EXPECT_NEAR(packed.clip().start, start, 1e-6);
    EXPECT_NEAR(packed.clip().end, end, 1e-5);
    double worst = 0.0;
    for (int k = 0; k <= 1000; ++k) {
        const float seconds = start + (end - start) * static_cast<float>(k) / 1000.0f;
        const auto right = original.at(seconds);
        const auto found = packed.at(seconds);
        for (std::size_t j = 0; j < right.size(); ++j) {
            for (const glm::dvec3& probe : probes[j]) {
                const glm::dvec4 point(probe, 1.0);
                worst = std::max(worst,
                                 glm::length(glm::dvec3(glm::dmat4(right[j]) * point - glm::dmat4(found[j]) * point)));
            }
        }
    }
    constexpr double kFloats = 3e-6;  // metres: both sides have been rounded
    EXPECT_LE(worst, bound + kFloats);
    return report;
}

glm::vec3 wave(float t) {
    return {std::sin(3.0f * t), 0.5f * std::cos(5.0f * t), 0.2f * std::sin(7.0f * t)};
}

TEST(PackClips, KeepsTheBound) {
    Scene scene = chain(6);
    for (std::uint32_t j = 0; j < 6; ++j) {
        rotate(scene, j, frames(60, 30.0), [j](float t) { return wave(t + static_cast<float>(j)); });
    }
    move(scene, TrackPath::translation, 0, frames(60, 30.0), [](float t) { return glm::vec3(t, std::sin(t), 0.0f); });
    const PackedReport report = pack_and_check(std::move(scene));
    EXPECT_GT(report.packed_bytes, 0u);
    EXPECT_LT(report.packed_bytes * 3, report.source_bytes);
    EXPECT_EQ(report.kept_bytes, 0u);
}

/// Frames of the packed clip.
std::uint32_t packed_frames(Scene scene) {
    pack_clips(scene, std::vector(scene.clips.size(), kBound));
    Faults faults;
    const auto joints = static_cast<std::uint32_t>(scene.joints.size());
    return read_packed(scene.clips.at(0).packed, joints, 0, faults).value().record.frames;
}

TEST(PackClips, LongSmoothClipsKeepFewerFrames) {
    Scene scene = chain(3);
    for (std::uint32_t j = 0; j < 3; ++j)
        rotate(scene, j, frames(181, 30.0), [j](float t) { return 0.3f * wave(0.1f * t + static_cast<float>(j)); });
    const PackedReport report = pack_and_check(scene);
    EXPECT_LT(packed_frames(scene), 181u / 2);
    EXPECT_LT(report.packed_bytes * 10, report.source_bytes);
}

TEST(PackClips, JerkyClipsKeepAllFrames) {
    Scene scene = chain(2);
    for (std::uint32_t j = 0; j < 2; ++j) rotate(scene, j, frames(181, 30.0), [](float t) { return wave(40.0f * t); });
    pack_and_check(scene);
    EXPECT_EQ(packed_frames(scene), 181u);
}

TEST(PackClips, FastSpinsAndWraps) {
    Scene scene = chain(3);
    rotate(scene, 0, frames(50, 30.0), [](float t) { return glm::vec3(0.0f, 40.0f * t, 0.0f); });
    rotate(scene, 1, frames(50, 30.0), [](float t) { return glm::vec3(3.1f + 0.2f * std::sin(9.0f * t), 0.1f, 0.0f); });
    rotate(scene, 2, frames(50, 30.0), [](float t) { return 30.0f * wave(t); });
    EXPECT_GT(pack_and_check(std::move(scene)).packed_bytes, 0u);
}

TEST(PackClips, NegativeAndUnevenScale) {
    Scene scene = chain(4, {-1.0f, 2.0f, 0.5f});
    scene.joints[1].rest.shear = {0.1f, 0.2f, -0.1f};
    for (std::uint32_t j = 0; j < 4; ++j) rotate(scene, j, frames(24, 24.0), wave);
    move(scene, TrackPath::scale, 2, frames(24, 24.0), [](float t) { return glm::vec3(1.0f + 0.2f * std::sin(t)); });
    move(scene, TrackPath::scale, 3, frames(24, 24.0), [](float t) { return glm::vec3(1.0f, -1.0f - t, 1.0f); });
    EXPECT_GT(pack_and_check(std::move(scene)).packed_bytes, 0u);
}

TEST(PackClips, LongChain) {
    Scene scene = chain(120);
    for (std::uint32_t j = 0; j < 120; ++j) rotate(scene, j, frames(12, 24.0), [](float t) { return 0.1f * wave(t); });
    EXPECT_GT(pack_and_check(std::move(scene)).packed_bytes, 0u);
}

TEST(PackClips, WhatNeverChangesCostsNextToNothing) {
    Scene scene = chain(30);
    for (std::uint32_t j = 0; j < 30; ++j) {
        const glm::vec4 rest = scene.joints[j].rest.rotation;
        rotate(scene, j, frames(100, 30.0), wave);
        auto& values = scene.clips[0].tracks.back().values;
        for (std::size_t k = 0; k < values.size(); ++k) values[k] = rest[static_cast<int>(k % 4)];
    }
    move(scene, TrackPath::translation, 3, frames(100, 30.0), [](float) { return glm::vec3(1.0f, 0.2f, 0.0f); });
    const PackedReport report = pack_and_check(std::move(scene));
    EXPECT_GT(report.packed_bytes, 0u);
    EXPECT_LT(report.packed_bytes, 60u);
}

TEST(PackClips, OneKey) {
    Scene scene = chain(2);
    rotate(scene, 1, {0.25f}, [](float) { return glm::vec3(1.0f, 0.0f, 0.0f); });
    EXPECT_GT(pack_and_check(std::move(scene)).packed_bytes, 0u);
}

TEST(PackClips, UnevenKeysOfAll) {
    Scene scene = chain(3);
    std::vector<float> times;
    for (int k = 0; k < 40; ++k)
        times.push_back(0.03f * static_cast<float>(k) + 0.007f * std::sin(static_cast<float>(k * k)));
    for (std::uint32_t j = 0; j < 3; ++j) rotate(scene, j, times, wave);
    const PackedReport report = pack_and_check(std::move(scene));
    EXPECT_GT(report.packed_bytes, 0u);
    EXPECT_EQ(report.kept_bytes, 0u);
}

TEST(PackClips, StepsAndSplinesStay) {
    Scene scene = chain(3);
    rotate(scene, 0, frames(40, 30.0), wave);
    rotate(scene, 1, frames(40, 30.0), wave);
    scene.clips[0].tracks[1].interpolation = Interpolation::step;
    Track cubic;
    cubic.path = TrackPath::translation;
    cubic.interpolation = Interpolation::cubic;
    cubic.target = 2;
    cubic.components = 3;
    cubic.times = {0.0f, 1.0f};
    cubic.values = {0, 0, 0, 0, 0.2f, 0, 1, 0, 0, 0, 1, 0, 0.1f, 0.3f, 0, 0, 0, 0};
    scene.clips[0].tracks.push_back(cubic);
    Scene packed = scene;
    pack_clips(packed, std::vector(packed.clips.size(), kBound));
    ASSERT_EQ(packed.clips[0].tracks.size(), 2u);
    EXPECT_EQ(packed.clips[0].tracks[0].interpolation, Interpolation::step);
    EXPECT_EQ(packed.clips[0].tracks[1].values, cubic.values);
    pack_and_check(std::move(scene));
}

TEST(PackClips, StepsThatAreConstantWithinTheBoundArePacked) {
    Scene scene = chain(8);
    rotate(scene, 0, frames(40, 30.0), wave);
    for (std::uint32_t joint = 1; joint < 8; ++joint) {
        scene.clips[0].tracks.push_back(
            {TrackPath::rotation, Interpolation::step, joint, 4, {0.0f, 1.3f}, {0, 0, 0, 1, 2e-7f, 0, 0, 1}});
        scene.clips[0].tracks.push_back(
            {TrackPath::scale, Interpolation::step, joint, 3, {0.0f, 1.3f}, {1, 1, 1, 1.0000002f, 1, 1}});
    }
    scene.clips[0].tracks.push_back(
        {TrackPath::translation, Interpolation::step, 7, 3, {0.0f, 1.3f}, {0, 0, 0, 0.5f, 0, 0}});
    pack_clips(scene, std::vector{1e-4});
    ASSERT_EQ(scene.clips[0].tracks.size(), 1u);  // the one that moves
    EXPECT_EQ(scene.clips[0].tracks[0].path, TrackPath::translation);
}

TEST(PackClips, IsTheSameEveryTime) {
    const auto pack = [] {
        Scene scene = chain(5);
        for (std::uint32_t j = 0; j < 5; ++j) rotate(scene, j, frames(40, 30.0), wave);
        pack_clips(scene, std::vector(scene.clips.size(), kBound));
        return scene.clips[0].packed;
    };
    EXPECT_EQ(pack(), pack());
}

TEST(PackClips, ProgressRisesInsideAClipAndByItsLength) {
    Scene scene = chain(3);
    for (std::uint32_t j = 0; j < 3; ++j) rotate(scene, j, frames(90, 30.0), wave);
    scene.clips.push_back(scene.clips[0]);
    for (Track& track : scene.clips[1].tracks) {
        track.times.resize(9);
        track.values.resize(9 * static_cast<std::size_t>(track.components));
    }
    std::vector<double> told;
    pack_clips(scene, std::vector(scene.clips.size(), kBound),
               {.progress = [&](double done) { told.push_back(done); }});
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    ASSERT_FALSE(told.empty());
    EXPECT_DOUBLE_EQ(told.back(), 1.0);
    EXPECT_GT(std::count_if(told.begin(), told.end(), [](double done) { return done < 0.8; }),
              0);  // the long one's steps
    EXPECT_GT(told.size(), scene.clips.size());
    EXPECT_TRUE(std::any_of(told.begin(), told.end(), [](double done) { return done > 0.85 && done < 0.95; }));
}

TEST(PackClips, UnpackedTracksAreTheSameMotion) {
    Scene scene = chain(3);
    for (std::uint32_t j = 0; j < 3; ++j) rotate(scene, j, frames(40, 24.0), wave);
    const Scene original = scene;
    pack_clips(scene, std::vector(scene.clips.size(), kBound));
    Faults faults;
    const auto view = read_packed(scene.clips[0].packed, 3, 0, faults);
    ASSERT_TRUE(view);
    std::vector<RestRecord> rests;
    for (const Joint& joint : scene.joints) {
        RestRecord rest;
        for (int c = 0; c < 4; ++c) rest.rotation[static_cast<std::size_t>(c)] = joint.rest.rotation[c];
        for (int c = 0; c < 3; ++c) rest.translation[static_cast<std::size_t>(c)] = joint.rest.translation[c];
        rests.push_back(rest);
    }
    for (const UnpackedTrack& track : unpack_clip(*view, rests)) {
        const Track& source = original.clips[0].tracks[track.joint];
        ASSERT_EQ(track.times.size(), 40u);
        for (std::size_t k = 0; k < 40; ++k) {
            EXPECT_NEAR(track.times[k], source.times[k], 1e-6);
            double dot = 0.0;
            for (std::size_t c = 0; c < 4; ++c) dot += double{track.values[4 * k + c]} * source.values[4 * k + c];
            EXPECT_GT(std::abs(dot), 1.0 - 1e-5);
        }
    }
}

TEST(FindGrid, TakesTheRateOfTheKeys) {
    for (const double rate : {24.0, 30.0, 60.0, 29.97, 12.5}) {
        Scene scene = chain(2);
        rotate(scene, 0, frames(300, rate, 0.5), wave);
        auto sparse = frames(300, rate, 0.5);
        std::erase_if(sparse, [k = 0](float) mutable { return k++ % 3 != 0; });
        rotate(scene, 1, sparse, wave);
        const auto found = find_grids(scene.clips[0]);
        ASSERT_FALSE(found.empty());
        EXPECT_NEAR(found[0].grid.rate, rate, 1e-3);
        EXPECT_EQ(found[0].grid.frames, 300u);
        EXPECT_EQ(found[0].grid.start, 0.5f);
        EXPECT_EQ(found[0].tracks.size(), 2u);
    }
}

TEST(FindGrid, IsTwiceAsDenseWhereKeysLieBetween) {
    Scene scene = chain(2);
    rotate(scene, 0, frames(30, 30.0), wave);
    rotate(scene, 1, frames(29, 30.0, 1.0 / 60.0), wave);
    const auto found = find_grids(scene.clips[0]);
    ASSERT_FALSE(found.empty());
    EXPECT_NEAR(found[0].grid.rate, 60.0, 1e-3);
    EXPECT_EQ(found[0].tracks.size(), 2u);
}

// Retargeted motion capture: a joint that jumps gets keys of its own between two frames.
TEST(FindGrid, ListsTimesIfAFewKeysLieCloseTogether) {
    Scene scene = chain(2);
    auto times = frames(300, 120.0);
    rotate(scene, 0, times, wave);
    times.insert(times.begin() + 100, times[99] + 1.0f / 960.0f);
    rotate(scene, 1, times, wave);
    const auto found = find_grids(scene.clips[0]);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].grid.times, times);
    EXPECT_EQ(found[0].tracks.size(), 2u);
    const PackedReport report = pack_and_check(scene);
    EXPECT_GT(report.packed_bytes, 0u);
}

TEST(FindGrid, ThinsAListOfTimesToAnEvenGrid) {
    Scene scene = chain(2);
    auto times = frames(361, 120.0);
    for (const std::uint32_t joint : {0u, 1u}) {
        rotate(scene, joint, times, [](float t) { return 0.1f * wave(0.1f * t); });
        times.insert(times.begin() + 100, times[99] + 1.0f / 960.0f);
    }
    ASSERT_EQ(find_grids(scene.clips[0]).at(0).grid.frames, 362u);
    EXPECT_GT(pack_and_check(scene).packed_bytes, 0u);
    EXPECT_LT(packed_frames(scene), 361u / 2);
}

// Exporters write times with few digits. A joint that jumps within a frame is far off even a thousandth of it later.
TEST(FindGrid, ListsTimesIfAJumpIsOffAnEvenGrid) {
    Scene scene = chain(2);
    auto times = frames(300, 37.5);
    times[150] += 0.001f / 37.5f;
    rotate(scene, 0, times, [](float t) { return glm::vec3(t < 3.99f ? 0.0f : 2.0f, 0.0f, 0.0f); });
    const auto found = find_grids(scene.clips[0]);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_NEAR(found[0].grid.rate, 37.5, 1e-3);
    EXPECT_EQ(found[1].grid.times, times);
    const PackedReport report = pack_and_check(scene);
    EXPECT_GT(report.packed_bytes, 0u);
}

}  // namespace
}  // namespace bendy::converter::pack_clips_test
