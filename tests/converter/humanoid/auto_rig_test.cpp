#include "rigging/humanoid/auto_rig.h"

#include "humanoid_gltf.h"
#include "scene/rest_frames.h"
#include "source_folder.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/format/constraint.h>
#include <bendy/format/document.h>
#include <bendy/runtime/constrain.h>

#include <gtest/gtest.h>

#include <array>

namespace bendy::converter::auto_rig_test {
namespace {

using namespace test;

struct Rigged {
    Scene scene;
    Report report;

    [[nodiscard]] std::uint32_t joint(const std::string& name) const { return joint_named(scene, name); }
    [[nodiscard]] const ConstraintRecord& constraint(const std::string& name) const {
        static const ConstraintRecord kNothing;
        const Joint& joint = scene.joints[joint_named(scene, name)];
        if (joint.constraints.size() == 1) return joint.constraints[0];
        ADD_FAILURE() << name << " has " << joint.constraints.size() << " limits";
        return kNothing;
    }
    [[nodiscard]] std::size_t limited() const {
        std::size_t count = 0;
        for (const Joint& joint : scene.joints) count += joint.constraints.size();
        return count;
    }
    [[nodiscard]] bool proposes(std::string_view line) const {
        for (const Proposal& proposal : report.proposals()) {
            if (proposal.line == line) return true;
        }
        return false;
    }
    /// The proposal for the joint or chain of that name.
    [[nodiscard]] std::string line_of(std::string_view name) const {
        for (const Proposal& proposal : report.proposals()) {
            if (proposal.name == name) return proposal.line;
        }
        return {};
    }
};

Rigged rig(Scene scene, const std::vector<bool>& claimed = {}) {
    Rigged result{std::move(scene), {}};
    auto_rig(result.scene, claimed, result.report);
    EXPECT_TRUE(validate(build_chunks(result.scene, "test", result.report)).empty());
    for (const Joint& joint : result.scene.joints) {
        for (const ConstraintRecord& constraint : joint.constraints) {
            EXPECT_EQ(constraint.flags, kProposed) << joint.name;
            EXPECT_TRUE(holds_rest(constraint)) << joint.name;
        }
    }
    return result;
}
Rigged rig(const Gltf& gltf) {
    return rig(*gltf.import());
}
Rigged rig(const HumanoidGltf& character) {
    return rig(character.build());
}

double low(const ConstraintRecord& constraint, std::size_t axis) {
    return static_cast<double>(constraint.rotation_min[axis]) / kTestDegree;
}
double high(const ConstraintRecord& constraint, std::size_t axis) {
    return static_cast<double>(constraint.rotation_max[axis]) / kTestDegree;
}
bool is_hinge(const ConstraintRecord& constraint) {
    return constraint.model == static_cast<std::uint8_t>(ConstraintModel::hinge);
}

TEST(AutoRig, ProposesChainsAndLimits) {
    const Rigged rigged = rig(HumanoidGltf());
    EXPECT_EQ(rigged.scene.chains.size(), 6u);
    for (const Chain& chain : rigged.scene.chains) EXPECT_EQ(chain.record.flags, kProposed);
    EXPECT_EQ(rigged.limited(), 20u);  // all but the hips
    EXPECT_EQ(rigged.report.proposals().size(), 26u);
    EXPECT_TRUE(
        rigged.proposes("chain LeftArm: leftUpperArm > leftLowerArm > leftHand, two_bone, elbow points backward"));
    EXPECT_TRUE(rigged.proposes("left elbow, leftLowerArm: hinge about (0.00, -1.00, 0.00), 0 to 150 degrees"));
    EXPECT_TRUE(rigged.proposes("right knee, rightLowerLeg: hinge about (1.00, 0.00, 0.00), 0 to 135 degrees"));
    EXPECT_TRUE(rigged.proposes("spine 2, chest: swing -40 to 13 and -18 to 18 degrees, twist -23 to 23"));
    EXPECT_TRUE(rigged.report.warnings().empty());
}

// The test's joints have axes of no meaning: these look at where limbs go.
TEST(AutoRig, LimbsBendAsAHumansDo) {
    for (const double turn : {0.0, 1.0, 2.5}) {
        HumanoidGltf character;
        const glm::dquat about_y = glm::angleAxis(turn, glm::dvec3(0, 1, 0));
        character.move([&](glm::dvec3 p) { return about_y * p; });
        const Rigged rigged = rig(character);
        for (const std::string side : {"left", "right"}) {
            const double out = side == "left" ? 1.0 : -1.0;
            const auto goes = [&](const std::string& end, const std::string& joint, int axis, double degrees) {
                const auto at = [&](double angle) {
                    return moved(rigged.scene, rigged.joint(side + end), rigged.joint(side + joint), axis,
                                 angle * kTestDegree);
                };
                return glm::conjugate(about_y) * (at(degrees) - at(0));
            };
            const auto& elbow = rigged.constraint(side + "LowerArm");
            const auto& knee = rigged.constraint(side + "LowerLeg");
            ASSERT_TRUE(is_hinge(elbow) && is_hinge(knee));
            EXPECT_LT(glm::distance(goes("Hand", "LowerArm", 0, 90), {-0.25 * out, 0, 0.25}), 1e-5);  // forward
            EXPECT_LT(glm::distance(goes("Foot", "LowerLeg", 0, 90), {0, 0.4, -0.4}), 1e-5);          // backward
            EXPECT_LT(glm::distance(goes("Toes", "Foot", 1, high(rigged.constraint(side + "Foot"), 1)), {0, 0, 0}),
                      0.2);
            EXPECT_LT(goes("Toes", "Foot", 1, high(rigged.constraint(side + "Foot"), 1)).y, -0.05);  // to the ground
            EXPECT_NEAR(high(rigged.constraint(side + "Foot"), 1), 50, 1e-3);

            const auto& hip = rigged.constraint(side + "UpperLeg");
            EXPECT_GT(goes("LowerLeg", "UpperLeg", 1, low(hip, 1)).y, 0.45);  // 120 degrees: the knee above the hip
            EXPECT_GT(goes("LowerLeg", "UpperLeg", 1, low(hip, 1)).z, 0.3);
            EXPECT_NEAR(low(hip, 1), -120, 1e-3);
            const double apart = side == "left" ? high(hip, 2) : low(hip, 2);
            EXPECT_NEAR(std::abs(apart), 45, 1e-3);
            EXPECT_GT(out * goes("LowerLeg", "UpperLeg", 2, apart).x, 0.3);

            const auto& shoulder = rigged.constraint(side + "UpperArm");
            const double raised = side == "left" ? high(shoulder, 2) : low(shoulder, 2);
            EXPECT_NEAR(std::abs(raised), 90, 1e-3);
            EXPECT_NEAR(goes("LowerArm", "UpperArm", 2, raised).y, 0.3, 1e-5);
            EXPECT_GT(goes("LowerArm", "UpperArm", 1, low(shoulder, 1)).z, 0.2);  // 135 degrees forward
            EXPECT_NEAR(low(shoulder, 1), -135, 1e-3);
            // The palm faces down: the hand bends further to it than away.
            const auto& wrist = rigged.constraint(side + "Hand");
            const double to_palm = side == "left" ? low(wrist, 2) : high(wrist, 2);
            EXPECT_NEAR(std::abs(to_palm), 80, 1e-3);
            EXPECT_NEAR(low(wrist, 1), -20, 1e-3);
        }
    }
}

TEST(AutoRig, TheTrunkBendsForwardFurtherThanBack) {
    const Rigged rigged = rig(HumanoidGltf());
    const ConstraintRecord& spine = rigged.constraint("spine");
    EXPECT_NEAR(low(spine, 1), -40, 1e-3);  // two joints share 80
    const glm::dvec3 bent =
        moved(rigged.scene, rigged.joint("neck"), rigged.joint("spine"), 1, low(spine, 1) * kTestDegree);
    EXPECT_GT(bent.z, 0.2);
    EXPECT_NEAR(high(rigged.constraint("neck"), 0), 30, 1e-3);  // and two share 60
}

TEST(AutoRig, ABentElbowIsBentAlready) {
    HumanoidGltf character;
    character["leftHand"].position =
        character["leftLowerArm"].position + 0.25 * glm::dvec3(std::cos(1.0), 0, std::sin(1.0));
    character["rightHand"].position += glm::dvec3(0, 0, -0.02);  // 5 degrees the wrong way
    const Rigged rigged = rig(character);
    EXPECT_NEAR(low(rigged.constraint("leftLowerArm"), 0), -1.0 / kTestDegree, 1e-3);
    EXPECT_NEAR(high(rigged.constraint("leftLowerArm"), 0), 150 - 1.0 / kTestDegree, 1e-3);
    EXPECT_EQ(low(rigged.constraint("rightLowerArm"), 0), 0);
    EXPECT_GT(high(rigged.constraint("rightLowerArm"), 0), 150);
    EXPECT_TRUE(rigged.line_of("leftLowerArm").ends_with(", -57 to 93 degrees, straight at -57"));
    EXPECT_TRUE(rigged.line_of("rightLowerArm").ends_with(" degrees, straight at 5"));
}

TEST(AutoRig, TheZeroOfAnAPoseIsMoved) {
    HumanoidGltf character;
    for (const double side : {1.0, -1.0}) {
        const std::string s = side > 0 ? "left" : "right";
        const glm::dvec3 down(side * std::sqrt(0.5), -std::sqrt(0.5), 0);
        character[s + "LowerArm"].position = character[s + "UpperArm"].position + 0.3 * down;
        character[s + "Hand"].position = character[s + "LowerArm"].position + 0.25 * down;
    }
    const Rigged rigged = rig(character);
    EXPECT_NEAR(low(rigged.constraint("leftUpperArm"), 2), -95, 1e-3);
    EXPECT_NEAR(high(rigged.constraint("leftUpperArm"), 2), 135, 1e-3);
    EXPECT_NEAR(high(rigged.constraint("rightUpperArm"), 2), 95, 1e-3);
    const glm::dvec3 hand =
        moved(rigged.scene, rigged.joint("leftHand"), rigged.joint("leftLowerArm"), 0, 90 * kTestDegree);
    EXPECT_NEAR(hand.z, 0.25, 1e-5);
}

TEST(AutoRig, AKneeThatIsNoHumansGetsNoLimit) {
    HumanoidGltf bird;
    bird["leftLowerLeg"].position += glm::dvec3(0, 0, -0.2);
    const Rigged rigged = rig(bird);
    EXPECT_TRUE(rigged.scene.joints[rigged.joint("leftLowerLeg")].constraints.empty());
    EXPECT_EQ(warned(rigged.report, "outside what such a joint can do"), 1u);
    EXPECT_TRUE(is_hinge(rigged.constraint("rightLowerLeg")));
}

TEST(AutoRig, AKneelingHumanGetsNoLimits) {
    HumanoidGltf character;  // bent forward, the hands above the ground
    character["neck"].position = {0, 1.1, 0.45};
    character["head"].position = {0, 1.1, 0.6};
    const Rigged rigged = rig(character);
    EXPECT_NE(find_chain(rigged.scene, "LeftLeg"), nullptr);
    EXPECT_EQ(rigged.limited(), 0u);
    EXPECT_EQ(warned(rigged.report, "none proposed"), 1u);
}

TEST(AutoRig, LeftAndRightInterchangedGetNothing) {
    HumanoidGltf character;
    for (const char* foot : {"leftToes", "rightToes"}) character[foot].position.z *= -1;
    const Rigged rigged = rig(character);
    EXPECT_TRUE(rigged.scene.chains.empty());
    EXPECT_EQ(rigged.limited(), 0u);
    EXPECT_EQ(warned(rigged.report, "backward"), 1u);
}

/// The same skeleton, its joints called `bone_0` and on.
HumanoidGltf without_names(HumanoidGltf character) {
    for (std::size_t i = 0; i < character.bones.size(); ++i)
        character.names[character.bones[i].name] = "bone_" + std::to_string(i);
    return character;
}

TEST(AutoRig, TheShapeSaysWhatNamesDoNot) {
    for (const double turn : {0.0, 1.0, 2.5}) {  // the toes say which way is forward
        HumanoidGltf character;
        const glm::dquat about_y = glm::angleAxis(turn, glm::dvec3(0, 1, 0));
        character.move([&](glm::dvec3 p) { return about_y * p; });
        const Rigged named = rig(character);
        const Rigged rigged = rig(without_names(character));
        EXPECT_EQ(rigged.limited(), 20u);
        ASSERT_EQ(rigged.scene.chains.size(), 6u);
        for (const Chain& chain : named.scene.chains) {
            const Chain* found = find_chain(rigged.scene, chain.name);
            ASSERT_NE(found, nullptr) << chain.name;
            EXPECT_EQ(found->record.start, chain.record.start) << chain.name;
            EXPECT_EQ(found->record.effector, chain.record.effector) << chain.name;
        }
    }
}

TEST(AutoRig, PairsOfNamesTellTheSides) {
    HumanoidGltf character = without_names(HumanoidGltf());
    for (const char* foot : {"leftToes", "rightToes"})  // which now say nothing
        character[foot].position = character[foot == std::string("leftToes") ? "leftFoot" : "rightFoot"].position;
    character.names["leftUpperLeg"] = "rhip";
    character.names["rightUpperLeg"] = "lhip";
    const Rigged rigged = rig(character);
    const Chain* leg = find_chain(rigged.scene, "LeftLeg");
    ASSERT_NE(leg, nullptr);
    EXPECT_EQ(rigged.scene.joints[leg->record.start].name, "lhip");
    const Chain* arm = find_chain(rigged.scene, "LeftArm");
    ASSERT_NE(arm, nullptr);
    EXPECT_EQ(rigged.scene.joints[arm->record.start].name, character.names["rightUpperArm"]);
}

TEST(AutoRig, OtherShapesAreNoHumans) {
    HumanoidGltf lame = without_names(HumanoidGltf());  // one arm is half as long: nothing mirrors it
    lame["leftLowerArm"].position.x = 0.3;
    lame["leftHand"].position.x = 0.4;
    EXPECT_TRUE(rig(lame).report.proposals().empty());

    HumanoidGltf lying = without_names(HumanoidGltf());
    lying.move([](glm::dvec3 p) { return glm::dvec3(p.x, -p.z, p.y); });
    EXPECT_TRUE(rig(lying).report.proposals().empty());
}

TEST(AutoRig, AVrmHumanoidNeedsNoNames) {
    HumanoidGltf character;
    Gltf gltf = character.build_vrm();
    for (std::size_t i = 0; i < gltf.json["nodes"].size(); ++i) gltf.json["nodes"][i]["name"] = "n" + std::to_string(i);
    const Rigged rigged = rig(gltf);
    EXPECT_EQ(rigged.scene.chains.size(), 6u);
    EXPECT_EQ(rigged.limited(), 20u);
}

TEST(AutoRig, LeavesWhatIsThere) {
    Scene scene = *HumanoidGltf().build().import();
    ConstraintRecord locked;
    locked.model = static_cast<std::uint8_t>(ConstraintModel::locked);
    locked.flags = kProposed;
    scene.joints[joint_named(scene, "leftLowerArm")].constraints = {locked};
    Chain mine;
    mine.name = "LeftArm";
    scene.chains.push_back(mine);
    const Rigged rigged = rig(scene);
    EXPECT_EQ(rigged.constraint("leftLowerArm").model, locked.model);
    EXPECT_EQ(rigged.scene.chains[0].record.effector, 0u);
    EXPECT_EQ(rigged.scene.chains.size(), 6u);
    EXPECT_EQ(rigged.report.proposals().size(), 24u);
}

TEST(AutoRig, ClaimedJointsStayFree) {
    const Scene scene = *HumanoidGltf().build().import();
    std::vector<bool> claimed(scene.joints.size());
    claimed[joint_named(scene, "leftLowerArm")] = true;
    const Rigged rigged = rig(scene, claimed);
    EXPECT_EQ(rigged.limited(), 19u);
    EXPECT_TRUE(rigged.scene.joints[rigged.joint("leftLowerArm")].constraints.empty());
}

TEST(AutoRig, AFootThatAnIkRigMovesIsTheTarget) {
    HumanoidGltf character;
    character["leftFoot"].parent = "";
    const Rigged rigged = rig(character);
    const Chain* leg = find_chain(rigged.scene, "LeftLeg");
    ASSERT_NE(leg, nullptr);
    EXPECT_EQ(leg->record.effector, rigged.joint("leftLowerLeg"));
    EXPECT_EQ(leg->record.target, rigged.joint("leftFoot"));
    EXPECT_NEAR(std::hypot(leg->record.tip_offset[0], leg->record.tip_offset[1], leg->record.tip_offset[2]), 0.4, 1e-5);
    EXPECT_TRUE(is_hinge(rigged.constraint("leftLowerLeg")));
}

glm::dquat to_quaternion(const auto& q) {
    return glm::normalize(glm::dquat(q[3], q[0], q[1], q[2]));
}

/// A clip that turns a joint away from its rest pose, key by key.
void add_clip(Scene& scene, const std::string& name, const std::vector<glm::dquat>& away) {
    const std::uint32_t joint = joint_named(scene, name);
    Track track;
    track.path = TrackPath::rotation;
    track.target = joint;
    track.components = 4;
    for (const glm::dquat& turn : away) {
        const glm::dquat q = to_quaternion(scene.joints[joint].rest.rotation) * turn;
        track.times.push_back(0.1f * static_cast<float>(track.times.size()));
        for (const double number : {q.x, q.y, q.z, q.w}) track.values.push_back(static_cast<float>(number));
    }
    scene.clips.push_back({"clip " + std::to_string(scene.clips.size()), false, {track}, {}});
}

/// Turns by these angles about an axis of model space, as the joint rests, from `low` to `high` degrees.
std::vector<glm::dquat> turns_about(const Scene& scene, const std::string& name, glm::dvec3 axis, double low,
                                    double high) {
    glm::dquat rest(1, 0, 0, 0);
    for (std::uint32_t joint = joint_named(scene, name); joint != kNone; joint = scene.joints[joint].parent)
        rest = to_quaternion(scene.joints[joint].rest.rotation) * rest;
    std::vector<glm::dquat> turns;
    for (int key = 0; key <= 8; ++key) {
        const double angle = (low + (high - low) * key / 8) * kTestDegree;
        turns.push_back(glm::angleAxis(angle, glm::conjugate(rest) * glm::normalize(axis)));
    }
    return turns;
}

/// One key that turns a joint about an axis of its limit's frame.
Scene with_clip(const std::string& name, int axis, double degrees) {
    const Rigged rigged = rig(HumanoidGltf());
    Scene scene = *HumanoidGltf().build().import();
    const glm::dquat frame = to_quaternion(rigged.constraint(name).frame);
    glm::dvec3 about(0);
    about[axis] = 1;
    add_clip(scene, name, {frame * glm::angleAxis(degrees * kTestDegree, about) * glm::conjugate(frame)});
    return scene;
}

/// Degrees by which the clips leave the limit of a joint, at most.
double outside_in_clips(const Rigged& rigged, const std::string& name) {
    double most = 0.0;
    const std::uint32_t joint = rigged.joint(name);
    ConstraintView view;
    view.record = rigged.constraint(name);
    const Constraint constraint = make_constraint(view);
    for (const Clip& clip : rigged.scene.clips) {
        for (const Track& track : clip.tracks) {
            if (track.target != joint) continue;
            for (std::size_t at = 0; at < track.values.size(); at += 4) {
                const glm::quat q(track.values[at + 3], track.values[at], track.values[at + 1], track.values[at + 2]);
                const glm::vec4& r = rigged.scene.joints[joint].rest.rotation;
                const glm::quat at_rest(r.w, r.x, r.y, r.z);
                const double outside = violation(constraint, to_constraint_space(constraint, at_rest, q));
                most = std::max(most, outside / kTestDegree);
            }
        }
    }
    return most;
}

void expect_inside(const Rigged& rigged, const std::string& name) {
    EXPECT_LT(outside_in_clips(rigged, name), 1.0) << name;
}

TEST(AutoRig, LimitsHoldTheCharactersOwnClips) {
    const Rigged inside = rig(with_clip("leftLowerArm", 0, 140));
    EXPECT_NEAR(low(inside.constraint("leftLowerArm"), 0), 0, 1e-3);
    EXPECT_NEAR(high(inside.constraint("leftLowerArm"), 0), 150, 1e-3);
    const Rigged near = rig(with_clip("leftLowerArm", 0, -20.5));
    EXPECT_NEAR(low(near.constraint("leftLowerArm"), 0), -21, 1e-3);
    EXPECT_TRUE(
        near.proposes("left elbow, leftLowerArm: hinge about (0.00, -1.00, 0.00), -21 to 150 degrees, axis fitted "
                      "to 1 clip, 0.0 degrees off a human's, up to 21 degrees wider than a human's for 1 clip"));
    EXPECT_NEAR(low(near.constraint("rightLowerArm"), 0), -21, 1e-3);  // both sides alike
    const Rigged swung = rig(with_clip("leftUpperLeg", 1, 45));
    EXPECT_NEAR(high(swung.constraint("leftUpperLeg"), 1), 45, 1.01);
    EXPECT_NEAR(high(swung.constraint("rightUpperLeg"), 1), 45, 1.01);
}

TEST(AutoRig, LimitsAreWidenedByThirtyDegreesAndWhatGoesFurtherIsSaid) {
    const Rigged looks_back = rig(with_clip("head", 0, 110));
    EXPECT_NEAR(high(looks_back.constraint("head"), 0), 90, 1e-3);
    ASSERT_EQ(warned(looks_back.report, "turns the joint by 20 degrees more than such a joint can turn"), 1u);
    std::size_t kept = 0, dropped = 0;
    for (const double degrees : {-170.0, -100.0, -40.0, 40.0, 100.0, 170.0}) {
        for (const char* name : {"leftUpperArm", "rightUpperLeg", "spine", "neck", "leftHand"}) {
            for (const int axis : {0, 1, 2}) {
                const Rigged far = rig(with_clip(name, axis, degrees));
                const std::uint64_t none = warned(far.report, "no limit proposed");
                EXPECT_EQ(far.limited(), 20u - none) << name << ' ' << axis << ' ' << degrees;
                if (none > 0) {
                    EXPECT_TRUE(far.scene.joints[far.joint(name)].constraints.empty());
                    EXPECT_GT(warned(far.report, far.scene.clips[0].name), 0u) << "the clip is named";
                    ++dropped;
                    continue;
                }
                const bool is_said = warned(far.report, "leaves its proposed limit") > 0;
                const double outside = outside_in_clips(far, name);
                EXPECT_EQ(outside > 1.0, is_said) << name << ' ' << axis << ' ' << degrees;
                EXPECT_LE(outside, 31.0) << name << ' ' << axis << ' ' << degrees;
                ++kept;
            }
        }
    }
    EXPECT_GT(kept, 20u);
    EXPECT_GT(dropped, 20u);
}

TEST(AutoRig, AKneesAxisIsThatOfItsClips) {
    Scene scene = *HumanoidGltf().build().import();
    const double off = 15.6 * kTestDegree;
    const glm::dvec3 axis(std::cos(off), 0.0, std::sin(off));
    add_clip(scene, "leftLowerLeg", turns_about(scene, "leftLowerLeg", axis, -4, 120));
    add_clip(scene, "leftLowerLeg", turns_about(scene, "leftLowerLeg", axis, 0, 30));
    const Rigged rigged = rig(scene);
    EXPECT_EQ(rigged.limited(), 20u);
    EXPECT_TRUE(is_hinge(rigged.constraint("leftLowerLeg")));
    EXPECT_TRUE(is_hinge(rigged.constraint("rightLowerLeg")));
    expect_inside(rigged, "leftLowerLeg");
    EXPECT_TRUE(
        rigged.proposes("left knee, leftLowerLeg: hinge about (0.96, 0.00, 0.27), -5 to 135 degrees, axis fitted to "
                        "2 clips, 15.6 degrees off a human's, up to 5 degrees wider than a human's for 2 clips"));
    // The other side's is its mirror image.
    EXPECT_TRUE(
        rigged.proposes("right knee, rightLowerLeg: hinge about (0.96, 0.00, -0.27), -5 to 135 degrees, axis fitted "
                        "to 2 clips, 15.6 degrees off a human's, up to 5 degrees wider than a human's for 2 clips"));
}

TEST(AutoRig, EachSideMayHaveItsOwnAxis) {
    Scene scene = *HumanoidGltf().build().import();
    const double off = 8 * kTestDegree;
    const glm::dvec3 axis(std::cos(off), 0.0, std::sin(off));
    for (const char* knee : {"leftLowerLeg", "rightLowerLeg"})  // the same, where mirror images would differ
        add_clip(scene, knee, turns_about(scene, knee, axis, 0, knee[0] == 'l' ? 120 : 140));
    const Rigged rigged = rig(scene);
    for (const char* knee : {"leftLowerLeg", "rightLowerLeg"}) {
        EXPECT_TRUE(is_hinge(rigged.constraint(knee)));
        EXPECT_NEAR(high(rigged.constraint(knee), 0), 141, 1e-3);
        expect_inside(rigged, knee);
    }
}

TEST(AutoRig, ElbowsBendAsTheClipsBendThem) {
    Scene scene = *HumanoidGltf().build().import();
    // A human's left elbow bends about -Y in a T-pose, its right one about Y.
    add_clip(scene, "leftLowerArm", turns_about(scene, "leftLowerArm", {0, 1, 0}, 0, 100));
    add_clip(scene, "rightLowerArm", turns_about(scene, "rightLowerArm", {0, -1, 0}, 0, 60));
    const Rigged rigged = rig(scene);
    for (const std::string side : {"left", "right"}) {
        EXPECT_TRUE(is_hinge(rigged.constraint(side + "LowerArm")));
        expect_inside(rigged, side + "LowerArm");
        const glm::dvec3 hand =
            moved(rigged.scene, rigged.joint(side + "Hand"), rigged.joint(side + "LowerArm"), 0, 90 * kTestDegree);
        EXPECT_NEAR(hand.z, -0.25, 1e-5);
        EXPECT_NEAR(high(rigged.constraint(side + "LowerArm"), 0), 150, 1e-3);
    }
    // The elbow, then, points forward.
    const Chain* arm = find_chain(rigged.scene, "LeftArm");
    ASSERT_NE(arm, nullptr);
    EXPECT_TRUE(rigged.proposes(
        "chain LeftArm: leftUpperArm > leftLowerArm > leftHand, two_bone, elbow points forward as in 1 clip"));
}

TEST(AutoRig, AnElbowThatTwistsIsNoHinge) {
    const Rigged rigged = rig(with_clip("leftLowerArm", 2, 60));  // about the bone
    const ConstraintRecord& constraint = rigged.constraint("leftLowerArm");
    EXPECT_EQ(constraint.model, static_cast<std::uint8_t>(ConstraintModel::swing_twist_pyramid));
    EXPECT_NEAR(high(constraint, 0), 80, 1e-3);
    EXPECT_NEAR(high(constraint, 2), 150, 1e-3);
    const glm::dvec3 bent =
        moved(rigged.scene, rigged.joint("leftHand"), rigged.joint("leftLowerArm"), 2, 90 * kTestDegree);
    EXPECT_NEAR(bent.z, 0.25, 1e-5);
    EXPECT_EQ(rigged.constraint("rightLowerArm").model, constraint.model);
}

TEST(AutoRig, AnArmMayEndWithItsMesh) {
    HumanoidGltf character;
    std::erase_if(character.bones, [](const HumanoidGltf::Bone& bone) { return bone.name.ends_with("Hand"); });
    Scene scene = *character.build().import();
    for (const std::string side : {"left", "right"}) {
        Mesh mesh;
        mesh.joint = joint_named(scene, side + "LowerArm");
        const RestFrames rest(scene);
        const double out = side == "left" ? 1.0 : -1.0;
        for (const glm::dvec3 at : {glm::dvec3(0.5, 1.40, 0), glm::dvec3(0.5, 1.50, 0), glm::dvec3(0.9, 1.45, 0)})
            mesh.positions.emplace_back(*rest.point_in_space_of(mesh.joint, {out * at.x, at.y, at.z}));
        mesh.submeshes.push_back({Topology::triangles, kNone, {0, 1, 2}});
        scene.meshes.push_back(std::move(mesh));
    }
    const Rigged rigged = rig(std::move(scene));
    const Chain* arm = find_chain(rigged.scene, "LeftArm");
    ASSERT_NE(arm, nullptr);
    EXPECT_EQ(arm->record.effector, rigged.joint("leftLowerArm"));
    EXPECT_EQ(arm->record.target, kNone);
    const auto& tip = arm->record.tip_offset;
    EXPECT_NEAR(std::sqrt(tip[0] * tip[0] + tip[1] * tip[1] + tip[2] * tip[2]), 0.4f, 1e-5f);
    EXPECT_TRUE(is_hinge(rigged.constraint("leftLowerArm")));
}

TEST(AutoRig, ArmsThatEndInFingersEndInTheSameOne) {
    HumanoidGltf human;
    std::erase_if(human.bones, [](const HumanoidGltf::Bone& bone) { return bone.name.ends_with("Hand"); });
    for (const double side : {1.0, -1.0}) {
        const std::string s = side > 0 ? "left" : "right";
        for (const auto& [finger, off] : {std::pair("Thumb1", 1e-4), {"Middle1", 0.0}, {"Index1", 2e-4}}) {
            // Rounding makes another one the farthest on each side.
            human.add(s + finger, s + "LowerArm", {side * 0.75 + off, 1.45, 0});
        }
    }
    const Scene scene = *human.build().import();
    const Rigged rigged = rig(scene);
    const auto end_of = [&](const char* chain) {
        return rigged.scene.joints[find_chain(rigged.scene, chain)->record.effector].name;
    };
    EXPECT_EQ(end_of("LeftArm"), "leftMiddle1");
    EXPECT_EQ(end_of("RightArm"), "rightMiddle1");
}

TEST(AutoRig, ABodyThatIsFoundAsItIsBoundGetsChainsAndNoLimits) {
    Scene scene = *HumanoidGltf().build().import();
    bind_at_rest(scene);
    for (Joint& joint : scene.joints) {  // all bones along one axis
        joint.rest.translation = {glm::length(joint.rest.translation), 0.0f, 0.0f};
        joint.rest.rotation = {0.0f, 0.0f, 0.0f, 1.0f};
    }
    const Rigged rigged = rig(scene);
    for (const char* name : {"LeftArm", "RightArm", "LeftLeg", "RightLeg", "Spine", "Head"})
        EXPECT_NE(find_chain(rigged.scene, name), nullptr) << name;
    EXPECT_EQ(rigged.limited(), 0u);
    EXPECT_EQ(warned(rigged.report, "which is not that of a body here"), 1u);
}

TEST(AutoRig, AControlWithABonesNameIsNotTheBone) {
    HumanoidGltf character;
    character.add("HEAD", "", {0, 2, 0});  // nearer the root than the head, and moves nothing
    Scene scene = *character.build().import();
    for (const char* end : {"head", "leftHand", "rightHand", "leftToes", "rightToes"}) {
        Mesh mesh;
        mesh.joint = joint_named(scene, end);
        mesh.positions.assign({{0, 0, 0}, {0.01f, 0, 0}, {0, 0.01f, 0}});
        mesh.submeshes.push_back({Topology::triangles, kNone, {0, 1, 2}});
        scene.meshes.push_back(std::move(mesh));
    }
    const Rigged rigged = rig(std::move(scene));
    EXPECT_EQ(rigged.scene.chains.size(), 6u);
    EXPECT_EQ(rigged.limited(), 20u);
    EXPECT_TRUE(rigged.scene.joints[rigged.joint("HEAD")].constraints.empty());
}

TEST(AutoRig, WhatHangsOnAControlBesideTheBodyGetsNoLimit) {
    HumanoidGltf character;
    character.add("root", "", {0, 0, 0});
    character["hips"].parent = "root";
    for (const char* leg : {"leftUpperLeg", "rightUpperLeg"}) character[leg].parent = "root";
    const Rigged rigged = rig(character);
    EXPECT_EQ(rigged.scene.chains.size(), 6u);
    EXPECT_EQ(rigged.limited(), 18u);
    EXPECT_TRUE(rigged.scene.joints[rigged.joint("leftUpperLeg")].constraints.empty());
    EXPECT_FALSE(rigged.scene.joints[rigged.joint("leftLowerLeg")].constraints.empty());
    ASSERT_EQ(rigged.report.warnings().size(), 1u);
    EXPECT_EQ(rigged.report.warnings().front().message,
              "auto-rig: no limit proposed, since the joint hangs beside hips, not below it");
    EXPECT_EQ(rigged.report.warnings().front().count, 2u);
}

TEST(AutoRig, StrangeScalesCrashNothing) {
    for (const double scale : {0.0, -1.0, 1e30, 1e-30}) {
        Gltf gltf = HumanoidGltf().build();
        for (Json& node : gltf.json["nodes"]) node["scale"] = {scale, 1, scale};
        (void)rig(gltf);
    }
}

struct Style {
    const char* name;
    std::map<std::string, std::string> names;
};

std::map<std::string, std::string> both_sides(std::map<std::string, std::string> names,
                                              const std::map<std::string, std::string>& limbs, const char* left,
                                              const char* right) {
    for (const auto& [bone, name] : limbs) {
        for (const bool is_left : {true, false}) {
            std::string text = name;
            const std::size_t mark = text.find('@');
            text.replace(mark, 1, is_left ? left : right);
            names[(is_left ? "left" : "right") + bone] = text;
        }
    }
    return names;
}

TEST(AutoRig, KnowsTheNamesOfManyTools) {
    const std::array styles{
        Style{"Mixamo", both_sides({{"hips", "mixamorig:Hips"},
                                    {"spine", "mixamorig:Spine"},
                                    {"chest", "mixamorig:Spine1"},
                                    {"neck", "mixamorig:Neck"},
                                    {"head", "mixamorig:Head"}},
                                   {{"Shoulder", "mixamorig:@Shoulder"},
                                    {"UpperArm", "mixamorig:@Arm"},
                                    {"LowerArm", "mixamorig:@ForeArm"},
                                    {"Hand", "mixamorig:@Hand"},
                                    {"UpperLeg", "mixamorig:@UpLeg"},
                                    {"LowerLeg", "mixamorig:@Leg"},
                                    {"Foot", "mixamorig:@Foot"},
                                    {"Toes", "mixamorig:@ToeBase"}},
                                   "Left", "Right")},
        Style{"Unreal", both_sides({{"hips", "pelvis"},
                                    {"spine", "spine_01"},
                                    {"chest", "spine_02"},
                                    {"neck", "neck_01"},
                                    {"head", "head"}},
                                   {{"Shoulder", "clavicle_@"},
                                    {"UpperArm", "upperarm_@"},
                                    {"LowerArm", "lowerarm_@"},
                                    {"Hand", "hand_@"},
                                    {"UpperLeg", "thigh_@"},
                                    {"LowerLeg", "calf_@"},
                                    {"Foot", "foot_@"},
                                    {"Toes", "ball_@"}},
                                   "l", "r")},
        Style{"Rigify", both_sides({{"hips", "DEF-spine"},
                                    {"spine", "DEF-spine.001"},
                                    {"chest", "DEF-spine.003"},
                                    {"neck", "DEF-spine.004"},
                                    {"head", "DEF-spine.006"}},
                                   {{"Shoulder", "DEF-shoulder.@"},
                                    {"UpperArm", "DEF-upper_arm.@"},
                                    {"LowerArm", "DEF-forearm.@"},
                                    {"Hand", "DEF-hand.@"},
                                    {"UpperLeg", "DEF-thigh.@"},
                                    {"LowerLeg", "DEF-shin.@"},
                                    {"Foot", "DEF-foot.@"},
                                    {"Toes", "DEF-toe.@"}},
                                   "L", "R")},
        Style{"Biped", both_sides({{"hips", "Bip01 Pelvis"},
                                   {"spine", "Bip01 Spine"},
                                   {"chest", "Bip01 Spine1"},
                                   {"neck", "Bip01 Neck"},
                                   {"head", "Bip01 Head"}},
                                  {{"Shoulder", "Bip01 @ Clavicle"},
                                   {"UpperArm", "Bip01 @ UpperArm"},
                                   {"LowerArm", "Bip01 @ Forearm"},
                                   {"Hand", "Bip01 @ Hand"},
                                   {"UpperLeg", "Bip01 @ Thigh"},
                                   {"LowerLeg", "Bip01 @ Calf"},
                                   {"Foot", "Bip01 @ Foot"},
                                   {"Toes", "Bip01 @ Toe0"}},
                                  "L", "R")},
        Style{"VRoid", both_sides({{"hips", "J_Bip_C_Hips"},
                                   {"spine", "J_Bip_C_Spine"},
                                   {"chest", "J_Bip_C_Chest"},
                                   {"neck", "J_Bip_C_Neck"},
                                   {"head", "J_Bip_C_Head"}},
                                  {{"Shoulder", "J_Bip_@_Shoulder"},
                                   {"UpperArm", "J_Bip_@_UpperArm"},
                                   {"LowerArm", "J_Bip_@_LowerArm"},
                                   {"Hand", "J_Bip_@_Hand"},
                                   {"UpperLeg", "J_Bip_@_UpperLeg"},
                                   {"LowerLeg", "J_Bip_@_LowerLeg"},
                                   {"Foot", "J_Bip_@_Foot"},
                                   {"Toes", "J_Bip_@_ToeBase"}},
                                  "L", "R")},
        Style{"plain",
              both_sides({{"hips", "Hips"}, {"spine", "Spine"}, {"chest", "Chest"}, {"neck", "Neck"}, {"head", "Head"}},
                         {{"Shoulder", "@ shoulder"},
                          {"UpperArm", "@ arm"},
                          {"LowerArm", "@ elbow"},
                          {"Hand", "@ wrist"},
                          {"UpperLeg", "@ leg"},
                          {"LowerLeg", "@ knee"},
                          {"Foot", "@ ankle"},
                          {"Toes", "@ toe"}},
                         "Left", "Right")},
    };
    for (const Style& style : styles) {
        SCOPED_TRACE(style.name);
        HumanoidGltf character;
        character.names = style.names;
        const Rigged rigged = rig(character);
        EXPECT_EQ(rigged.scene.chains.size(), 6u);
        EXPECT_EQ(rigged.limited(), 20u);
        const Chain* arm = find_chain(rigged.scene, "LeftArm");
        ASSERT_NE(arm, nullptr);
        EXPECT_EQ(rigged.scene.joints[arm->record.start].name, style.names.at("leftUpperArm"));
        EXPECT_EQ(rigged.scene.joints[arm->record.effector].name, style.names.at("leftHand"));
    }
}

TEST(AutoRig, TheExampleWalksInsideItsLimits) {
    Report report;
    auto scene = import_gltf(source_folder() / "examples" / "mannequin.glb", {}, report);
    ASSERT_TRUE(scene.has_value());
    const Rigged rigged = rig(*std::move(scene));
    EXPECT_EQ(rigged.scene.chains.size(), 6u);
    EXPECT_EQ(rigged.limited(), 21u);
    for (const Joint& joint : rigged.scene.joints) {
        if (!joint.constraints.empty()) expect_inside(rigged, joint.name);
    }
}

}  // namespace
}  // namespace bendy::converter::auto_rig_test
