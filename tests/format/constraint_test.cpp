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

namespace bendy::constraint_test {
namespace {

using namespace test;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kLargest = std::numeric_limits<float>::max();
const std::string kHinge = "HEAD/OBJE/SKIN/SKIN/PIVO/LIMT";
const std::string kSwing = "HEAD/OBJE/SKIN/SKIN/PIVO/LIMT[1]";

ConstraintRecord make_constraint_record(ConstraintModel model) {
    ConstraintRecord constraint;
    constraint.model = static_cast<std::uint8_t>(model);
    return constraint;
}

ConstraintRecord hinge(float low, float high) {
    ConstraintRecord constraint = make_constraint_record(ConstraintModel::hinge);
    constraint.rotation_min[0] = low;
    constraint.rotation_max[0] = high;
    return constraint;
}

ConstraintRecord box(float low, float high) {
    ConstraintRecord constraint = make_constraint_record(ConstraintModel::euler_box);
    constraint.rotation_min.fill(low);
    constraint.rotation_max.fill(high);
    return constraint;
}

/// What check_constraint says, each fault as "CODE value".
Lines faults_of(const ConstraintRecord& constraint) {
    constexpr std::uint32_t kJoint = 17;
    constexpr std::uint64_t kOffset = 4711;
    Faults faults;
    check_constraint(constraint, kJoint, kOffset, faults);
    Lines lines;
    for (const Error& fault : faults.list()) {
        EXPECT_EQ(fault.offset, kOffset);
        lines.push_back(std::string(code_name(fault.code)) + " " + std::to_string(fault.value));
    }
    return lines;
}

constexpr ConstraintModel kModels[] = {ConstraintModel::free,
                                       ConstraintModel::locked,
                                       ConstraintModel::hinge,
                                       ConstraintModel::swing_twist_ellipse,
                                       ConstraintModel::swing_twist_pyramid,
                                       ConstraintModel::euler_box,
                                       ConstraintModel::largest_angle};

TEST(Limit, AreReadInTheOrderOfTheirJoints) {
    const Loaded sample(sample_file());
    ASSERT_EQ(sample.lines(), Lines{});
    const auto& constraints = sample.document.objects.at(0).skeleton.constraints;
    ASSERT_EQ(constraints.size(), 2u);
    EXPECT_EQ(constraints[0].joint, 1u);
    EXPECT_EQ(constraints[0].record.model, static_cast<std::uint8_t>(ConstraintModel::hinge));
    EXPECT_EQ(constraints[0].record.soft_zone, 0.125f);
    EXPECT_EQ(constraints[0].record.rotation_max[0], 2.0f);
    EXPECT_EQ(constraints[0].record.rotation_max[1], kInf);
    EXPECT_EQ(constraints[1].joint, 1u);
    EXPECT_EQ(constraints[1].record.scope, static_cast<std::uint8_t>(ConstraintScope::ik_only));
    EXPECT_EQ(constraints[1].record.flags, kProposed);
    EXPECT_EQ(constraints[1].record.rotation_max, (std::array{0.5f, 0.75f, 1.0f}));
    EXPECT_EQ(constraints[1].record.translation_max, (std::array{0.0f, 0.125f, kInf}));
    EXPECT_EQ(constraints[1].record.stiffness, (std::array{0.0f, 0.5f, 1.0f}));
    EXPECT_EQ(sample.tree[constraints[1].chunk].offset, place_of(sample.file, kSwing));
}

TEST(Limit, RefusesValuesThatItDoesNotKnow) {
    const auto faults = [](const std::function<void(ConstraintRecord&)>& change) {
        Node root = sample();
        edit<ConstraintRecord>(at(root, kHinge), change);
        return faults_in(root);
    };
    EXPECT_EQ(faults([](auto& constraint) { constraint.model = kConstraintModels; }), Lines{"ENUM_RANGE " + kHinge});
    EXPECT_EQ(faults([](auto& constraint) { constraint.euler_order = kEulerOrders; }), Lines{"ENUM_RANGE " + kHinge});
    EXPECT_EQ(faults([](auto& constraint) { constraint.scope = kConstraintScopes; }), Lines{"ENUM_RANGE " + kHinge});
    EXPECT_EQ(faults([](auto& constraint) { constraint.flags = kConstraintFlags; }), Lines{"ENUM_RANGE " + kHinge});
    EXPECT_EQ(faults([](auto& constraint) { constraint.flags = kConstraintFlags - 1; }), Lines{});
    EXPECT_EQ(faults([](auto& constraint) { constraint.scope = 2; }), Lines{});
}

TEST(Limit, MayBeLongerButNotShorterThanItsRecord) {
    Node root = sample();
    at(root, kHinge).payload.push_back(std::byte{1});
    EXPECT_EQ(faults_in(root), Lines{});
    at(root, kHinge).payload.resize(sizeof(ConstraintRecord) - 1);
    EXPECT_EQ(faults_in(root), Lines{"RECORD_TOO_SHORT " + kHinge});
}

TEST(Limit, IsOnePerScopeOfAJoint) {
    Node root = sample();
    auto& children = at(root, "HEAD/OBJE/SKIN/SKIN/PIVO").children;
    Node third = at(root, kHinge);
    edit<ConstraintRecord>(
        third, [](auto& constraint) { constraint.scope = static_cast<std::uint8_t>(ConstraintScope::all_but_ik); });
    children.push_back(third);
    EXPECT_EQ(faults_in(root), Lines{});
    children.push_back(third);
    children.push_back(third);
    EXPECT_EQ(faults_in(root),
              (Lines{"CONSTRAINT_REPEATED " + kHinge + "[3]", "CONSTRAINT_REPEATED " + kHinge + "[4]"}));
}

TEST(Limit, OfEveryModelIsFreeByDefault) {
    for (const ConstraintModel model : kModels) {
        EXPECT_EQ(faults_of(make_constraint_record(model)), Lines{});
        EXPECT_TRUE(holds_rest(make_constraint_record(model)));
    }
}

TEST(Limit, CountsTheAxesOfItsModel) {
    std::vector<unsigned> axes;
    for (const ConstraintModel model : kModels) axes.push_back(limited_axes(model));
    EXPECT_EQ(axes, (std::vector<unsigned>{0, 0, 1, 3, 3, 3, 1}));
}

// Every number of the record, NaN: one fault, whatever the model.
TEST(Limit, RefusesNaNAnywhere) {
    for (const ConstraintModel model : kModels) {
        for (std::size_t at = offsetof(ConstraintRecord, soft_zone); at < sizeof(ConstraintRecord);
             at += sizeof(float)) {
            Node leaf = make_leaf(FourCC("LIMT"), bytes_of(make_constraint_record(model)));
            set(leaf, at, kNaN);
            ConstraintRecord constraint;
            copy_at(leaf.payload, 0, constraint);
            const Lines faults = faults_of(constraint);
            ASSERT_EQ(faults.size(), 1u) << static_cast<int>(model) << " at " << at;
            const bool is_frame =
                at >= offsetof(ConstraintRecord, frame) && at < offsetof(ConstraintRecord, rotation_min);
            const bool is_stiffness =
                at >= offsetof(ConstraintRecord, stiffness) && at < offsetof(ConstraintRecord, preferred);
            EXPECT_EQ(faults[0].substr(0, faults[0].find(' ')), is_frame       ? "ROTATION_NOT_UNIT"
                                                                : is_stiffness ? "FRACTION_RANGE"
                                                                               : "NOT_FINITE")
                << at;
        }
    }
}

TEST(Limit, WantsFiniteNumbersWhereNothingIsFree) {
    for (const float bad : {kInf, -kInf}) {
        ConstraintRecord constraint;
        constraint.soft_zone = bad;
        EXPECT_EQ(faults_of(constraint), Lines{"NOT_FINITE 0"});
        constraint = {};
        constraint.preferred[2] = bad;
        EXPECT_EQ(faults_of(constraint), Lines{"NOT_FINITE 2"});
        constraint = {};
        constraint.stiffness[1] = bad;
        EXPECT_EQ(faults_of(constraint), Lines{"FRACTION_RANGE 76"});
        constraint = {};
        constraint.frame[0] = bad;
        EXPECT_EQ(faults_of(constraint), Lines{"ROTATION_NOT_UNIT 17"});
    }
}

TEST(Limit, HoldsStiffnessAndSoftZoneToTheirRanges) {
    ConstraintRecord constraint;
    constraint.stiffness = {0.0f, 1.0f, -0.0f};
    EXPECT_EQ(faults_of(constraint), Lines{});
    constraint.stiffness = {-0.001f, 1.001f, 0.5f};
    EXPECT_EQ(faults_of(constraint), (Lines{"FRACTION_RANGE 72", "FRACTION_RANGE 76"}));
    constraint = {};
    constraint.soft_zone = -0.001f;
    EXPECT_EQ(faults_of(constraint), Lines{"BELOW_ZERO 4"});
}

TEST(Limit, RefusesAMinimumAboveItsMaximumWhereItCounts) {
    for (const ConstraintModel model : kModels) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            ConstraintRecord constraint = make_constraint_record(model);
            constraint.rotation_min[axis] = 1.0f;
            constraint.rotation_max[axis] = 0.5f;
            constraint.flags = kRestOutside;
            const bool counts = axis < limited_axes(model) && model != ConstraintModel::largest_angle;
            EXPECT_EQ(faults_of(constraint), counts ? Lines{"LIMIT_ORDER " + std::to_string(axis)} : Lines{})
                << static_cast<int>(model) << " axis " << axis;
            constraint = make_constraint_record(model);
            constraint.translation_min[axis] = 0.5f;
            constraint.translation_max[axis] = -0.5f;
            EXPECT_EQ(faults_of(constraint), Lines{"LIMIT_ORDER " + std::to_string(3 + axis)});
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
        ConstraintRecord constraint = hinge(end, end);
        constraint.flags = kRestOutside;
        EXPECT_EQ(faults_of(constraint), Lines{"LIMIT_RANGE 0"});
        for (std::size_t axis = 0; axis < 3; ++axis) {
            constraint = {};
            constraint.flags = kRestOutside;
            constraint.translation_min[axis] = end;
            constraint.translation_max[axis] = end;
            EXPECT_EQ(faults_of(constraint), Lines{"LIMIT_RANGE " + std::to_string(3 + axis)});
        }
    }
}

TEST(Limit, OpensSwingOnBothSidesOfRest) {
    for (const ConstraintModel model : {ConstraintModel::swing_twist_ellipse, ConstraintModel::swing_twist_pyramid}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const float side : {1.0f, -1.0f}) {
                ConstraintRecord constraint = make_constraint_record(model);
                constraint.rotation_min[axis] = side > 0.0f ? 0.25f : -0.5f;
                constraint.rotation_max[axis] = side > 0.0f ? 0.5f : -0.25f;
                EXPECT_FALSE(holds_rest(constraint));
                constraint.flags = kRestOutside;
                EXPECT_EQ(faults_of(constraint), axis == 0 ? Lines{} : Lines{"LIMIT_RANGE " + std::to_string(axis)});
                // A whole turn more is no way in: the limits of swing count from 0.
                constraint.rotation_min[axis] = side > 0.0f ? 0.25f : -7.0f;
                constraint.rotation_max[axis] = side > 0.0f ? 7.0f : -0.25f;
                EXPECT_EQ(faults_of(constraint), axis == 0 ? Lines{} : Lines{"LIMIT_RANGE " + std::to_string(axis)});
            }
            ConstraintRecord constraint = make_constraint_record(model);
            constraint.rotation_min[axis] = 0.0f;
            constraint.rotation_max[axis] = 0.0f;
            EXPECT_EQ(faults_of(constraint), Lines{});
        }
    }
}

TEST(Limit, OfALargestAngleReadsOneNumber) {
    ConstraintRecord constraint = make_constraint_record(ConstraintModel::largest_angle);
    constraint.rotation_min = {kInf, 3.0f, 2.0f};
    constraint.rotation_max = {0.0f, -3.0f, -kInf};
    EXPECT_EQ(faults_of(constraint), Lines{});
    EXPECT_TRUE(holds_rest(constraint));
    constraint.rotation_max[0] = -0.001f;
    EXPECT_EQ(faults_of(constraint), Lines{"LIMIT_RANGE 0"});
    EXPECT_FALSE(holds_rest(constraint));
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
    // What check_constraint refuses anyway.
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
    ConstraintRecord mixed = box(-0.5f, 0.5f);
    mixed.rotation_min[1] = 3.0f;
    mixed.rotation_max[1] = 3.5f;
    EXPECT_FALSE(holds_rest(mixed));  // one axis of each form is none
}

TEST(Limit, HoldsTheRestPoseOnlyWithItsTranslation) {
    for (const ConstraintModel model : kModels) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            ConstraintRecord constraint = make_constraint_record(model);
            constraint.translation_min[axis] = 0.0f;
            constraint.translation_max[axis] = 0.0f;
            EXPECT_TRUE(holds_rest(constraint));
            constraint.translation_max[axis] = 0.5f;
            constraint.translation_min[axis] = 0.25f;
            EXPECT_FALSE(holds_rest(constraint));
            EXPECT_EQ(faults_of(constraint), Lines{"REST_OUTSIDE 17"});
            constraint.translation_min[axis] = -0.5f;
            constraint.translation_max[axis] = -0.25f;
            EXPECT_FALSE(holds_rest(constraint));
            constraint.flags = kRestOutside;
            EXPECT_EQ(faults_of(constraint), Lines{});
        }
    }
}

TEST(Limit, WantsTheFlagWhereTheRestPoseIsOutside) {
    ConstraintRecord constraint = hinge(0.5f, 1.0f);
    EXPECT_EQ(faults_of(constraint), Lines{"REST_OUTSIDE 17"});
    constraint.flags = kApproximated | kProposed;
    EXPECT_EQ(faults_of(constraint), Lines{"REST_OUTSIDE 17"});
    constraint.flags = kRestOutside;
    EXPECT_EQ(faults_of(constraint), Lines{});
    constraint = hinge(-1.0f, 1.0f);
    constraint.flags = kRestOutside;  // says too much, and harms nobody
    EXPECT_EQ(faults_of(constraint), Lines{});
}

TEST(Limit, SaysNothingOfTheRestPoseWhereTheLimitsAreWrong) {
    ConstraintRecord constraint = hinge(0.5f, 1.0f);
    constraint.frame = {0.0f, 0.0f, 0.0f, 1.01f};
    EXPECT_EQ(faults_of(constraint), Lines{"ROTATION_NOT_UNIT 17"});
}

}  // namespace
}  // namespace bendy::constraint_test
