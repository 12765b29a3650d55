#include "play/unpack.h"

#include "kernels/flush_denormals.h"
#include "plan/layout.h"
#include "plan/unpack_plan.h"

#include <bendy/runtime/kernels.h>

#include "format/packed_samples.h"
#include "mutation/places.h"
#include "runtime/local_joints.h"
#include "runtime/packed_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace bendy::unpack_test {
namespace {

using namespace test;

constexpr std::uint32_t kJoints = 70;

/// unpack with one of the kernels.
struct Unpacking {
    Kernel kernel;
    std::string_view name;
    void operator()(const UnpackPlan& plan, float seconds, std::size_t joints, std::span<JointBlock> local) const {
        const Kernel before = bendy::kernel();
        EXPECT_TRUE(set_kernel(kernel));
        unpack(plan, seconds, joints, local);
        EXPECT_TRUE(set_kernel(before));
    }
};

std::vector<Unpacking> each_kernel() {
    std::vector<Unpacking> each;
    for (const Kernel kernel : kernels()) each.push_back({kernel, kernel_name(kernel)});
    return each;
}

std::vector<JointTransform> rest_pose() {
    std::vector<JointTransform> rest(kJoints);
    for (std::size_t j = 0; j < rest.size(); ++j) {
        const auto turn = static_cast<float>(j);
        rest[j].rotation = glm::normalize(glm::quat(std::cos(turn), std::sin(turn), 0.3f, -0.2f * turn));
        rest[j].translation = {turn, 1.0f, -turn};
        rest[j].scale = {1.0f, 2.0f, -1.0f};
    }
    return rest;
}

std::vector<JointTransform> played(const Unpacking& kernel, const PackedView& view, float seconds) {
    std::vector<JointTransform> local = rest_pose();
    const UnpackPlan plan = make_unpack_plan(view, local);
    std::vector<JointBlock> blocks = plan.start;
    kernel(plan, seconds, local.size(), blocks);
    for (std::uint32_t joint = 0; joint < local.size(); ++joint) local[joint] = joint_in(blocks, joint);
    return local;
}

/// The same track by track, in double precision.
std::vector<JointTransform> played_by_track(const PackedView& view, float seconds) {
    std::vector<JointTransform> local = rest_pose();
    const PackedMoment moment = packed_moment(view, seconds);
    PackedGroupReader reader(view, moment.frame);
    for (PackedGroup group; reader.next(group);) {
        for (std::uint32_t track = 0; track < group.count; ++track)
            set_unpacked(group, track, moment.fraction, local.at(group.joints.at(track)));
    }
    return local;
}

PackedView view_of(Bytes payload) {
    Faults faults;
    return read_packed(payload, kJoints, 0, faults).value();
}

/// Largest difference of any number of the two poses; rotations up to sign.
double difference(const std::vector<JointTransform>& a, const std::vector<JointTransform>& b) {
    double worst = 0.0;
    for (std::size_t j = 0; j < a.size(); ++j) {
        const float sign = glm::dot(a[j].rotation, b[j].rotation) < 0.0f ? -1.0f : 1.0f;
        for (int c = 0; c < 4; ++c)
            worst = std::max(worst, std::abs(double{a[j].rotation[c]} - sign * b[j].rotation[c]));
        for (int c = 0; c < 3; ++c) {
            worst = std::max(worst, std::abs(double{a[j].translation[c]} - b[j].translation[c]) / 70.0);
            worst = std::max(worst, std::abs(double{a[j].scale[c]} - b[j].scale[c]) / 70.0);
        }
    }
    return worst;
}

/// Rotations of up to `turn` radians a component from one frame to the next.
PackedSamples fast_samples(std::uint32_t joints, std::uint32_t frames, double turn) {
    PackedSamples samples = make_samples(joints, frames, 0);
    Noise noise(5);
    for (PackedTrack& track : samples.tracks) {
        if (track.path != TrackPath::rotation) continue;
        track.steps = {120, 120, 120};
        for (auto& number : track.numbers)
            number = static_cast<std::int32_t>((noise.next(2001) - 1000) * 1e-3 * turn / packed_step(120));
    }
    return samples;
}

TEST(Unpack, KernelsAgree) {
    for (const std::uint32_t joints : {1u, 7u, 8u, 9u, 23u, 70u}) {
        for (const double turn : {0.1, 1.0, 1.8, 3.5}) {
            const auto payload = write_packed(fast_samples(joints, 20, turn)).value();
            const PackedView view = view_of(payload);
            for (float seconds = 0.4f; seconds < 1.5f; seconds += 0.0137f) {
                const auto expected = played_by_track(view, seconds);
                for (const Unpacking& kernel : each_kernel())
                    EXPECT_LT(difference(played(kernel, view, seconds), expected), 2e-6) << kernel.name << turn;
            }
        }
    }
}

TEST(Unpack, KernelsAgreeInSegmentsAndWithTimes) {
    PackedSamples samples = make_samples(kJoints, 50, 16);
    samples.frame_rate = 0.0f;
    for (int f = 0; f < 50; ++f) samples.times.push_back(0.5f + 0.01f * static_cast<float>(f * f));
    const auto payload = write_packed(samples).value();
    const PackedView view = view_of(payload);
    for (float seconds = 0.4f; seconds < 26.0f; seconds += 0.0937f) {
        const auto expected = played_by_track(view, seconds);
        for (const Unpacking& kernel : each_kernel())
            EXPECT_LT(difference(played(kernel, view, seconds), expected), 2e-6) << kernel.name;
    }
}

TEST(Unpack, BetweenFramesIsSlerp) {
    PackedSamples samples = make_samples(1, 2, 0);
    const std::int32_t steps = 1000;
    samples.tracks = {{TrackPath::rotation, 0, {124, 124, 124}, 3, true, {0, 0, 0, steps, 0, 0}}};
    samples.frame_rate = 1.0f;
    samples.start = 0.0f;
    const auto payload = write_packed(samples).value();
    const PackedView view = view_of(payload);
    const double turn = steps * double{packed_step(124)};  // about y: 1.95 radians
    for (const Unpacking& kernel : each_kernel()) {
        const std::vector<JointTransform> rest(kJoints);
        std::vector<JointBlock> local = to_blocks(rest);
        kernel(make_unpack_plan(view, rest), 0.25f, kJoints, local);
        EXPECT_NEAR(joint_in(local, 0).rotation.y, std::sin(turn / 8), 2e-6) << kernel.name;
        EXPECT_NEAR(joint_in(local, 0).rotation.w, std::cos(turn / 8), 2e-6) << kernel.name;
    }
}

TEST(Unpack, TimesOutsideAreHeldAndNoTimeIsTheStart) {
    const auto payload = write_packed(make_samples(kJoints, 20, 0)).value();
    const PackedView view = view_of(payload);
    const float end = static_cast<float>(view.time_of(19));
    for (const Unpacking& kernel : each_kernel()) {
        EXPECT_LT(difference(played(kernel, view, -5.0f), played(kernel, view, 0.5f)), 1e-9);
        EXPECT_LT(difference(played(kernel, view, 1e30f), played(kernel, view, end + 1.0f)), 1e-9);
        EXPECT_LT(difference(played(kernel, view, std::numeric_limits<float>::quiet_NaN()), played(kernel, view, 0.5f)),
                  1e-9);
    }
}

// Found by fuzzing: `sample` takes denormal numbers for zero, and took such a rate for a table of times.
TEST(Unpack, ADenormalRateIsNotATableOfTimes) {
    PackedSamples samples = make_samples(kJoints, 20, 16);
    samples.frame_rate = std::numeric_limits<float>::denorm_min();
    const auto payload = write_packed(samples).value();
    const PackedView view = view_of(payload);
    const auto start = played_by_track(view, samples.start);
    const FlushDenormals flush(true);
    for (const Unpacking& kernel : each_kernel()) {
        for (const float seconds : {0.0f, 1.0f, 1e9f})
            EXPECT_LT(difference(played(kernel, view, seconds), start), 2e-6) << kernel.name;
    }
}

TEST(Unpack, APoseWithFewerJointsStaysAsItIs) {
    const auto payload = write_packed(make_samples(kJoints, 20, 0)).value();
    const PackedView view = view_of(payload);
    const UnpackPlan plan = make_unpack_plan(view, rest_pose());
    for (const Unpacking& kernel : each_kernel()) {
        const std::uint32_t joints = view.record.joints - 1u;
        std::vector<JointBlock> local = to_blocks(std::vector<JointTransform>(joints));
        kernel(plan, 0.7f, joints, local);
        for (std::uint32_t joint = 0; joint < joints; ++joint)
            EXPECT_EQ(joint_in(local, joint).translation, glm::vec3(0.0f));
    }
}

TEST(Unpack, ConstantsAreInThePlan) {
    PackedSamples samples = make_samples(kJoints, 20, 0);
    std::erase_if(samples.tracks, [](const PackedTrack& track) { return track.animated; });
    const auto payload = write_packed(samples).value();
    const UnpackPlan plan = make_unpack_plan(view_of(payload), rest_pose());
    EXPECT_TRUE(plan.groups.empty());
    std::vector<JointTransform> start;
    for (std::uint32_t joint = 0; joint < kJoints; ++joint) start.push_back(joint_in(plan.start, joint));
    EXPECT_GT(difference(start, rest_pose()), 1e-3);
    const PackedView view = view_of(payload);
    for (const Unpacking& kernel : each_kernel())
        EXPECT_LT(difference(played(kernel, view, 0.7f), played_by_track(view, 0.7f)), 1e-7) << kernel.name;
}

TEST(Unpack, DamageStaysInBounds) {
    const auto good = write_packed(make_samples(kJoints, 6, 2)).value();
    double sum = 0.0;
    const test::Places visited = test::places();
    for (std::size_t at = visited.first; at < good.size(); at += visited.step) {
        for (const int value : {0x00, 0x01, 0x18, 0x80, 0xff}) {
            // A buffer of its own, so that a read past its end is one past an allocation.
            std::vector<std::byte> bad(good);
            bad[at] = static_cast<std::byte>(value);
            Faults faults;
            const auto view = read_packed(bad, kJoints, 0, faults);
            if (!view) continue;
            for (const Unpacking& kernel : each_kernel()) {
                for (const float seconds : {0.5f, 0.6f, 9.0f}) sum += played(kernel, *view, seconds)[1].rotation.x;
            }
        }
    }
    EXPECT_FALSE(std::isnan(sum));
}

}  // namespace
}  // namespace bendy::unpack_test
