#include <bendy/runtime/kernels.h>
#include <bendy/runtime/sample.h>

#include "runtime/build_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

// Whole clips with each kernel, against sample_track in double precision.
namespace bendy::sample_kernels_test {
namespace {

using test::Owned;

constexpr std::uint32_t kJoints = 21;  // no multiple of any number of lanes
constexpr std::uint32_t kKeys = 5;

/// Joints with a track for each property, some on time lines of their own, some of one key, some in fixed frames, some
/// steps, some cubic; rotations turn by up to `angle` radians from key to key.
test::ModelSpec animated(float angle) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    test::ModelSpec spec;
    spec.joints.resize(kJoints);
    for (std::uint32_t joint = 1; joint < kJoints; ++joint) spec.joints[joint].parent = joint - 1;
    const std::vector<float> times{0.0f, 0.25f, 0.5f, 0.625f, 1.0f, 0.0f, 0.1f, 0.2f, 0.9f, 1.0f};
    std::vector<float> values;
    std::vector<TrackRecord> tracks;
    for (std::uint32_t joint = 0; joint < kJoints; ++joint) {
        for (const TrackPath path : {TrackPath::translation, TrackPath::rotation, TrackPath::scale}) {
            if (joint % 5 == 3 && path == TrackPath::scale) continue;  // at rest
            const bool is_rotation = path == TrackPath::rotation;
            TrackRecord track;
            track.target = joint;
            track.path = static_cast<std::uint8_t>(path);
            const bool is_cubic = joint % 4 == 2;
            track.interpolation = static_cast<std::uint8_t>(is_cubic     ? Interpolation::cubic
                                                            : joint == 7 ? Interpolation::step
                                                                         : Interpolation::linear);
            track.components = is_rotation ? 4 : 3;
            track.keys = joint == 4 ? 1 : kKeys;
            track.first_time = joint == 9 || joint == 10 ? kNone : (joint % 3 == 0 ? 5 : 0);
            track.first_value = values.size();
            tracks.push_back(track);
            glm::quat q = glm::normalize(glm::quat(number(random), number(random), number(random), number(random)));
            for (std::uint32_t key = 0; key < track.keys; ++key) {
                const bool is_turned = !is_cubic && number(random) < 0.0f;
                const float sign = is_turned ? -1.0f : 1.0f;  // a key's sign means nothing, except between tangents
                const auto add_tangent = [&] {
                    for (int c = 0; is_cubic && c < track.components; ++c) values.push_back(number(random));
                };
                add_tangent();
                if (is_rotation) {
                    values.insert(values.end(), {sign * q.x, sign * q.y, sign * q.z, sign * q.w});
                } else {
                    values.insert(values.end(), {number(random), number(random), number(random)});
                }
                add_tangent();
                const glm::vec3 axis(number(random), number(random), number(random));
                q = glm::normalize(q * glm::angleAxis(angle * number(random), glm::normalize(axis)));
            }
        }
    }
    ClipRecord info;
    info.end = 1.0f;
    info.frame_rate = 4.0f;
    spec.more.push_back(test::make_container(
        FourCC("CYCL"),
        {test::make_leaf(FourCC("CINF"), bytes_of(info)), test::make_leaf(FourCC("TRAK"), test::bytes_of_all(tracks)),
         test::make_leaf(FourCC("TIME"), test::bytes_of_all(times)),
         test::make_leaf(FourCC("KEYV"), test::bytes_of_all(values))}));
    return spec;
}

void expect_track(const TrackView& track, const Clip& clip, float seconds, const Pose& pose, float tolerance) {
    std::vector<float> expected(track.components);
    sample_track(track, clip, seconds, expected);
    const JointTransform& joint = pose.local(track.target);
    const auto& q = joint.rotation;
    const glm::vec3& vector = track.path == TrackPath::translation ? joint.translation : joint.scale;
    const std::vector<float> found = track.path == TrackPath::rotation
                                         ? std::vector<float>{q.x, q.y, q.z, q.w}
                                         : std::vector<float>{vector.x, vector.y, vector.z};
    for (std::size_t c = 0; c < found.size(); ++c)
        EXPECT_NEAR(found[c], expected[c], tolerance) << "joint " << track.target << " at " << seconds;
}

TEST(SampleKernels, AgreeWithEachTrackByItself) {
    const Kernel before = kernel();
    for (const float angle : {0.0f, 0.01f, 0.5f, 1.5f, 3.1f}) {
        const Owned model(test::build_file(animated(angle)));
        const Clip& clip = model->clips().front();
        ASSERT_EQ(clip.tracks.size(), 3 * kJoints - 4);
        for (const Kernel each : kernels()) {
            ASSERT_TRUE(set_kernel(each));
            SCOPED_TRACE(kernel_name(each));
            Pose pose(*model);
            std::mt19937 random(1);
            std::uniform_real_distribution<float> anywhere(-0.1f, 1.1f);
            for (int k = 0; k < 200; ++k) {
                const float seconds = k == 0 ? 1.0f : k == 1 ? 0.0f : anywhere(random);
                ASSERT_TRUE(sample(pose, &clip, seconds));
                // Numbers are at most 1: four units in its last place, and more terms for wider turns.
                const float units = angle < 1.0f ? 4.0f : 12.0f;
                for (const TrackView& track : clip.tracks) expect_track(track, clip, seconds, pose, units * 0x1p-24f);
                EXPECT_EQ(pose.local(3).scale, glm::vec3(1.0f));
            }
        }
    }
    EXPECT_TRUE(set_kernel(before));
}

/// Two clips whose tracks have times of their own: from 2 to 40 keys in a second, unevenly, the first of them at 0.
test::ModelSpec timed() {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    test::ModelSpec spec;
    spec.joints.resize(kJoints);
    for (std::uint32_t joint = 1; joint < kJoints; ++joint) spec.joints[joint].parent = joint - 1;
    for (std::uint32_t clip = 0; clip < 2; ++clip) {
        std::vector<float> times;
        std::vector<float> values;
        std::vector<TrackRecord> tracks;
        for (std::uint32_t joint = 0; joint < kJoints; ++joint) {
            for (const TrackPath path : {TrackPath::translation, TrackPath::rotation}) {
                if (path == TrackPath::translation && joint % 2 == 1) continue;
                TrackRecord track;
                track.target = joint;
                track.path = static_cast<std::uint8_t>(path);
                track.interpolation = static_cast<std::uint8_t>(Interpolation::linear);
                track.components = path == TrackPath::rotation ? 4 : 3;
                track.keys = 2 + (joint * 7 + clip) % 39;
                track.first_time = static_cast<std::uint32_t>(times.size());
                track.first_value = values.size();
                tracks.push_back(track);
                float seconds = 0.0f;
                for (std::uint32_t key = 0; key < track.keys; ++key) {
                    times.push_back(seconds);
                    seconds += (1.1f + number(random)) / static_cast<float>(track.keys);
                    const glm::quat q = glm::normalize(glm::quat(1.0f, number(random), number(random), number(random)));
                    const float numbers[4]{q.x, q.y, q.z, q.w};
                    values.insert(values.end(), numbers, numbers + track.components);
                }
            }
        }
        ClipRecord info;
        info.end = 1.0f;
        spec.more.push_back(
            test::make_container(FourCC("CYCL"), {test::make_leaf(FourCC("CINF"), bytes_of(info)),
                                                  test::make_leaf(FourCC("TRAK"), test::bytes_of_all(tracks)),
                                                  test::make_leaf(FourCC("TIME"), test::bytes_of_all(times)),
                                                  test::make_leaf(FourCC("KEYV"), test::bytes_of_all(values))}));
    }
    return spec;
}

TEST(SampleKernels, TracksWithTimesOfTheirOwn) {
    const Kernel before = kernel();
    const Owned model(test::build_file(timed()));
    ASSERT_EQ(model->clips().size(), 2u);
    for (const Kernel each : kernels()) {
        ASSERT_TRUE(set_kernel(each));
        SCOPED_TRACE(kernel_name(each));
        Pose pose(*model);
        const auto expect_sample = [&](const Clip& clip, float seconds, float tolerance) {
            ASSERT_TRUE(sample(pose, &clip, seconds));
            for (const TrackView& track : clip.tracks) expect_track(track, clip, seconds, pose, tolerance);
        };
        // The keys that the last sample found must not count: forwards by small and large steps, backwards, and from
        // clip to clip.
        for (const float step : {0.004f, 0.06f, 0.4f, -0.03f}) {
            for (float at = step > 0.0f ? -0.1f : 1.3f; at > -0.2f && at < 1.4f; at += step) {
                expect_sample(model->clips()[0], at, 12.0f * 0x1p-24f);
                if (step == 0.06f) expect_sample(model->clips()[1], 1.2f - at, 12.0f * 0x1p-24f);
            }
        }
        const TrackView& track = model->clips()[0].tracks[3];
        for (const float seconds : track.times) {
            ASSERT_TRUE(sample(pose, &model->clips()[0], seconds));
            expect_track(track, model->clips()[0], seconds, pose, 0.0f);
        }
    }
    EXPECT_TRUE(set_kernel(before));
}

TEST(SampleKernels, KeysComeOutExactly) {
    const Kernel before = kernel();
    const Owned model(test::build_file(animated(0.5f)));
    const Clip& clip = model->clips().front();
    for (const Kernel each : kernels()) {
        ASSERT_TRUE(set_kernel(each));
        SCOPED_TRACE(kernel_name(each));
        Pose pose(*model);
        for (const float seconds : {-1.0f, 0.0f, 0.25f, 0.5f, 1.0f, 2.0f}) {
            ASSERT_TRUE(sample(pose, &clip, seconds));
            for (const TrackView& track : clip.tracks) {
                const auto is_key = [&](float time) { return time == seconds; };
                const bool is_at_key =
                    seconds <= 0.0f || seconds >= 1.0f || std::any_of(track.times.begin(), track.times.end(), is_key);
                if (is_at_key) expect_track(track, clip, seconds, pose, 0.0f);
            }
        }
    }
    EXPECT_TRUE(set_kernel(before));
}

}  // namespace
}  // namespace bendy::sample_kernels_test
