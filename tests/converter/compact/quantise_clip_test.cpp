#include "optimise/compact/quantise_clip.h"

#include "converter/posed_scene.h"
#include "optimise/compact/measure.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace bendy::converter::quantise_clip_test {
namespace {

using test::Numbers;

constexpr std::uint32_t kFrames = 50;

/// A tree of joints, some scaled and sheared, that all turn, and some of which move and grow.
Scene tree(std::uint32_t seed) {
    Numbers numbers(seed);
    Scene scene;
    Clip clip;
    for (std::uint32_t j = 0; j < 12; ++j) {
        Joint joint;
        joint.parent = j == 0 ? kNone : (j - 1) / 2;
        joint.rest.translation = glm::vec3(0.0f, 0.2f, 0.0f) + numbers.vector(0.1f);
        if (j % 3 == 1) joint.rest.scale = {1.2f, 0.8f, 1.1f};
        if (j == 5) joint.rest.shear = {0.2f, -0.1f, 0.1f};
        scene.joints.push_back(joint);
        for (const TrackPath path : {TrackPath::rotation, TrackPath::translation, TrackPath::scale}) {
            if (path != TrackPath::rotation && j % 4 != 1) continue;
            Track track;
            track.path = path;
            track.target = j;
            track.components = path == TrackPath::rotation ? 4 : 3;
            const float speed = numbers.between(1.0f, 3.0f);
            for (std::uint32_t f = 0; f < kFrames; ++f) {
                const float time = static_cast<float>(f) / 30.0f;
                const float wave = std::sin(speed * time);
                track.times.push_back(time);
                if (path == TrackPath::rotation) {
                    const glm::vec4 q = glm::normalize(glm::vec4(wave, 0.5f * wave, 0.3f, 1.5f));
                    track.values.insert(track.values.end(), {q.x, q.y, q.z, q.w});
                } else {
                    for (int c = 0; c < 3; ++c)
                        track.values.push_back(path == TrackPath::scale ? 1.0f + 0.2f * wave
                                                                        : joint.rest.translation[c] + 0.1f * wave);
                }
            }
            clip.tracks.push_back(std::move(track));
        }
    }
    scene.clips.push_back(std::move(clip));
    return scene;
}

/// The largest distance of a probe at the frames, as the numbers are decoded.
double error_of(const PackedSamples& samples, const ClipFrames& frames,
                const std::vector<std::vector<glm::dvec3>>& probes) {
    const std::size_t joints = frames.joints();
    std::vector<Affine> right(joints);
    std::vector<Affine> found(joints);
    double worst = 0.0;
    for (std::uint32_t f = 0; f < frames.frames(); ++f) {
        frames.place(f, right);
        std::vector<Local> locals(frames.rest().begin(), frames.rest().end());
        for (const PackedTrack& track : samples.tracks) {
            std::array<double, 3> by{};
            for (std::uint32_t c = 0; c < 3; ++c) {
                const std::uint32_t from = c < track.components ? c : 0;
                const std::size_t stride = track.animated ? frames.frames() : 1;
                by.at(c) =
                    double{packed_step(track.steps.at(from))} * track.numbers[from * stride + (track.animated ? f : 0)];
            }
            Local& local = locals[track.joint];
            const glm::dvec3 v(by[0], by[1], by[2]);
            if (track.path == TrackPath::translation) local.translation += v;
            if (track.path == TrackPath::scale) local.scale += v;
            if (track.path == TrackPath::rotation) {
                const auto q = packed_rotation(by);
                local.rotation = local.rotation * glm::dquat(q[3], q[0], q[1], q[2]);
            }
        }
        for (std::size_t j = 0; j < joints; ++j) {
            const Joint& joint = frames.scene().joints[j];
            found[j] = to_affine(locals[j], joint.rest.shear);
            if (joint.parent != kNone) found[j] = found[joint.parent] * found[j];
            for (const glm::dvec3& probe : probes[j])
                worst = std::max(worst, glm::distance(right[j](probe), found[j](probe)));
        }
    }
    return worst;
}

// Steps are chosen to first order, and numbers by an exact computation: they must agree, or clips would be too far off,
// or larger than need be.
TEST(QuantiseClip, UsesTheErrorThatIsAllowed) {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        const Scene scene = tree(seed);
        const Clip& clip = scene.clips[0];
        const auto grids = find_grids(clip);
        ASSERT_FALSE(grids.empty());
        const GridTracks& tracks = grids.front();
        ASSERT_EQ(tracks.tracks.size(), clip.tracks.size());
        const auto probes = find_probes(scene, Probes::shell);
        const ClipFrames frames(scene, clip, tracks.grid);
        for (const double allowed : {1e-5, 1e-4, 1e-3}) {
            for (const bool corrects : {true, false}) {
                const PackedSamples samples = quantise(frames, clip, tracks, probes, {allowed, corrects});
                const double error = error_of(samples, frames, probes);
                EXPECT_LE(error, 1.02 * allowed) << "seed " << seed << (corrects ? ", corrected" : "");
                EXPECT_GE(error, 0.9 * allowed) << "seed " << seed << (corrects ? ", corrected" : "");
            }
        }
    }
}

}  // namespace
}  // namespace bendy::converter::quantise_clip_test
