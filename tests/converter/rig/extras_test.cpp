#include "build_scene.h"

#include "rigging/rig/attach_rig.h"
#include "rigging/rig/blender.h"
#include "scene/rest_frames.h"

#include <bendy/format/constraint.h>

#include <glm/gtc/quaternion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace bendy::converter::extras_test {
namespace {

using namespace test;

constexpr double kPi = std::numbers::pi;
constexpr float kFree = ConstraintRecord::kFree;

Report attach_all(Scene& scene) {
    Report report;
    const JointIndex index(scene);
    Claims claims{std::vector<bool>(scene.joints.size()), {}};
    attach_extras(scene, index, claims, report);
    return report;
}

/// The constraints of one joint whose rig_joint this is, and what was said of it.
struct Read {
    std::vector<ConstraintRecord> constraints;
    std::vector<std::string> lines;
};
Read read(const std::string& rig_joint, glm::vec4 rotation = {0.0f, 0.0f, 0.0f, 1.0f}) {
    Scene scene = make_scene({{"Bone", kNone, {}, rotation}});
    scene.joints[0].extras = R"({"rig_joint": )" + rig_joint + "}";
    const std::string before = scene.joints[0].extras;
    const Report report = attach_all(scene);
    EXPECT_EQ(scene.joints[0].extras, before);
    return {scene.joints[0].constraints, lines_of(report)};
}

TEST(RigExtras, SwingAndTwistOfABoneAreAboutItsOwnAxes) {
    const Read got = read(
        R"({"swing_twist": {"swing_x": [-1, 1], "twist_y": [-2, 2], "swing_z": [-3, 3]}, "stiffness": [0.1, 0.2, 0.3]})");
    ASSERT_EQ(got.constraints.size(), 1u);
    EXPECT_TRUE(got.lines.empty());
    const ConstraintRecord& constraint = got.constraints[0];
    EXPECT_EQ(static_cast<ConstraintModel>(constraint.model), ConstraintModel::swing_twist_ellipse);
    EXPECT_EQ(static_cast<ConstraintScope>(constraint.scope), ConstraintScope::ik_only);
    // Whatever the frame: its X, Y and Z are axes of the bone, and what is said about them is said about those.
    const Rotation frame = to_rotation(constraint.frame);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 unit(0.0);
        unit[axis] = 1.0;
        const glm::dvec3 in_bone = frame * unit;
        for (int bone_axis = 0; bone_axis < 3; ++bone_axis) {
            if (std::abs(in_bone[bone_axis]) < 0.5) continue;
            EXPECT_NEAR(in_bone[bone_axis], 1.0, 1e-12);
            const auto at = static_cast<std::size_t>(axis);
            EXPECT_EQ(constraint.rotation_max[at], static_cast<float>(bone_axis + 1));
            EXPECT_EQ(constraint.rotation_min[at], static_cast<float>(-bone_axis - 1));
            EXPECT_EQ(constraint.stiffness[at], 0.1f * static_cast<float>(bone_axis + 1));
        }
    }
    EXPECT_NEAR((frame * glm::dvec3(1, 0, 0)).y, 1.0, 1e-12);  // the twist is about Y, along the bone
}

TEST(RigExtras, WhatIsMissingIsFree) {
    const ConstraintRecord constraint = read(R"({"swing_twist": {"swing_z": [-1, 1]}})").constraints.at(0);
    EXPECT_EQ(constraint.rotation_min, (std::array{-kFree, -1.0f, -kFree}));
    const ConstraintRecord stiff = read(R"({"stiffness": [0.5, 0, 0]})").constraints.at(0);
    EXPECT_EQ(static_cast<ConstraintModel>(stiff.model), ConstraintModel::free);
    EXPECT_EQ(static_cast<ConstraintScope>(stiff.scope), ConstraintScope::ik_only);
    EXPECT_EQ(stiff.stiffness, (std::array{0.5f, 0.0f, 0.0f}));
    EXPECT_TRUE(read(R"({"stiffness": [0, 0, 0], "locks": {"rotation": [true, true, true]}, "length": 1})")
                    .constraints.empty());
}

TEST(RigExtras, NoRoomOnAnyAxisIsLocked) {
    const auto limits =
        read(R"({"swing_twist": {"swing_x": [0, 0], "twist_y": [0, 0], "swing_z": [0, 0]}})").constraints;
    EXPECT_EQ(static_cast<ConstraintModel>(limits.at(0).model), ConstraintModel::locked);
    EXPECT_EQ(limits[0].rotation_max[0], kFree);
}

TEST(RigExtras, LimitRotationIsABox) {
    const Read alone = read(R"({"euler_limits": [{"space": "rest", "order": "YXZ", "x": [-1, 2], "z": [0, 0]}]})");
    ASSERT_EQ(alone.constraints.size(), 1u);
    const ConstraintRecord& box = alone.constraints[0];
    EXPECT_EQ(static_cast<ConstraintModel>(box.model), ConstraintModel::euler_box);
    EXPECT_EQ(static_cast<EulerOrder>(box.euler_order), EulerOrder::yxz);
    EXPECT_EQ(static_cast<ConstraintScope>(box.scope), ConstraintScope::every_pose);
    EXPECT_EQ(box.flags, 0);
    EXPECT_EQ(box.frame, ConstraintRecord{}.frame);
    EXPECT_EQ(box.rotation_min, (std::array{-1.0f, -kFree, 0.0f}));
    EXPECT_EQ(box.rotation_max, (std::array{2.0f, kFree, 0.0f}));
    const auto both = read(R"({"euler_limits": [{"x": [0, 1]}], "stiffness": [0, 0, 0.5]})").constraints;
    ASSERT_EQ(both.size(), 2u);
    EXPECT_EQ(static_cast<ConstraintScope>(both[0].scope), ConstraintScope::all_but_ik);
    EXPECT_EQ(static_cast<ConstraintScope>(both[1].scope), ConstraintScope::ik_only);
}

TEST(RigExtras, SeveralBoxesOfOneKindAreWhatAllAllow) {
    const Read got =
        read(R"({"euler_limits": [{"x": [-1, 2]}, {"x": [-3, 1], "y": [0, 1]}, {"influence": 0, "x": [0, 0]}]})");
    EXPECT_EQ(got.constraints.at(0).rotation_min, (std::array{-1.0f, 0.0f, -kFree}));
    EXPECT_EQ(got.constraints[0].rotation_max, (std::array{1.0f, 1.0f, kFree}));
    EXPECT_EQ(got.constraints[0].flags, 0);
    const Read other = read(R"({"euler_limits": [{"x": [-1, 2]}, {"order": "ZYX", "x": [0, 0]}, {"x": [3, 4]}]})");
    EXPECT_EQ(other.constraints.at(0).rotation_max[0], 2.0f);
    EXPECT_EQ(other.constraints[0].flags, kApproximated);
    ASSERT_EQ(other.lines.size(), 1u);
    EXPECT_NE(other.lines[0].find("the first counts (2 times)"), std::string::npos);
}

TEST(RigExtras, PartOfTheInfluenceIsAnApproximation) {
    const Read got = read(R"({"euler_limits": [{"x": [-1, 2], "influence": 0.5}]})");
    EXPECT_EQ(got.constraints.at(0).flags, kApproximated);
    EXPECT_EQ(got.lines.size(), 1u);
}

TEST(RigExtras, EulerAnglesComeBackInEveryOrder) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> angle(-1.5, 1.5);
    for (unsigned number = 0; number < kEulerOrders; ++number) {
        const auto order = static_cast<EulerOrder>(number);
        for (int i = 0; i < 100; ++i) {
            const std::array<double, 3> angles{angle(random), angle(random), angle(random)};
            Rotation rotation(1.0, 0.0, 0.0, 0.0);
            for (const std::size_t axis : axes_of(order)) {  // the first turns first
                glm::dvec3 unit(0.0);
                unit[static_cast<int>(axis)] = 1.0;
                rotation = glm::angleAxis(angles[axis], unit) * rotation;
            }
            const std::array<double, 3> back = to_euler(rotation, order);
            for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(back[axis], angles[axis], 1e-12);
        }
    }
}

/// True where R = conj(C) * rotation * C is in the box.
bool is_inside(const ConstraintRecord& constraint, const Rotation& rotation) {
    const Rotation frame = to_rotation(constraint.frame);
    const auto angles =
        to_euler(glm::conjugate(frame) * rotation * frame, static_cast<EulerOrder>(constraint.euler_order));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        bool holds = false;
        for (const double turn : {-2.0 * kPi, 0.0, 2.0 * kPi}) {
            const double value = angles[axis] + turn;
            holds = holds || (constraint.rotation_min[axis] <= value && value <= constraint.rotation_max[axis]);
        }
        if (!holds) return false;
    }
    return true;
}

std::string text_of(const Rotation& r) {
    return '[' + std::to_string(r.x) + ',' + std::to_string(r.y) + ',' + std::to_string(r.z) + ',' +
           std::to_string(r.w) + ']';
}

TEST(RigExtras, ABoxInTheArmaturesSpaceCountsTheRestRotation) {
    // Blender limits the angles of g conj(zero), g the bone's orientation. With the parents at rest that is held
    // exactly if the bone rests turned about the first and the last axis only.
    std::mt19937 random(2);
    std::uniform_real_distribution<double> angle(-1.2, 1.2);
    ConstraintRecord source;
    source.rotation_min = {-0.5f, -0.7f, -1.0f};
    source.rotation_max = {0.9f, 0.3f, 0.4f};
    int inside = 0;
    for (int i = 0; i < 200; ++i) {
        const Rotation zero = glm::normalize(Rotation(1.0, angle(random), angle(random), angle(random)));
        const Rotation rest = glm::angleAxis(angle(random), glm::dvec3(0, 0, 1)) *
                              glm::angleAxis(angle(random), glm::dvec3(1, 0, 0)) * zero;
        const Read got = read(R"({"euler_limits": [{"space": ")" + std::string(i % 2 == 0 ? "armature" : "world") +
                                  R"(", "zero": )" + text_of(zero) +
                                  R"(, "order": "XYZ", "x": [-0.5, 0.9], "y": [-0.7, 0.3], "z": [-1, 0.4]}]})",
                              glm::vec4(rest.x, rest.y, rest.z, rest.w));
        const ConstraintRecord& constraint = got.constraints.at(0);
        EXPECT_NE(constraint.flags & kApproximated, 0);
        for (int k = 0; k < 50; ++k) {
            const Rotation local =
                glm::normalize(Rotation(1.0, 0.5 * angle(random), 0.5 * angle(random), 0.5 * angle(random)));
            const bool is_legal = is_inside(source, glm::normalize(rest * local * glm::conjugate(zero)));
            EXPECT_EQ(is_inside(constraint, local), is_legal);
            inside += is_legal ? 1 : 0;
        }
    }
    EXPECT_GT(inside, 500);
}

TEST(RigExtras, OtherSpacesAreApproximatedOrLeftOut) {
    const Read with_parent =
        read(R"({"euler_limits": [{"space": "rest_with_parent", "x": [-1, 1]}]})", {0.6f, 0, 0, 0.8f});
    EXPECT_EQ(with_parent.constraints.at(0).flags, kApproximated);
    EXPECT_EQ(with_parent.constraints[0].frame, ConstraintRecord{}.frame);
    EXPECT_EQ(with_parent.constraints[0].rotation_max[0], 1.0f);
    EXPECT_EQ(with_parent.lines.size(), 1u);
    const Read custom = read(R"({"euler_limits": [{"space": "custom", "x": [-1, 1]}]})");
    EXPECT_TRUE(custom.constraints.empty());
    EXPECT_EQ(custom.lines.size(), 1u);
    const auto half = static_cast<float>(std::sqrt(0.5));
    const Read across = read(R"({"euler_limits": [{"space": "armature", "zero": [0, 0, 0, 1], "x": [-1, 1]}]})",
                             {0.0f, half, 0.0f, half});
    EXPECT_TRUE(across.constraints.empty());
    EXPECT_EQ(across.lines.size(), 2u);
    // A bone that rests with its armature's axes, as Blender has them.
    const Read plain = read(R"({"euler_limits": [{"space": "armature", "x": [-0.5, 1]}]})", {-half, 0.0f, 0.0f, half});
    EXPECT_NEAR(plain.constraints.at(0).rotation_min[0], -0.5, 1e-6);
    EXPECT_NEAR(plain.constraints[0].rotation_max[0], 1.0, 1e-6);
}

TEST(RigExtras, TheArmatureIsAboveTheTopmostJointOfASkin) {
    const auto half = static_cast<float>(std::sqrt(0.5));
    // The armature is turned about Z by a quarter, which is nothing to the bone in its space.
    Scene scene = make_scene({{"World"}, {"Armature", 0, {}, {0.0f, 0.0f, half, half}}, {"Root", 1}, {"Bone", 2}});
    scene.meshes.resize(1);
    scene.meshes[0].palette.joints = {3, 2};
    scene.joints[3].extras =
        R"({"rig_joint": {"euler_limits": [{"space": "armature", "zero": [0, 0, 0, 1], "z": [-0.5, 1]}]}})";
    attach_all(scene);
    EXPECT_NEAR(scene.joints[3].constraints.at(0).rotation_min[2], -0.5, 1e-6);
    scene.joints[3].constraints.clear();
    scene.joints[3].extras.replace(scene.joints[3].extras.find("armature"), 8, "world");
    attach_all(scene);
    EXPECT_NEAR(scene.joints[3].constraints.at(0).rotation_min[2], -0.5 - kPi / 2, 1e-6);
}

TEST(RigExtras, WhatTheExporterNotesIsPassedOn) {
    const Read got = read(R"({"stiffness": [0, 0.5, 0], "approximated": true, "notes": ["it is\nmuted", 3]})");
    EXPECT_EQ(got.constraints.at(0).flags, kApproximated);
    EXPECT_EQ(got.lines, std::vector<std::string>{"nodes.Bone.extras.rig_joint: it is muted"});
}

TEST(RigExtras, LimitLocationGoesWithTheBoxOrAlone) {
    const std::string location = R"("location_limits": [{"space": "rest", "y": [-0.5, null]}, {"y": [null, 2]}])";
    const Read alone = read("{" + location + "}");
    ASSERT_EQ(alone.constraints.size(), 1u);
    EXPECT_EQ(static_cast<ConstraintModel>(alone.constraints[0].model), ConstraintModel::free);
    EXPECT_EQ(alone.constraints[0].translation_min, (std::array{-kFree, -0.5f, -kFree}));
    EXPECT_EQ(alone.constraints[0].translation_max, (std::array{kFree, 2.0f, kFree}));
    const Read boxed = read(R"({"euler_limits": [{"x": [0, 1]}], )" + location + "}");
    ASSERT_EQ(boxed.constraints.size(), 1u);
    EXPECT_EQ(boxed.constraints[0].translation_max[1], 2.0f);
    const Read apart =
        read(R"({"euler_limits": [{"space": "world", "x": [-1, 1]}], "stiffness": [0, 0.5, 0], )" + location + "}",
             {0.6f, 0.0f, 0.0f, 0.8f});
    ASSERT_EQ(apart.constraints.size(), 3u);
    EXPECT_EQ(static_cast<ConstraintScope>(apart.constraints[2].scope), ConstraintScope::every_pose);
    EXPECT_EQ(apart.constraints[2].frame, ConstraintRecord{}.frame);
    const Read world = read(R"({"location_limits": [{"space": "world", "y": [0, 1]}]})");
    EXPECT_TRUE(world.constraints.empty());
    EXPECT_EQ(world.lines.size(), 1u);
}

TEST(RigExtras, LimitsAsInARigFileAreInRadians) {
    const Read got = read(R"({"limits": {"model": "hinge", "x": [0, 1.5]}, "stiffness": [1, 1, 1]})");
    ASSERT_EQ(got.constraints.size(), 1u);
    EXPECT_EQ(got.constraints[0].rotation_max[0], 1.5f);
    EXPECT_TRUE(read(R"({"limits": []})").constraints.empty());
}

TEST(RigExtras, AJsonStringIsAsGood) {
    EXPECT_EQ(read(R"("{\"limits\": {\"model\": \"locked\"}}")").constraints.size(), 1u);
    const Read bad = read(R"("{\"limits\": ")");
    EXPECT_TRUE(bad.constraints.empty());
    ASSERT_EQ(bad.lines.size(), 1u);
    EXPECT_EQ(bad.lines[0].substr(0, 65), "nodes.Bone.extras.rig_joint: extras left out: invalid JSON at lin");
}

TEST(RigExtras, WhatIsWrongIsNamedAndLeftOut) {
    const auto line = [](const std::string& rig_joint) {
        const Read got = read(rig_joint);
        EXPECT_TRUE(got.constraints.empty());
        return got.lines.empty() ? "nothing" : got.lines[0];
    };
    EXPECT_EQ(line("7"), "nodes.Bone.extras.rig_joint: constraints left out: it must be an object, not 7");
    EXPECT_EQ(line(R"({"swing_twist": {"swing_x": [-1, "1"]}})"),
              "nodes.Bone.extras.rig_joint.swing_twist.swing_x[1]: constraints left out: expected a number, found '1'");
    EXPECT_EQ(line(R"({"euler_limits": [{"space": "moon"}]})").substr(0, 46),
              "nodes.Bone.extras.rig_joint.euler_limits[0].sp");
    EXPECT_EQ(line(R"({"limits": {"model": "hinge", "x": [2, 1]}})"),
              "nodes.Bone.extras.rig_joint.limits.x: constraints left out: the minimum 2.0 is above the maximum 1.0");
    EXPECT_NE(line(R"({"swing_twist": {"swing_x": [0.5, 1]}})"), "nothing");
    EXPECT_NE(line(R"({"stiffness": [0, 0, 2]})"), "nothing");
    EXPECT_NE(line(R"({"rest_orientation": [0, 0, 0, 0], "euler_limits": 3})"), "nothing");
}

TEST(RigExtras, ARestPoseOutsideIsFlaggedAndNamed) {
    const Read got = read(R"({"euler_limits": [{"x": [0.5, 1]}]})");
    EXPECT_EQ(got.constraints.at(0).flags, kRestOutside);
    ASSERT_EQ(got.lines.size(), 1u);
    EXPECT_NE(got.lines[0].find("the rest pose of joint 'Bone' is outside"), std::string::npos);
}

TEST(RigExtras, LimitsAreTurnedBackWhereAToolTurnedTheBone) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    const auto any = [&] {
        return glm::normalize(Rotation(normal(random), normal(random), normal(random), normal(random)));
    };
    for (int i = 0; i < 50; ++i) {
        const Rotation then = any();
        const Rotation now = any();
        const Rotation parent = any();
        const Rotation rest = glm::conjugate(parent) * now;
        Scene scene = make_scene({{"parent", kNone, {}, {parent.x, parent.y, parent.z, parent.w}},
                                  {"bone", 0, {}, {rest.x, rest.y, rest.z, rest.w}}});
        const std::string limits = R"("euler_limits": [{"x": [-1, 1]}], "swing_twist": {"swing_x": [-1, 1]}})";
        scene.joints[1].extras = R"({"rig_joint": {"rest_orientation": )" + text_of(then) + ", " + limits + "}";
        const Report report = attach_all(scene);
        ASSERT_EQ(report.warnings().size(), 1u);
        ASSERT_EQ(scene.joints[1].constraints.size(), 2u);
        const auto written = read("{" + limits).constraints;
        // One motion in the old axes and in the new ones is the same R.
        const Rotation turn = glm::conjugate(then) * now;
        const Rotation motion = any();
        const Rotation motion_now = glm::conjugate(turn) * motion * turn;
        for (std::size_t k = 0; k < 2; ++k) {
            const Rotation old_frame = to_rotation(written[k].frame);
            const Rotation frame = to_rotation(scene.joints[1].constraints[k].frame);
            const Rotation a = glm::conjugate(old_frame) * motion * old_frame;
            const Rotation b = glm::conjugate(frame) * motion_now * frame;
            EXPECT_NEAR(std::abs(glm::dot(a, b)), 1.0, 1e-5);
        }
    }
}

TEST(RigExtras, SmallDifferencesOfTheRestOrientationAreRounding) {
    const Read got = read(R"({"rest_orientation": [0.0004, 0, 0, 1], "limits": {"model": "locked"}})");
    EXPECT_EQ(got.constraints.at(0).frame, ConstraintRecord{}.frame);
    EXPECT_TRUE(got.lines.empty());
}

// --- chains

/// An arm along X that is bent towards -Z, a hand at its end, a target and a pole, under an armature at (0, 1, 0).
Scene make_arm(const std::string& chain) {
    Scene scene = make_scene({{"Armature", kNone, {0, 1, 0}},
                              {"Upper", 0, {0, 0, 0}},
                              {"Lower", 1, {1, 0, -0.1f}},
                              {"Hand", 2, {1, 0, 0.1f}},
                              {"Target", 0, {2, 0, 0}},
                              {"Pole", 0, {1, 0, -3}}});
    scene.joints[0].extras = R"({"rig_ik": {"chains": [)" + chain + "]}}";
    return scene;
}

std::string arm_chain(const std::string& more) {
    return R"({"name": "IK", "joints": ["Upper", "Lower"], "nodes": [70, 71], "effector_offset": [1, 0, 0.1],)"
           R"( "solver": "blender_legacy", "iterations": 50, "influence": 0.5, "weight": 1, "position": true,)"
           R"( "rotation": false, "stretch": false)" +
           more + "}";
}

TEST(RigExtras, ABlenderChain) {
    Scene scene = make_arm(arm_chain(
        R"(, "target": {"object": "Armature", "joint": "Target", "position": [9, 9, 9], "node": 3},)"
        R"( "pole": {"object": "Armature", "joint": "Pole", "position": [1, 0, -3], "angle": -1.570796, "axis": [0, 0, -1]})"));
    const Report report = attach_all(scene);
    EXPECT_TRUE(lines_of(report).empty());
    const Chain& chain = scene.chains.at(0);
    EXPECT_EQ(chain.name, "IK");
    EXPECT_EQ(chain.record.start, 1u);
    EXPECT_EQ(chain.record.effector, 3u);  // the child at the last bone's tip
    EXPECT_EQ(chain.record.tip_offset, (std::array{0.0f, 0.0f, 0.0f}));
    EXPECT_EQ(chain.record.target, 4u);
    EXPECT_EQ(chain.record.pole, 5u);
    EXPECT_EQ(static_cast<Solver>(chain.record.solver), Solver::two_bone);
    EXPECT_EQ(chain.record.iterations, 50);
    EXPECT_EQ(chain.record.influence, 0.5f);
    EXPECT_EQ(chain.record.position_weight, 1.0f);
    EXPECT_EQ(chain.record.rotation_weight, 0.0f);
    EXPECT_EQ(chain.record.flags, 0);
    EXPECT_NEAR(chain.record.pole_angle, 0.0f, 1e-6f);  // -Z goes to the pole, and -Z is where the elbow is
}

TEST(RigExtras, ThePoleAngleIsFromTheBonesAxisToTheBend) {
    const auto angle_of = [](const std::string& axis) {
        Scene scene = make_arm(arm_chain(R"(, "pole": {"joint": "Pole", "axis": )" + axis + "}"));
        attach_all(scene);
        return scene.chains.at(0).record.pole_angle;
    };
    // About the line from start to tip, which is X: from Y to -Z is -90 degrees.
    EXPECT_NEAR(angle_of("[0, 1, 0]"), -kPi / 2, 1e-6);
    EXPECT_NEAR(angle_of("[0.7, -1, 0]"), kPi / 2, 1e-6);
    EXPECT_NEAR(std::abs(angle_of("[0, 0, 1]")), kPi, 1e-6);
    EXPECT_EQ(angle_of("[1, 0, 0]"), 0.0f);  // along the line: it turns nothing
}

TEST(RigExtras, ATipWithoutAJointIsAnOffset) {
    Scene scene = make_arm(arm_chain(R"(, "effector_offset": [1, 0, 0.3])"));
    scene.joints[0].extras.replace(scene.joints[0].extras.find(R"("effector_offset": [1, 0, 0.1],)"), 31, "");
    attach_all(scene);
    EXPECT_EQ(scene.chains.at(0).record.effector, 2u);
    EXPECT_EQ(scene.chains[0].record.tip_offset, (std::array{1.0f, 0.0f, 0.3f}));
    Scene turned = make_arm(arm_chain(R"(, "orientation_weight": 0.25)"));
    std::string& extras = turned.joints[0].extras;
    extras.replace(extras.find(R"("rotation": false)"), 17, R"("rotation": 1)");
    attach_all(turned);
    EXPECT_EQ(turned.chains.at(0).record.effector, 2u);  // it is the last bone that is to be turned
    EXPECT_EQ(turned.chains[0].record.rotation_weight, 0.25f);
}

TEST(RigExtras, APoleThatIsNoJointIsADirection) {
    Scene scene = make_arm(arm_chain(R"(, "pole": {"object": "Empty", "position": [0.5, 0, -3], "axis": [0, 0, -1]})"));
    const Report report = attach_all(scene);
    EXPECT_EQ(report.warnings().size(), 1u);
    const ChainRecord& record = scene.chains.at(0).record;
    EXPECT_EQ(record.pole, kNone);
    EXPECT_NEAR(record.pole_vector[0], 0.0f, 1e-6f);
    EXPECT_NEAR(record.pole_vector[1], 0.0f, 1e-6f);
    EXPECT_NEAR(record.pole_vector[2], -1.0f, 1e-6f);
    EXPECT_EQ(record.flags, kApproximated);
}

TEST(RigExtras, BonesThatStretchAreAnApproximation) {
    const std::string chain = arm_chain("");
    std::string stretching = chain;
    stretching.replace(stretching.find(R"("stretch": false)"), 16, R"("stretch": true)");
    Scene stiff = make_arm(stretching);
    attach_all(stiff);
    EXPECT_EQ(stiff.chains.at(0).record.stretch, 0.0f);
    EXPECT_EQ(stiff.chains[0].record.flags, 0);
    Scene soft = make_arm(stretching);
    soft.joints[1].extras = R"({"rig_joint": {"stretch": 0.5}})";
    EXPECT_EQ(attach_all(soft).warnings().size(), 1u);
    EXPECT_EQ(soft.chains.at(0).record.stretch, 0.5f);
    EXPECT_EQ(soft.chains[0].record.flags, kApproximated);
}

TEST(RigExtras, ChainsOfTheSceneAndChainsAsInARigFile) {
    Scene scene =
        make_arm(R"({"name": "own", "start": "Upper", "effector": "Hand", "pole_angle": 1.5, "weights": {"L*": 0.5}})");
    scene.extras =
        R"({"rig_ik": "{\"chains\": [{\"name\": \"of the scene\", \"start\": \"#1\", \"effector\": \"#1\"}]}"})";
    EXPECT_TRUE(attach_all(scene).warnings().empty());
    ASSERT_EQ(scene.chains.size(), 2u);
    EXPECT_EQ(scene.chains[0].record.pole_angle, 1.5f);
    EXPECT_EQ(scene.chains[0].weights.at(0).joint, 2u);
    EXPECT_EQ(scene.chains[1].name, "of the scene");
}

TEST(RigExtras, DoubledChainNamesAreToldApart) {
    Scene scene =
        make_arm(arm_chain("") + ", " + R"({"name": "IK", "joints": ["Lower"]}, {"name": "IK", "joints": ["Lower"]})");
    const Report report = attach_all(scene);
    std::vector<std::string> names;
    for (const Chain& chain : scene.chains) names.push_back(chain.name);
    EXPECT_EQ(names, (std::vector<std::string>{"IK.Hand", "IK.Lower", "IK.Lower.2"}));
    EXPECT_EQ(report.warnings().size(), 1u);
}

TEST(RigExtras, JointsOfTheSameArmatureGoFirst) {
    Scene scene = make_scene({{"One"}, {"Bone", 0}, {"Two"}, {"Bone", 2}});
    scene.joints[2].extras =
        R"({"rig_ik": {"chains": [{"name": "c", "joints": ["Bone"], "target": {"object": "One"}}]}})";
    attach_all(scene);
    EXPECT_EQ(scene.chains.at(0).record.start, 3u);
    EXPECT_EQ(scene.chains[0].record.target, 0u);
}

TEST(RigExtras, BadChainsAreNamedAndLeftOutAndTheOthersStay) {
    const auto line = [](const std::string& chain) {
        Scene scene = make_arm(chain + R"(, {"name": "good", "joints": ["Lower"]})");
        const Report report = attach_all(scene);
        EXPECT_EQ(scene.chains.size(), 1u);
        return lines_of(report).at(0);
    };
    const std::string place = "nodes.Armature.extras.rig_ik.chains[0]";
    EXPECT_EQ(line("1"), place + ": chain left out: it must be an object, not 1");
    EXPECT_EQ(line(R"({"joints": ["Upper"]})"), place + ".name: chain left out: it is required and missing");
    EXPECT_EQ(line(R"({"name": "c", "joints": []})"), place + ".joints: chain left out: it must not be empty");
    EXPECT_EQ(line(R"({"name": "c", "joints": ["Upper", "Gone"]})"),
              place + ".joints[1]: chain left out: there is no joint 'Gone'");
    EXPECT_EQ(line(R"({"name": "c", "joints": ["Lower", "Upper"]})"),
              place + ".joints: chain left out: joint 'Lower' is neither 'Upper' itself nor above it");
    EXPECT_EQ(line(R"({"name": "c", "joints": ["Upper", 3]})"),
              place + ".joints[1]: chain left out: it must be a string, not 3");
    EXPECT_EQ(line(R"({"name": "c", "start": "Upper", "effector": "Hand", "bones": 3})").substr(0, place.size() + 6),
              place + ".bones");
    EXPECT_EQ(line(R"({"name": "c", "start": "Upper", "effector": "Lower", "weights": {"Hand": 1}})"),
              place + ".weights.Hand: chain left out: the chain has no such joint");
    EXPECT_EQ(line(R"({"name": "c", "joints": ["Upper"], "influence": 2})"),
              place + ".influence: chain left out: 2.0 is not between 0.0 and 1.0");
}

TEST(RigExtras, AChainWhoseFirstBonesAreNotInTheFileStartsBelow) {
    Scene scene = make_arm(
        R"({"name": "c", "joints": ["Gone", "Lower"], "approximated": true, "notes": ["not in the file: Gone"]})");
    const Report report = attach_all(scene);
    EXPECT_EQ(scene.chains.at(0).record.start, 2u);
    EXPECT_EQ(scene.chains[0].record.flags, kApproximated);
    EXPECT_EQ(report.warnings().size(), 2u);
}

TEST(RigExtras, JointsOutOfRangeMakeNoChain) {
    Scene scene = make_arm(arm_chain(R"(, "pole": {"joint": "Pole", "axis": [0, 0, -1]})"));
    for (Joint& joint : scene.joints) joint.rest.scale = glm::vec3(3e38f);
    std::vector<Joint> deep;
    for (std::uint32_t i = 0; i < 20; ++i) {
        Joint joint = scene.joints[0];
        joint.extras.clear();
        joint.parent = i == 0 ? kNone : i - 1;
        deep.push_back(joint);
    }
    for (Joint& joint : scene.joints) joint.parent = joint.parent == kNone ? 19 : joint.parent + 20;
    scene.joints.insert(scene.joints.begin(), deep.begin(), deep.end());
    attach_all(scene);
    for (const Chain& chain : scene.chains) {
        EXPECT_TRUE(std::isfinite(chain.record.pole_angle));
        for (const float number : chain.record.tip_offset) EXPECT_TRUE(std::isfinite(number));
    }
}

TEST(RigExtras, OtherExtrasAreNoneOfOurBusiness) {
    Scene scene = make_row({"a", "b"});
    scene.joints[0].extras = R"({"rig_joints": 3, "x": "rig_joint"})";
    scene.joints[1].extras = R"(["rig_joint"])";
    scene.extras = R"({"rig_joint": {"limits": 3}})";
    EXPECT_TRUE(attach_all(scene).warnings().empty());
}

}  // namespace
}  // namespace bendy::converter::extras_test
