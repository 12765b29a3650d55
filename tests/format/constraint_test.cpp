#include <bendy/format/constraint.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace bendy {
namespace {

using namespace test;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kLargest = std::numeric_limits<float>::max();
const std::string kHinge = "HEAD/OBJE/SKIN/SKIN/PIVO/LIMT";
const std::string kSwing = "HEAD/OBJE/SKIN/SKIN/PIVO/LIMT[1]";

LimitRecord make_limit(LimitModel model) {
    LimitRecord limit;
    limit.model = static_cast<std::uint8_t>(model);
    return limit;
}

LimitRecord hinge(float low, float high) {
    LimitRecord limit = make_limit(LimitModel::hinge);
    limit.rotation_min[0] = low;
    limit.rotation_max[0] = high;
    return limit;
}

LimitRecord box(float low, float high) {
    LimitRecord limit = make_limit(LimitModel::euler_box);
    limit.rotation_min.fill(low);
    limit.rotation_max.fill(high);
    return limit;
}

/// What check_limit says, each fault as "CODE value".
Lines faults_of(const LimitRecord& limit) {
    constexpr std::uint32_t kJoint = 17;
    constexpr std::uint64_t kOffset = 4711;
    Faults faults;
    check_limit(limit, kJoint, kOffset, faults);
    Lines lines;
    for (const Error& fault : faults.list()) {
        EXPECT_EQ(fault.offset, kOffset);
        lines.push_back(std::string(code_name(fault.code)) + " " + std::to_string(fault.value));
    }
    return lines;
}

constexpr LimitModel kModels[] = {LimitModel::free,
                                  LimitModel::locked,
                                  LimitModel::hinge,
                                  LimitModel::swing_twist_ellipse,
                                  LimitModel::swing_twist_pyramid,
                                  LimitModel::euler_box,
                                  LimitModel::largest_angle};

TEST(Limit, AreReadInTheOrderOfTheirJoints) {
    const Loaded sample(sample_file());
    ASSERT_EQ(sample.lines(), Lines{});
    const auto& limits = sample.document.objects.at(0).skeleton.limits;
    ASSERT_EQ(limits.size(), 2u);
    EXPECT_EQ(limits[0].joint, 1u);
    EXPECT_EQ(limits[0].record.model, static_cast<std::uint8_t>(LimitModel::hinge));
    EXPECT_EQ(limits[0].record.soft_zone, 0.125f);
    EXPECT_EQ(limits[0].record.rotation_max[0], 2.0f);
    EXPECT_EQ(limits[0].record.rotation_max[1], kInf);
    EXPECT_EQ(limits[1].joint, 1u);
    EXPECT_EQ(limits[1].record.scope, static_cast<std::uint8_t>(LimitScope::ik_only));
    EXPECT_EQ(limits[1].record.flags, kProposed);
    EXPECT_EQ(limits[1].record.rotation_max, (std::array{0.5f, 0.75f, 1.0f}));
    EXPECT_EQ(limits[1].record.translation_max, (std::array{0.0f, 0.125f, kInf}));
    EXPECT_EQ(limits[1].record.stiffness, (std::array{0.0f, 0.5f, 1.0f}));
    EXPECT_EQ(sample.tree[limits[1].chunk].offset, place_of(sample.file, kSwing));
}

TEST(Limit, RefusesValuesThatItDoesNotKnow) {
    const auto faults = [](const std::function<void(LimitRecord&)>& change) {
        Node root = sample();
        edit<LimitRecord>(at(root, kHinge), change);
        return faults_in(root);
    };
    EXPECT_EQ(faults([](auto& limit) { limit.model = kLimitModels; }), Lines{"ENUM_RANGE " + kHinge});
    EXPECT_EQ(faults([](auto& limit) { limit.euler_order = kEulerOrders; }), Lines{"ENUM_RANGE " + kHinge});
    EXPECT_EQ(faults([](auto& limit) { limit.scope = kLimitScopes; }), Lines{"ENUM_RANGE " + kHinge});
    EXPECT_EQ(faults([](auto& limit) { limit.flags = kLimitFlags; }), Lines{"ENUM_RANGE " + kHinge});
    EXPECT_EQ(faults([](auto& limit) { limit.flags = kLimitFlags - 1; }), Lines{});
    EXPECT_EQ(faults([](auto& limit) { limit.scope = 2; }), Lines{});
}

TEST(Limit, MayBeLongerButNotShorterThanItsRecord) {
    Node root = sample();
    at(root, kHinge).payload.push_back(std::byte{1});
    EXPECT_EQ(faults_in(root), Lines{});
    at(root, kHinge).payload.resize(sizeof(LimitRecord) - 1);
    EXPECT_EQ(faults_in(root), Lines{"RECORD_TOO_SHORT " + kHinge});
}

TEST(Limit, IsOnePerScopeOfAJoint) {
    Node root = sample();
    auto& children = at(root, "HEAD/OBJE/SKIN/SKIN/PIVO").children;
    Node third = at(root, kHinge);
    edit<LimitRecord>(third, [](auto& limit) { limit.scope = static_cast<std::uint8_t>(LimitScope::all_but_ik); });
    children.push_back(third);
    EXPECT_EQ(faults_in(root), Lines{});
    children.push_back(third);
    children.push_back(third);
    EXPECT_EQ(faults_in(root), (Lines{"LIMIT_REPEATED " + kHinge + "[3]", "LIMIT_REPEATED " + kHinge + "[4]"}));
}

TEST(Limit, OfEveryModelIsFreeByDefault) {
    for (const LimitModel model : kModels) {
        EXPECT_EQ(faults_of(make_limit(model)), Lines{});
        EXPECT_TRUE(holds_rest(make_limit(model)));
    }
}

TEST(Limit, CountsTheAxesOfItsModel) {
    std::vector<unsigned> axes;
    for (const LimitModel model : kModels) axes.push_back(limited_axes(model));
    EXPECT_EQ(axes, (std::vector<unsigned>{0, 0, 1, 3, 3, 3, 1}));
}

// Every number of the record, NaN: one fault, whatever the model.
TEST(Limit, RefusesNaNAnywhere) {
    for (const LimitModel model : kModels) {
        for (std::size_t at = offsetof(LimitRecord, soft_zone); at < sizeof(LimitRecord); at += sizeof(float)) {
            Node leaf = make_leaf(FourCC("LIMT"), bytes_of(make_limit(model)));
            set(leaf, at, kNaN);
            LimitRecord limit;
            copy_at(leaf.payload, 0, limit);
            const Lines faults = faults_of(limit);
            ASSERT_EQ(faults.size(), 1u) << static_cast<int>(model) << " at " << at;
            const bool is_frame = at >= offsetof(LimitRecord, frame) && at < offsetof(LimitRecord, rotation_min);
            const bool is_stiffness = at >= offsetof(LimitRecord, stiffness) && at < offsetof(LimitRecord, preferred);
            EXPECT_EQ(faults[0].substr(0, faults[0].find(' ')), is_frame       ? "ROTATION_NOT_UNIT"
                                                                : is_stiffness ? "FRACTION_RANGE"
                                                                               : "NOT_FINITE")
                << at;
        }
    }
}

TEST(Limit, WantsFiniteNumbersWhereNothingIsFree) {
    for (const float bad : {kInf, -kInf}) {
        LimitRecord limit;
        limit.soft_zone = bad;
        EXPECT_EQ(faults_of(limit), Lines{"NOT_FINITE 0"});
        limit = {};
        limit.preferred[2] = bad;
        EXPECT_EQ(faults_of(limit), Lines{"NOT_FINITE 2"});
        limit = {};
        limit.stiffness[1] = bad;
        EXPECT_EQ(faults_of(limit), Lines{"FRACTION_RANGE 76"});
        limit = {};
        limit.frame[0] = bad;
        EXPECT_EQ(faults_of(limit), Lines{"ROTATION_NOT_UNIT 17"});
    }
}

TEST(Limit, HoldsStiffnessAndSoftZoneToTheirRanges) {
    LimitRecord limit;
    limit.stiffness = {0.0f, 1.0f, -0.0f};
    EXPECT_EQ(faults_of(limit), Lines{});
    limit.stiffness = {-0.001f, 1.001f, 0.5f};
    EXPECT_EQ(faults_of(limit), (Lines{"FRACTION_RANGE 72", "FRACTION_RANGE 76"}));
    limit = {};
    limit.soft_zone = -0.001f;
    EXPECT_EQ(faults_of(limit), Lines{"BELOW_ZERO 4"});
}

TEST(Limit, RefusesAMinimumAboveItsMaximumWhereItCounts) {
    for (const LimitModel model : kModels) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            LimitRecord limit = make_limit(model);
            limit.rotation_min[axis] = 1.0f;
            limit.rotation_max[axis] = 0.5f;
            limit.flags = kRestOutside;
            const bool counts = axis < limited_axes(model) && model != LimitModel::largest_angle;
            EXPECT_EQ(faults_of(limit), counts ? Lines{"LIMIT_ORDER " + std::to_string(axis)} : Lines{})
                << static_cast<int>(model) << " axis " << axis;
            limit = make_limit(model);
            limit.translation_min[axis] = 0.5f;
            limit.translation_max[axis] = -0.5f;
            EXPECT_EQ(faults_of(limit), Lines{"LIMIT_ORDER " + std::to_string(3 + axis)});
        }
    }
}

TEST(Limit, TakesARangeOfOneAngle) {
    EXPECT_EQ(faults_of(hinge(0.0f, 0.0f)), Lines{});
    EXPECT_EQ(faults_of(hinge(-0.0f, 0.0f)), Lines{});
    EXPECT_EQ(faults_of(hinge(0.0f, -0.0f)), Lines{});
    EXPECT_EQ(faults_of(box(0.0f, 0.0f)), Lines{});
}

// Both ends infinite on one side: no number is in the range, clamping to it would give infinity.
TEST(Limit, RefusesARangeThatNoNumberIsIn) {
    for (const float end : {kInf, -kInf}) {
        LimitRecord limit = hinge(end, end);
        limit.flags = kRestOutside;
        EXPECT_EQ(faults_of(limit), Lines{"LIMIT_RANGE 0"});
        for (std::size_t axis = 0; axis < 3; ++axis) {
            limit = {};
            limit.flags = kRestOutside;
            limit.translation_min[axis] = end;
            limit.translation_max[axis] = end;
            EXPECT_EQ(faults_of(limit), Lines{"LIMIT_RANGE " + std::to_string(3 + axis)});
        }
    }
}

TEST(Limit, OpensSwingOnBothSidesOfRest) {
    for (const LimitModel model : {LimitModel::swing_twist_ellipse, LimitModel::swing_twist_pyramid}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const float side : {1.0f, -1.0f}) {
                LimitRecord limit = make_limit(model);
                limit.rotation_min[axis] = side > 0.0f ? 0.25f : -0.5f;
                limit.rotation_max[axis] = side > 0.0f ? 0.5f : -0.25f;
                EXPECT_FALSE(holds_rest(limit));
                limit.flags = kRestOutside;
                EXPECT_EQ(faults_of(limit), axis == 0 ? Lines{} : Lines{"LIMIT_RANGE " + std::to_string(axis)});
                // A whole turn more is no way in: the limits of swing count from 0.
                limit.rotation_min[axis] = side > 0.0f ? 0.25f : -7.0f;
                limit.rotation_max[axis] = side > 0.0f ? 7.0f : -0.25f;
                EXPECT_EQ(faults_of(limit), axis == 0 ? Lines{} : Lines{"LIMIT_RANGE " + std::to_string(axis)});
            }
            LimitRecord limit = make_limit(model);
            limit.rotation_min[axis] = 0.0f;
            limit.rotation_max[axis] = 0.0f;
            EXPECT_EQ(faults_of(limit), Lines{});
        }
    }
}

TEST(Limit, OfALargestAngleReadsOneNumber) {
    LimitRecord limit = make_limit(LimitModel::largest_angle);
    limit.rotation_min = {kInf, 3.0f, 2.0f};
    limit.rotation_max = {0.0f, -3.0f, -kInf};
    EXPECT_EQ(faults_of(limit), Lines{});
    EXPECT_TRUE(holds_rest(limit));
    limit.rotation_max[0] = -0.001f;
    EXPECT_EQ(faults_of(limit), Lines{"LIMIT_RANGE 0"});
    EXPECT_FALSE(holds_rest(limit));
}

TEST(Limit, HoldsTheRestPoseOnTheCircle) {
    const float more = 1.0f + 1e-6f;
    EXPECT_TRUE(holds_rest(hinge(-1.0f, 1.0f)));
    EXPECT_TRUE(holds_rest(hinge(0.0f, 1.0f)));
    EXPECT_TRUE(holds_rest(hinge(-1.0f, 0.0f)));
    EXPECT_FALSE(holds_rest(hinge(1e-6f, 1.0f)));
    EXPECT_FALSE(holds_rest(hinge(std::numeric_limits<float>::denorm_min(), 1.0f)));
    EXPECT_FALSE(holds_rest(hinge(-1.0f, -1e-6f)));
    // Up to a turn, and about it.
    EXPECT_TRUE(holds_rest(hinge(kPi, 2.0f * kPi)));
    EXPECT_FALSE(holds_rest(hinge(kPi, 2.0f * kPi - 1e-6f)));
    EXPECT_TRUE(holds_rest(hinge(2.0f * kPi, 7.0f)));
    EXPECT_FALSE(holds_rest(hinge(2.0f * kPi * more, 7.0f)));
    EXPECT_TRUE(holds_rest(hinge(-7.0f, -2.0f * kPi)));
    EXPECT_FALSE(holds_rest(hinge(-2.0f * kPi + 1e-6f, -1.0f)));
    // A whole turn holds every angle, wherever it starts.
    for (const float low : {0.001f, 1.0f, kPi, -1.0f, -100.0f, 1e6f}) EXPECT_TRUE(holds_rest(hinge(low, low + 6.75f)));
    // Several turns away.
    EXPECT_TRUE(holds_rest(hinge(3.9f * kPi, 4.1f * kPi)));
    EXPECT_TRUE(holds_rest(hinge(-6.1f * kPi, -5.9f * kPi)));
    EXPECT_FALSE(holds_rest(hinge(4.1f * kPi, 5.9f * kPi)));
    // Half free.
    EXPECT_TRUE(holds_rest(hinge(1.0f, kInf)));
    EXPECT_TRUE(holds_rest(hinge(-kInf, -1.0f)));
    EXPECT_TRUE(holds_rest(hinge(-kInf, kInf)));
    EXPECT_TRUE(holds_rest(hinge(1.0f, kLargest)));
    EXPECT_TRUE(holds_rest(hinge(-kLargest, kLargest)));
    // What check_limit refuses anyway.
    for (const float end : {kInf, -kInf}) EXPECT_FALSE(holds_rest(hinge(end, end)));
    EXPECT_FALSE(holds_rest(hinge(kNaN, 1.0f)));
    EXPECT_FALSE(holds_rest(hinge(-1.0f, kNaN)));
}

TEST(Limit, HoldsTheRestPoseInEitherEulerForm) {
    EXPECT_TRUE(holds_rest(box(-0.5f, 0.5f)));
    EXPECT_TRUE(holds_rest(box(3.0f, 3.5f)));  // no rotation is half a turn about each axis as well
    EXPECT_TRUE(holds_rest(box(kPi, 4.0f)));
    EXPECT_TRUE(holds_rest(box(-4.0f, -kPi)));
    EXPECT_FALSE(holds_rest(box(0.5f, 3.0f)));
    LimitRecord mixed = box(-0.5f, 0.5f);
    mixed.rotation_min[1] = 3.0f;
    mixed.rotation_max[1] = 3.5f;
    EXPECT_FALSE(holds_rest(mixed));  // one axis of each form is none
}

TEST(Limit, HoldsTheRestPoseOnlyWithItsTranslation) {
    for (const LimitModel model : kModels) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            LimitRecord limit = make_limit(model);
            limit.translation_min[axis] = 0.0f;
            limit.translation_max[axis] = 0.0f;
            EXPECT_TRUE(holds_rest(limit));
            limit.translation_max[axis] = 0.5f;
            limit.translation_min[axis] = 0.25f;
            EXPECT_FALSE(holds_rest(limit));
            EXPECT_EQ(faults_of(limit), Lines{"REST_OUTSIDE 17"});
            limit.translation_min[axis] = -0.5f;
            limit.translation_max[axis] = -0.25f;
            EXPECT_FALSE(holds_rest(limit));
            limit.flags = kRestOutside;
            EXPECT_EQ(faults_of(limit), Lines{});
        }
    }
}

TEST(Limit, WantsTheFlagWhereTheRestPoseIsOutside) {
    LimitRecord limit = hinge(0.5f, 1.0f);
    EXPECT_EQ(faults_of(limit), Lines{"REST_OUTSIDE 17"});
    limit.flags = kApproximated | kProposed;
    EXPECT_EQ(faults_of(limit), Lines{"REST_OUTSIDE 17"});
    limit.flags = kRestOutside;
    EXPECT_EQ(faults_of(limit), Lines{});
    limit = hinge(-1.0f, 1.0f);
    limit.flags = kRestOutside;  // says too much, and harms nobody
    EXPECT_EQ(faults_of(limit), Lines{});
}

TEST(Limit, SaysNothingOfTheRestPoseWhereTheLimitsAreWrong) {
    LimitRecord limit = hinge(0.5f, 1.0f);
    limit.frame = {0.0f, 0.0f, 0.0f, 1.01f};
    EXPECT_EQ(faults_of(limit), Lines{"ROTATION_NOT_UNIT 17"});
}

}  // namespace
}  // namespace bendy
