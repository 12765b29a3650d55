#include <bendy/runtime/blend.h>

#include <bendy/runtime/kernels.h>

#include "pose/pose_state.h"
#include "runtime/build_model.h"
#include "runtime/local_joints.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace bendy::blend_test {
namespace {

using test::Owned;

/// A chain, and a side branch from joint 1 on.
test::ModelSpec chain_of(std::uint32_t joints) {
    test::ModelSpec spec;
    spec.joints.resize(joints);
    for (std::uint32_t joint = 1; joint < joints; ++joint) spec.joints[joint].parent = joint - 1;
    return spec;
}

void put_random(Pose& pose, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    test::change_locals(pose, [&](JointTransform& local) {
        local.rotation = glm::normalize(glm::quat(number(random), number(random), number(random), number(random)));
        local.translation = {number(random), number(random), number(random)};
        local.scale = {1.5f + number(random), 1.5f + number(random), 1.5f + number(random)};
    });
}

using Four = std::array<double, 4>;  // x y z w

Four four(const glm::quat& q) {
    return {q.x, q.y, q.z, q.w};
}

/// Normalised linear interpolation, the short way round, number by number.
Four nlerp(const Four& a, const Four& b, double u) {
    double dot = 0.0;
    for (std::size_t c = 0; c < 4; ++c) dot += a[c] * b[c];
    Four q{};
    double square = 0.0;
    for (std::size_t c = 0; c < 4; ++c) {
        q[c] = (1.0 - u) * a[c] + (dot < 0.0 ? -u : u) * b[c];
        square += q[c] * q[c];
    }
    for (double& number : q) number /= std::sqrt(square);
    return q;
}

/// Hamilton's product.
Four product(const Four& a, const Four& b) {
    return {
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

void expect_rotation(const glm::quat& found, const Four& expected, double tolerance) {
    const Four numbers = four(found);
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(numbers[c], expected[c], tolerance) << "component " << c;
}

constexpr double kUnit = 0x1p-24;  // in the last place of numbers up to 1

/// Runs a test once with each kernel.
template <class Run>
void with_each_kernel(const Run& run) {
    const Kernel before = kernel();
    for (const Kernel each : kernels()) {
        ASSERT_TRUE(set_kernel(each));
        SCOPED_TRACE(kernel_name(each));
        run();
    }
    EXPECT_TRUE(set_kernel(before));
}

TEST(Blend, MixesEveryJointByItsWeight) {
    with_each_kernel([] {
        for (const std::uint32_t joints : {1u, 3u, 4u, 8u, 9u, 23u}) {
            const Owned model(test::build_file(chain_of(joints)));
            Pose start(*model), other(*model);
            put_random(start, joints);
            put_random(other, joints + 100);
            std::vector<float> mask;
            for (std::uint32_t joint = 0; joint < joints; ++joint)
                mask.push_back(0.1f * static_cast<float>(joint % 11));
            for (const float weight : {0.0f, 0.3f, 0.75f, 1.0f}) {
                for (const bool is_masked : {false, true}) {
                    Pose pose = start;
                    ASSERT_TRUE(blend(pose, other, weight, is_masked ? mask : std::vector<float>()));
                    EXPECT_FALSE(PoseState::of(pose).stale.is_empty());
                    for (std::uint32_t joint = 0; joint < joints; ++joint) {
                        const double u = double{weight} * (is_masked ? mask[joint] : 1.0f);
                        const JointTransform& a = start.local(joint);
                        const JointTransform& b = other.local(joint);
                        const JointTransform& found = pose.local(joint);
                        expect_rotation(found.rotation, nlerp(four(a.rotation), four(b.rotation), u), 8 * kUnit);
                        for (int c = 0; c < 3; ++c) {
                            EXPECT_NEAR(found.translation[c], (1 - u) * a.translation[c] + u * b.translation[c],
                                        4 * kUnit);
                            EXPECT_NEAR(found.scale[c], (1 - u) * a.scale[c] + u * b.scale[c], 12 * kUnit);
                        }
                    }
                }
            }
        }
    });
}

TEST(Blend, NothingAndEverythingAreExact) {
    with_each_kernel([] {
        const Owned model(test::build_file(chain_of(19)));
        Pose start(*model), other(*model);
        put_random(start, 1);
        put_random(other, 2);
        Pose nothing = start;
        Pose everything = start;
        ASSERT_TRUE(blend(nothing, other, 0.0f));
        ASSERT_TRUE(blend(everything, other, 1.0f));
        for (std::uint32_t joint = 0; joint < 19; ++joint) {
            EXPECT_EQ(nothing.local(joint).translation, start.local(joint).translation);
            EXPECT_EQ(everything.local(joint).translation, other.local(joint).translation);
            EXPECT_EQ(everything.local(joint).scale, other.local(joint).scale);
        }
    });
}

TEST(Blend, APoseWithItselfStays) {
    with_each_kernel([] {
        const Owned model(test::build_file(chain_of(11)));
        Pose pose(*model);
        put_random(pose, 5);
        const Pose before = pose;
        ASSERT_TRUE(blend(pose, pose, 0.4f));
        for (std::uint32_t joint = 0; joint < 11; ++joint) {
            expect_rotation(pose.local(joint).rotation, four(before.local(joint).rotation), 4 * kUnit);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(pose.local(joint).translation[c], before.local(joint).translation[c], 2 * kUnit);
        }
    });
}

TEST(Additive, IsTheReferenceAgainAndWhatWasAddedToIt) {
    with_each_kernel([] {
        for (const std::uint32_t joints : {1u, 4u, 7u, 8u, 17u}) {
            const Owned model(test::build_file(chain_of(joints)));
            Pose reference(*model), shown(*model);
            put_random(reference, joints);
            put_random(shown, joints + 50);
            Pose difference = shown;
            ASSERT_TRUE(make_additive(difference, reference));
            Pose none = reference;
            Pose all = reference;
            ASSERT_TRUE(add(none, difference, 0.0f));
            ASSERT_TRUE(add(all, difference, 1.0f));
            for (std::uint32_t joint = 0; joint < joints; ++joint) {
                const Four target = four(shown.local(joint).rotation);
                double dot = 0.0;
                for (std::size_t c = 0; c < 4; ++c) dot += target[c] * four(all.local(joint).rotation)[c];
                EXPECT_NEAR(std::abs(dot), 1.0, 16 * kUnit);  // the same turn, whatever the sign
                expect_rotation(none.local(joint).rotation, four(reference.local(joint).rotation), 4 * kUnit);
                for (int c = 0; c < 3; ++c) {
                    EXPECT_NEAR(all.local(joint).translation[c], shown.local(joint).translation[c], 8 * kUnit);
                    EXPECT_NEAR(all.local(joint).scale[c], shown.local(joint).scale[c], 16 * kUnit);
                    EXPECT_EQ(none.local(joint).scale[c], reference.local(joint).scale[c]);
                }
            }
        }
    });
}

TEST(Additive, AddsAShareInTheJointsOwnAxes) {
    with_each_kernel([] {
        const Owned model(test::build_file(chain_of(13)));
        Pose base(*model), difference(*model);
        put_random(base, 3);
        put_random(difference, 4);
        std::vector<float> mask(13, 1.0f);
        mask[5] = 0.0f;
        mask[12] = 0.5f;
        Pose pose = base;
        ASSERT_TRUE(add(pose, difference, 0.6f, mask));
        for (std::uint32_t joint = 0; joint < 13; ++joint) {
            const double u = double{0.6f} * mask[joint];
            const JointTransform& from = base.local(joint);
            const JointTransform& added = difference.local(joint);
            const JointTransform& found = pose.local(joint);
            expect_rotation(found.rotation, product(four(from.rotation), nlerp({0, 0, 0, 1}, four(added.rotation), u)),
                            8 * kUnit);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(found.translation[c], from.translation[c] + u * added.translation[c], 4 * kUnit);
                EXPECT_NEAR(found.scale[c], from.scale[c] * (1 - u + u * added.scale[c]), 32 * kUnit);
            }
        }
    });
}

TEST(Additive, AScaleOfNothingHasNoQuotient) {
    const Owned model(test::build_file(chain_of(1)));
    Pose reference(*model), pose(*model);
    test::local_of(reference, 0)->scale = {0, 2, 1};
    test::local_of(pose, 0)->scale = {3, 3, 3};
    ASSERT_TRUE(make_additive(pose, reference));
    EXPECT_EQ(pose.local(0).scale, glm::vec3(1, 1.5f, 3));
}

TEST(Blend, TargetWeightsAreMixedAndAdded) {
    const Owned model(test::sample_file());
    Pose pose(*model), other(*model);
    ASSERT_GE(pose.morph_weights().size(), 2u);
    pose.change_morph_weights()[0] = 0.5f;
    other.change_morph_weights()[0] = 1.0f;
    other.change_morph_weights()[1] = -2.0f;
    Pose mixed = pose;
    ASSERT_TRUE(blend(mixed, other, 0.25f));
    EXPECT_FLOAT_EQ(mixed.morph_weights()[0], 0.625f);
    EXPECT_FLOAT_EQ(mixed.morph_weights()[1], 0.75f * pose.morph_weights()[1] - 0.5f);
    Pose difference = other;
    ASSERT_TRUE(make_additive(difference, pose));
    EXPECT_FLOAT_EQ(difference.morph_weights()[0], 0.5f);
    ASSERT_TRUE(add(pose, difference, 1.0f));
    EXPECT_FLOAT_EQ(pose.morph_weights()[0], 1.0f);
    EXPECT_FLOAT_EQ(pose.morph_weights()[1], -2.0f);
}

TEST(Blend, RefusesWhatDoesNotFit) {
    const Owned model(test::build_file(chain_of(3)));
    const Owned another(test::build_file(chain_of(3)));
    Pose pose(*model), other(*another);
    const Pose own(*model);
    put_random(pose, 1);
    const Pose before = pose;
    const std::vector<float> short_mask(2, 1.0f);
    EXPECT_FALSE(blend(pose, other, 0.5f));
    EXPECT_FALSE(add(pose, other, 0.5f));
    EXPECT_FALSE(make_additive(pose, other));
    EXPECT_FALSE(blend(pose, own, 0.5f, short_mask));
    EXPECT_FALSE(add(pose, own, 0.5f, short_mask));
    EXPECT_FALSE(blend(pose, own, std::numeric_limits<float>::quiet_NaN()));
    EXPECT_FALSE(add(pose, own, std::numeric_limits<float>::infinity()));
    for (std::uint32_t joint = 0; joint < 3; ++joint)
        EXPECT_EQ(pose.local(joint).translation, before.local(joint).translation);
}

TEST(Blend, WithoutJointsThereIsNothingToDo) {
    test::ModelSpec spec;
    spec.meshes = {{kNone, {{0, 0, 0}}, {}, {}, {}, {}}};
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    const Pose other(*model);
    EXPECT_TRUE(blend(pose, other, 0.5f));
    EXPECT_TRUE(add(pose, other, 0.5f));
    EXPECT_TRUE(make_additive(pose, other));
}

TEST(MaskBelow, ReachesTheJointAndItsDescendantsOnly) {
    test::ModelSpec spec;  // 0 (1 (2) 3 (4)) 5
    spec.joints.resize(6);
    spec.joints[1].parent = 0;
    spec.joints[2].parent = 1;
    spec.joints[3].parent = 0;
    spec.joints[4].parent = 3;
    const Owned model(test::build_file(spec));
    EXPECT_EQ(mask_below(*model, 0), (std::vector<float>{1, 1, 1, 1, 1, 0}));
    EXPECT_EQ(mask_below(*model, 3, 0.5f, 0.25f), (std::vector<float>{0.25f, 0.25f, 0.25f, 0.5f, 0.5f, 0.25f}));
    EXPECT_EQ(mask_below(*model, 5), (std::vector<float>{0, 0, 0, 0, 0, 1}));
    EXPECT_EQ(mask_below(*model, kNone), std::vector<float>(6, 0.0f));
}

}  // namespace
}  // namespace bendy::blend_test
