#include <bendy/motion/retarget_clips.h>
#include <bendy/runtime/constrain.h>
#include <bendy/runtime/curve.h>
#include <bendy/runtime/sample.h>

#include "runtime/animal_model.h"
#include "runtime/clip_model.h"
#include "runtime/human_model.h"
#include "source_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace bendy::motion::retarget_clips_test {
namespace {

using test::AnimalModel;
using test::AnimalSpec;
using test::BodyModel;
using test::Buffer;
using test::ClipSpec;
using test::HumanModel;
using test::HumanSpec;

constexpr RetargetOptions kDirections{RestPoses::measured, Limits::off, false};

/// A clip of a second in which every joint with a role swings about its own axes.
ClipSpec swinging(const BodyModel& body, const std::string& name, double size = 0.5) {
    ClipSpec clip{name};
    std::mt19937 random(7);
    std::normal_distribution<double> number;
    for (std::uint32_t joint = 1; joint < body.spec.joints.size(); ++joint) {
        const auto& rest = body.spec.joints[joint].rest.rotation;
        test::TrackSpec track{TrackPath::rotation, joint, 4, {0.0f, 0.4f, 1.0f}, {}};
        for (int key = 0; key < 3; ++key) {
            const glm::dquat swing(1.0, size * number(random), size * number(random), size * number(random));
            const glm::quat turned(glm::normalize(glm::dquat(rest[3], rest[0], rest[1], rest[2]) * swing));
            for (const float part : {turned.x, turned.y, turned.z, turned.w}) track.values.push_back(part);
        }
        clip.tracks.push_back(track);
    }
    return clip;
}

/// Returns a file whose counts are right: the command reads nothing else.
Buffer counted(const test::ModelSpec& spec) {
    test::Node root = test::to_node(test::build_file(spec));
    std::uint32_t clips = 0;
    for (const test::Node& chunk : spec.more) clips += chunk.id == FourCC("CYCL") ? 1 : 0;
    test::edit<VersionRecord>(test::at(root, "HEAD/VERS"), [&](VersionRecord& version) { version.clips = clips; });
    return test::to_file(root);
}

Buffer file_of(const BodyModel& body, const std::vector<ClipSpec>& clips) {
    test::ModelSpec spec = body.spec;
    for (const ClipSpec& clip : clips) spec.more.push_back(test::clip_node(clip));
    return counted(spec);
}

/// A human that swings.
Buffer swinger(const HumanSpec& build = {}) {
    const HumanModel human(build);
    return file_of(human, {swinging(human, "Swing")});
}

Buffer retargeted(const Buffer& target, const Buffer& source, const RetargetClips& options, edit::Log& log) {
    auto edited = retarget_clips(target, source, options, log);
    EXPECT_TRUE(edited) << edited.error().message;
    return edited ? *std::move(edited) : Buffer();
}

std::string problem_of(const Buffer& target, const Buffer& source, const RetargetClips& options = {}) {
    edit::Log log;
    const auto edited = retarget_clips(target, source, options, log);
    return edited ? "" : edited.error().message;
}

/// Returns the bytes of the leaves that hold a clip's tracks.
std::vector<Buffer> track_bytes(const Buffer& file, std::size_t clip) {
    test::Node root = test::to_node(file);
    std::vector<Buffer> bytes;
    for (const char* leaf : {"TRAK", "TIME", "KEYV"})
        bytes.push_back(test::at(root, "HEAD/OBJE/CYCL[" + std::to_string(clip) + "]/" + leaf).payload);
    return bytes;
}

TEST(RetargetClips, ACharacterItselfKeepsItsTracksByteForByte) {
    const Buffer file = swinger({.axes = 3});
    edit::Log log;
    const Buffer made = retargeted(file, file, {"Swing", {}, edit::SameName::number}, log);
    const test::Owned model(made);
    ASSERT_EQ(model->clips().size(), 2u);
    EXPECT_EQ(model->clips()[1].name, "Swing.001");
    EXPECT_EQ(track_bytes(made, 0), track_bytes(made, 1));
    EXPECT_TRUE(log.warnings.empty());
}

/// The clip "Swing" of `source` puts `body` where Retarget puts it.
void expect_tracks_as_retargeted(const BodyModel& body, const Buffer& source) {
    edit::Log log;
    const test::Owned made(retargeted(counted(body.spec), source, {"", kDirections}, log));
    const test::Owned there(source);
    auto retarget = Retarget::make(*there, *made, kDirections);
    ASSERT_TRUE(retarget);
    Pose from(*there), wanted(*made), played(*made);
    RetargetState state;
    for (int k = 0; k <= 1000; ++k) {
        const float seconds = static_cast<float>(k) / 1000.0f;
        ASSERT_TRUE(sample(from, there->clip("Swing"), seconds));
        ASSERT_TRUE(bendy::retarget(wanted, *retarget, from, state));
        ASSERT_TRUE(sample(played, made->clip("Swing"), seconds));
        for (std::size_t joint = 0; joint < made->joints().size(); ++joint) {
            const glm::vec3 off(played.model_space()[joint][3] - wanted.model_space()[joint][3]);
            EXPECT_LT(glm::length(off), 1e-3f) << made->joints()[joint].name << " at " << seconds;
        }
    }
}

TEST(RetargetClips, TracksSayWhatRetargetSays) {
    const Buffer source = swinger();
    for (const HumanSpec& build :
         {HumanSpec{.arms_down = 60, .thigh = 0.3, .axes = 4}, HumanSpec{.facing = 90, .spine = 2, .axes = 5},
          HumanSpec{.is_z_up = true, .spine = 1, .is_detached = true, .axes = 6}}) {
        expect_tracks_as_retargeted(HumanModel(build), source);
    }
}

TEST(RetargetClips, KeysThatLieBetweenTheOthersAreLeftOut) {
    edit::Log log;
    const HumanModel build(HumanSpec{.thigh = 0.3, .axes = 4});
    const test::Owned made(retargeted(counted(build.spec), swinger(), {"", kDirections}, log));
    const Clip& clip = *made->clip("Swing");
    const auto elbow = std::find_if(clip.tracks.begin(), clip.tracks.end(), [&](const TrackView& track) {
        return track.target == build.joint("leftForeArm") && track.path == TrackPath::rotation;
    });
    ASSERT_NE(elbow, clip.tracks.end());
    EXPECT_LE(elbow->keys, 5u);  // of 3 in the source, and one in each 64 samples
    EXPECT_GE(elbow->keys, 3u);
}

TEST(RetargetClips, StaysInsideLimitsAndSaysWhatGaveWay) {
    ConstraintRecord bend;
    bend.model = static_cast<std::uint8_t>(ConstraintModel::largest_angle);
    bend.rotation_max = {0.3f, 0.0f, 0.0f};
    const HumanModel build(HumanSpec{.axes = 3, .elbows = {bend}});
    edit::Log log;
    const test::Owned made(retargeted(counted(build.spec), swinger(), {}, log));
    ASSERT_EQ(log.done.size(), 2u);
    const std::size_t frames = log.done[1].find("limits acted in ") + std::strlen("limits acted in ");
    const std::string count = log.done[1].substr(frames, log.done[1].find(" of ", frames) - frames);
    EXPECT_GE(std::stoi(count), 121);  // more where the motion is uneven
    EXPECT_NE(log.done[1].find("limits acted in " + count + " of " + count + " frames"), std::string::npos)
        << log.done[1];
    EXPECT_NE(log.done[1].find("ForeArm\" (largest angle, "), std::string::npos) << log.done[1];
    Pose pose(*made);
    for (int k = 0; k <= 10000; ++k) {
        ASSERT_TRUE(sample(pose, made->clip("Swing"), static_cast<float>(k) / 10000.0f));
        for (const Constraint& limit : made->constraints()) {
            const glm::quat rest = made->joints()[limit.joint].rest.rotation;
            EXPECT_LT(violation(limit, to_constraint_space(limit, rest, pose.local(limit.joint).rotation)), 1e-4);
        }
    }
}

TEST(RetargetClips, AQuickJointIsOutsideItsLimitsInNoFrame) {
    ConstraintRecord half;
    half.model = static_cast<std::uint8_t>(ConstraintModel::swing_twist_pyramid);
    half.rotation_min = {-1.7f, -0.3f, -0.3f};
    half.rotation_max = {1.7f, 0.3f, 0.3f};
    const HumanModel source(HumanSpec{}), build(HumanSpec{.axes = 3, .elbows = {half}});
    edit::Log log;
    const test::Owned made(retargeted(counted(build.spec), file_of(source, {swinging(source, "Swing", 3.0)}), {}, log));
    Pose pose(*made);
    double worst = 0.0;
    for (int k = 0; k <= 30000; ++k) {
        ASSERT_TRUE(sample(pose, made->clip("Swing"), static_cast<float>(k) / 30000.0f));
        for (const Constraint& limit : made->constraints()) {
            const glm::quat rest = made->joints()[limit.joint].rest.rotation;
            const glm::quat local = pose.local(limit.joint).rotation;
            worst = std::max(worst, violation(limit, to_constraint_space(limit, rest, local)));
        }
    }
    EXPECT_LT(worst, 1e-4);
}

/// A clip in which a forearm turns once about its own axis within two seconds.
ClipSpec rolling(const HumanModel& human) {
    ClipSpec clip{"Roll"};
    clip.end = 2.0f;
    clip.tracks.push_back({TrackPath::rotation, human.joint("leftForeArm"), 4, {}, {}});
    for (int k = 0; k <= 8; ++k) {
        const auto q = glm::angleAxis(glm::radians(45.0 * k), glm::dvec3(1, 0, 0));
        clip.tracks.back().times.push_back(0.25f * static_cast<float>(k));
        for (const double number : {q.x, q.y, q.z, q.w})
            clip.tracks.back().values.push_back(static_cast<float>(number));
    }
    return clip;
}

TEST(RetargetClips, WhatWouldJumpAtALimitTurnsQuicklyInside) {
    const HumanModel human(HumanSpec{.axes = 0});
    ConstraintRecord twist;
    twist.model = static_cast<std::uint8_t>(ConstraintModel::swing_twist_ellipse);
    twist.rotation_min = {-1.2f, -1.5f, -1.5f};
    twist.rotation_max = {1.2f, 1.5f, 1.5f};
    for (const bool is_proposed : {false, true}) {
        twist.flags = is_proposed ? kProposed : 0;
        edit::Log log;
        const test::Owned model(retargeted(counted(HumanModel({.axes = 0, .elbows = {twist}}).spec),
                                           file_of(human, {rolling(human)}),
                                           {"", {RestPoses::measured, Limits::soft, false}}, log));
        const Clip& clip = model->clips()[0];
        const std::uint32_t elbow = model->joint("leftForeArm");
        const Constraint& limit = *model->constraint(elbow);
        Pose pose(*model);
        std::optional<glm::dquat> last;
        double quickest = 0.0, farthest = 0.0;
        constexpr int kRate = 480;
        for (int frame = 0; frame <= 2 * kRate; ++frame) {
            ASSERT_TRUE(sample(pose, &clip, static_cast<float>(frame) / kRate));
            const glm::dquat now = glm::normalize(glm::dquat(pose.local(elbow).rotation));
            if (last)
                quickest = std::max(quickest, 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(*last, now)))) * kRate);
            last = now;
            const glm::quat& rest = model->joints()[elbow].rest.rotation;
            farthest = std::max(farthest, violation(limit, to_constraint_space(limit, rest, glm::quat(now))));
        }
        // The source turns by pi a second.
        EXPECT_LT(quickest, kTurnSpeed + (1.0 + kOfSource) * glm::radians(180.0));
        EXPECT_GT(quickest, 1.2 * glm::radians(180.0));
        EXPECT_GT(farthest, is_proposed ? 0.1 : -1.0);
        EXPECT_LT(farthest, is_proposed ? kSoftLimit : 1e-4);
    }
}

TEST(RetargetClips, AJumpStaysAJump) {
    const HumanModel human(HumanSpec{});
    test::ModelSpec spec = human.spec;
    test::Node clip = test::clip_node(swinging(human, "Jump"));
    Buffer& tracks = test::child(clip, "TRAK").payload;
    for (std::size_t at = 0; at < tracks.size(); at += sizeof(TrackRecord))
        tracks[at + offsetof(TrackRecord, interpolation)] = static_cast<std::byte>(Interpolation::step);
    spec.more.push_back(clip);
    const Buffer source = counted(spec);
    edit::Log log;
    const HumanModel build(HumanSpec{.thigh = 0.3, .axes = 4});
    const test::Owned made(retargeted(counted(build.spec), source, {"", kDirections}, log));
    Pose before(*made), start(*made);
    ASSERT_TRUE(sample(start, made->clip("Jump"), 0.0f));
    ASSERT_TRUE(sample(before, made->clip("Jump"), 0.3999f));
    const auto elbow = build.joint("leftForeArm");
    EXPECT_GT(std::abs(glm::dot(before.local(elbow).rotation, start.local(elbow).rotation)), 1.0f - 1e-6f);
}

/// Stands, with the left foot lifted in the middle.
Buffer stepper(float from = 0.0f) {
    const HumanModel human(HumanSpec{.axes = 0});
    ClipSpec clip{"Step"};
    const float half = 0.5f;
    clip.tracks.push_back({TrackPath::rotation,
                           human.joint("leftUpLeg"),
                           4,
                           {from, 0.5f, 1},
                           {0, 0, 0, 1, -std::sin(half), 0, 0, std::cos(half), 0, 0, 0, 1}});
    return file_of(human, {clip});
}

TEST(RetargetClips, FeetAreOnTheGroundByCurvesThatCanBeEdited) {
    const Buffer target = counted(HumanModel(HumanSpec{.thigh = 0.3, .axes = 2}).spec);
    edit::Log log;
    const Buffer made = retargeted(target, stepper(), {}, log);
    const test::Owned model(made);
    const Clip& clip = *model->clip("Step");
    ASSERT_EQ(clip.curves.size(), 4u);
    EXPECT_EQ(clip.curves[0].path, "/extras/" + std::string(clip.curves[0].name));  // so that glTF can hold it
    float weight = -1.0f;
    ASSERT_TRUE(sample_curve(*find_curve(clip, "left_heel_contact"), 0.0, std::span(&weight, 1)));
    EXPECT_EQ(weight, 1.0f);
    ASSERT_TRUE(sample_curve(*find_curve(clip, "left_heel_contact"), 0.5, std::span(&weight, 1)));
    EXPECT_NEAR(weight, 0.0f, kMostWeight);
    ASSERT_TRUE(sample_curve(*find_curve(clip, "right_heel_contact"), 0.5, std::span(&weight, 1)));
    EXPECT_EQ(weight, 1.0f);
    // The clip has curves now, which decide and come along.
    edit::Log other;
    const test::Owned again(retargeted(counted(HumanModel(HumanSpec{.axes = 5}).spec), made, {}, other));
    EXPECT_EQ(again->clip("Step")->curves.size(), 4u);
    EXPECT_NE(other.done[1].find("feet by its contact curves"), std::string::npos) << other.done[1];
}

TEST(RetargetClips, AClipOfOneMomentStays) {
    const HumanModel human(HumanSpec{});
    ClipSpec clip = swinging(human, "Pose");
    for (auto& track : clip.tracks) track.times = {0.25f}, track.values.resize(4);
    clip.start = clip.end = 0.25f;
    edit::Log log;
    const test::Owned made(retargeted(counted(HumanModel(HumanSpec{.axes = 4}).spec), file_of(human, {clip}), {}, log));
    EXPECT_EQ(made->clip("Pose")->start, 0.25f);
    EXPECT_EQ(made->clip("Pose")->end, 0.25f);
}

TEST(RetargetClips, AFootThatIsLiftedInAnInstantIsLetGoSlowly) {
    edit::Log log;
    const test::Owned model(
        retargeted(counted(HumanModel(HumanSpec{.thigh = 0.3, .axes = 2}).spec), stepper(0.49f), {}, log));
    const auto weight = [&](double seconds) {
        float found = -1.0f;
        EXPECT_TRUE(
            sample_curve(*find_curve(*model->clip("Step"), "left_heel_contact"), seconds, std::span(&found, 1)));
        return found;
    };
    EXPECT_EQ(weight(0.48), 1.0f);
    EXPECT_NEAR(weight(0.52), weight(0.5) - 0.02f / 0.06f, 0.02f);
    EXPECT_NEAR(weight(0.58), 0.0f, kMostWeight);
}

TEST(RetargetClips, AnimalsPlayTheClipsOfOtherAnimals) {
    const AnimalModel fox(AnimalSpec{});
    const Buffer source = file_of(fox, {swinging(fox, "Swing", 0.2)});
    const AnimalModel horse(AnimalSpec{.body = {.facing = 90, .axes = 4},
                                       .hind = {0.22, 0.46, 0.37},
                                       .front = {0.23, 0.42, 0.3},
                                       .front_leans = {-42.0, -3.0, -8.0},
                                       .spine = 5,
                                       .tail = 2});
    edit::Log log;
    const test::Owned planted(retargeted(counted(horse.spec), source, {}, log));
    // Animals of other builds: something gives way, and nothing is lost. The swing is another one for each compiler.
    for (const std::string& warning : log.warnings)
        EXPECT_NE(warning.find(" in 1 clip, most "), std::string::npos) << warning;
    ASSERT_EQ(planted->clip("Swing")->curves.size(), 8u);
    EXPECT_EQ(planted->clip("Swing")->curves[4].name, "left_front_heel_contact");

    expect_tracks_as_retargeted(horse, source);

    // The horse's own clip comes back unchanged.
    const Buffer own = file_of(horse, {swinging(horse, "Swing", 0.2)});
    edit::Log other;
    const Buffer again = retargeted(own, own, {"Swing", {}, edit::SameName::number}, other);
    EXPECT_EQ(track_bytes(again, 0), track_bytes(again, 1));
}

/// An animal that stands on straight hind legs raises the shoulders of one that rests on bent ones: its front legs are
/// too short to follow the directions.
TEST(RetargetClips, TurnsOfAnimalsAreTakenFromRestIfHipsSinkOtherwise) {
    const AnimalModel straight(AnimalSpec{.hind_leans = {0.0, 0.0, 0.0}, .front_leans = {0.0, 0.0}});
    const AnimalModel bent(AnimalSpec{.body = {.axes = 4}, .front_leans = {0.0, 0.0}});
    const Buffer source = file_of(straight, {swinging(straight, "Stand", 0.02)});
    const Buffer target = counted(bent.spec);
    const auto made = [&](RestPoses rest_poses, bool chooses, std::size_t said, std::size_t lowered) {
        RetargetClips options;
        options.retarget.rest_poses = rest_poses;
        options.chooses_rests = chooses;
        edit::Log log;
        Buffer file = retargeted(target, source, options, log);
        const auto count = [](const std::vector<std::string>& lines, const char* what) {
            return static_cast<std::size_t>(std::count_if(lines.begin(), lines.end(), [&](const std::string& line) {
                return line.find(what) != std::string::npos;
            }));
        };
        EXPECT_EQ(count(log.done, "--rests-alike"), said);
        EXPECT_EQ(count(log.warnings, "the hips are lowered"), lowered);
        return file;
    };
    const Buffer measured = made(RestPoses::measured, false, 0, 1);
    const Buffer alike = made(RestPoses::alike, false, 0, 0);
    EXPECT_NE(measured, alike);
    EXPECT_EQ(made(RestPoses::measured, true, 1, 0), alike);
}

TEST(RetargetClips, SaysWhatIsNotRetargeted) {
    const AnimalModel fox(AnimalSpec{});
    EXPECT_EQ(problem_of(counted(fox.spec), swinger()),
              "the source is a human and the target an animal on four legs: nothing is retargeted between them");
}

TEST(RetargetClips, OfTwoCharactersInAFileItSaysWhichIsTaken) {
    HumanModel first(HumanSpec{.axes = 3, .prefix = "a_"});
    const HumanModel second(HumanSpec{.axes = 5, .prefix = "b_"});
    const auto count = static_cast<std::uint32_t>(first.spec.joints.size());
    for (test::JointSpec joint : second.spec.joints) {
        joint.parent = joint.parent == kNone ? kNone : joint.parent + count;
        first.spec.joints.push_back(joint);
    }
    const std::string said =
        "is the character below the joint \"a_root\" (#0); its file has \"b_root\" (#28) beside it.";
    edit::Log log;
    (void)retargeted(counted(first.spec), swinger(), {}, log);
    ASSERT_FALSE(log.warnings.empty());
    EXPECT_TRUE(log.warnings[0].starts_with("the target " + said)) << log.warnings[0];

    // Clips of the other one: the error says it too.
    ClipSpec clip = swinging(second, "Swing");
    for (auto& track : clip.tracks) track.target += count;
    const Buffer both = file_of(first, {clip});
    const std::string problem = problem_of(counted(HumanModel(HumanSpec{}).spec), both);
    EXPECT_NE(problem.find("; the source " + said), std::string::npos) << problem;
}

test::MeshSpec face(const std::string& name, const std::vector<std::string>& targets) {
    test::MeshSpec mesh;
    mesh.joint = 0;
    mesh.positions = {{0, 0, 0}};
    mesh.more.push_back(test::make_leaf(FourCC("NAME"), std::as_bytes(std::span(name))));
    for (const std::string& target : targets) {
        mesh.more.push_back(test::make_container(
            FourCC("TARG"), {test::make_leaf(FourCC("NAME"), std::as_bytes(std::span(target))),
                             test::make_leaf(FourCC("TINF"), bytes_of(MorphTargetRecord{})),
                             test::make_leaf(FourCC("POSI"), test::stream_payload<float>(3, {0, 1, 0}))}));
    }
    return mesh;
}

TEST(RetargetClips, FacesFollowByNamesInAnySpelling) {
    const HumanModel human(HumanSpec{});
    test::ModelSpec spec = human.spec;
    spec.meshes = {face("Face", {"eyeBlinkLeft", "jawOpen", "ownName"})};
    ClipSpec clip{"Talk"};
    clip.tracks = {{TrackPath::weights, 0, 3, {0, 1}, {0, 0.5f, 0, 1, 0.25f, 1}}};
    spec.more.push_back(test::clip_node(clip));
    const auto played = [&](std::vector<test::MeshSpec> meshes, edit::Log& log) {
        test::ModelSpec target = HumanModel(HumanSpec{.axes = 4}).spec;
        target.meshes = std::move(meshes);
        const test::Owned made(retargeted(counted(target), counted(spec), {}, log));
        Pose pose(*made);
        EXPECT_TRUE(sample(pose, made->clip("Talk"), 0.5f));
        return std::vector<float>(pose.morph_weights().begin(), pose.morph_weights().end());
    };
    edit::Log one, two;
    EXPECT_EQ(played({face("Head", {"Head.JawOpen", "EyeBlink_L"})}, one), (std::vector{0.375f, 0.5f}));
    ASSERT_FALSE(one.warnings.empty());
    EXPECT_EQ(one.warnings.back(), "there are no morph targets here for the weights of \"ownName\"");
    EXPECT_EQ(played({face("Skin", {"jaw open"}), face("Teeth", {"none", "jaw.open"})}, two),
              (std::vector{0.375f, 0.0f, 0.375f}));
}

TEST(RetargetClips, ALongClipOfFewKeysTakesFewSamples) {
    const HumanModel human(HumanSpec{});
    ClipSpec clip = swinging(human, "Long");
    clip.end = 1e6f;
    for (auto& track : clip.tracks) track.times = {0.0f, 4e5f, 1e6f};
    edit::Log log;
    const test::Owned made(retargeted(counted(HumanModel(HumanSpec{.axes = 4}).spec), file_of(human, {clip}), {}, log));
    for (const TrackView& track : made->clip("Long")->tracks) EXPECT_LT(track.keys, 1200u);
}

TEST(RetargetClips, ABodyWithoutLegsFollowsWithTheRest) {
    HumanModel human(HumanSpec{.axes = 4});
    human.forget({Role::left_upper_leg, Role::left_lower_leg, Role::left_foot, Role::left_toes});
    edit::Log log;
    EXPECT_EQ(test::Owned(retargeted(counted(human.spec), swinger(), {}, log))->clips().size(), 1u);
    ASSERT_EQ(log.warnings.size(), 1u);
    EXPECT_TRUE(log.warnings[0].starts_with("nothing here follows 4 joints: ")) << log.warnings[0];
}

TEST(RetargetClips, WhatTheSourceDoesNotHaveIsNamed) {
    const HumanModel human(HumanSpec{.has_hands = false, .has_head = false});
    test::ModelSpec other = HumanModel(HumanSpec{.axes = 4}).spec;
    for (test::JointSpec& joint : other.joints) joint.name = "own " + joint.name;
    edit::Log log;
    const Buffer source = file_of(human, {swinging(human, "Swing")});
    EXPECT_EQ(test::Owned(retargeted(counted(other), source, {}, log))->clips().size(), 1u);
    ASSERT_EQ(log.warnings.size(), 1u);
    EXPECT_EQ(log.warnings[0],
              "the source has no counterpart of 3 joints here, left at rest: \"own head\", "
              "\"own leftHand\" and \"own rightHand\"");
}

struct Turn {
    const char* joint;
    double degrees;
    glm::dvec3 axis;  ///< of the joint
};

/// A clip in which joints with the axes of model space turn from rest within a second, and the hips rise.
ClipSpec turning(const HumanModel& human, const std::vector<Turn>& turns, float raised = 0.0f) {
    ClipSpec clip{"Turn"};
    for (const Turn& turn : turns) {
        const glm::quat q(glm::angleAxis(glm::radians(turn.degrees), turn.axis));
        clip.tracks.push_back(
            {TrackPath::rotation, human.joint(turn.joint), 4, {0, 1}, {0, 0, 0, 1, q.x, q.y, q.z, q.w}});
    }
    const std::uint32_t hips = human.joint("hips");
    const auto& at = human.spec.joints[hips].rest.translation;
    clip.tracks.push_back(
        {TrackPath::translation, hips, 3, {0, 1}, {at[0], at[1], at[2], at[0], at[1] + raised, at[2]}});
    return clip;
}

TEST(RetargetClips, BonesThatPointElsewhereThanTheSourcesAreNamedWithTheCause) {
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0);
    const HumanModel human(HumanSpec{.axes = 0});
    const auto warnings = [&](const HumanSpec& target, const ClipSpec& clip, const RetargetOptions& options = {}) {
        edit::Log log;
        (void)retargeted(counted(HumanModel(target).spec), file_of(human, {clip}), {"", options}, log);
        log.warnings.resize(std::max<std::size_t>(1, log.warnings.size()));
        return log.warnings;
    };
    EXPECT_EQ(warnings({.facing = 90.0, .axes = 2}, turning(human, {{"leftForeArm", -60.0, y}}))[0], "");

    ConstraintRecord stiff;
    stiff.model = static_cast<std::uint8_t>(ConstraintModel::largest_angle);
    stiff.rotation_max[0] = static_cast<float>(glm::radians(10.0));
    const HumanSpec robot{.axes = 0, .elbows = {stiff}};
    EXPECT_EQ(warnings(robot, turning(human, {{"leftForeArm", -60.0, y}}))[0],
              "limits turn bones far from the source's directions in 1 clip, most \"leftForeArm\" by 50 degrees in "
              "\"Turn\" at 1 s; --limits off goes beyond them");

    const HumanSpec hanging{.arms_down = 55.0, .axes = 3};
    EXPECT_EQ(
        warnings(hanging, turning(human, {}), {.rest_poses = RestPoses::alike})[0],
        "bones point far from the source's directions in 1 clip, most \"leftForeArm\" by 55 degrees in \"Turn\" at "
        "0 s; one of the bodies does not stand in its rest pose, or is built differently: --stand says how it stands, "
        "--rests-alike takes turns from rest");

    // Feet of the same length, and legs of less than half: on tiptoe its knees bend.
    const ClipSpec tiptoe = turning(human, {{"leftFoot", 50.0, x}, {"rightFoot", 50.0, x}}, 0.078f);
    const std::string bent = warnings({.thigh = 0.1, .shin = 0.3, .axes = 4}, tiptoe)[0];
    EXPECT_TRUE(bent.starts_with("feet on the ground turn legs far from the source's directions in 1 clip, most "))
        << bent;
    EXPECT_TRUE(bent.ends_with("; --free-feet lets them go")) << bent;
}

TEST(RetargetClips, ThePageSaysWhatIsFarFromTheSource) {
    std::ifstream file((source_folder() / "docs/retarget.md").string());
    const std::string page((std::istreambuf_iterator<char>(file)), {});
    const auto whole = [](double number) { return std::to_string(std::lround(number)); };
    EXPECT_NE(page.find("limbs that point more than " + whole(kFarOfLimb) +
                        " degrees elsewhere than the source's, other bones more than " + whole(kFarOfOthers) + ":"),
              std::string::npos);
    EXPECT_NE(page.find("by more than " + whole(100.0 * kFarMiss) + " % of the legs' length;"), std::string::npos);
    EXPECT_NE(page.find("by at most " + whole(kTurnSpeed) + " radians a second (legs under hard limits: " +
                        whole(kHardLegSpeed) + ") beyond " + whole(10.0 * kOfSource).insert(1, ".") + " times"),
              std::string::npos);
    EXPECT_NE(page.find("by more than " + whole(kPopTurn) + " degrees in 1/" + whole(1.0 / kPopSeconds) +
                        " s, and by more than twice the most"),
              std::string::npos);
    EXPECT_EQ(kPopOfSource, 2.0);
    EXPECT_NE(page.find("over the clips is less than " + whole(100.0 * kBetter) + " % then"), std::string::npos);
    const std::string most = whole(glm::degrees(kSoftLimit));
    EXPECT_NE(page.find("up to " + most + " degrees beyond limits"), std::string::npos);
    EXPECT_NE(page.find("e / (1 + e / " + most + ")"), std::string::npos);
}

TEST(RetargetClips, ClipsWithoutACounterpartAreLeftOut) {
    const HumanModel human(HumanSpec{});
    ClipSpec sword{"Sword"};
    sword.tracks = {{TrackPath::translation, human.joint("sword"), 3, {0, 1}, {0, 0, 0, 1, 0, 0}}};
    test::ModelSpec other = HumanModel(HumanSpec{.axes = 4}).spec;
    for (test::JointSpec& joint : other.joints) joint.name = "own " + joint.name;
    const Buffer target = counted(other);
    EXPECT_EQ(problem_of(target, file_of(human, {sword})),
              "its clips animate no joint that has a role or a joint of the same name here: \"Sword\"");
    edit::Log log;
    const Buffer source = file_of(human, {sword, swinging(human, "Swing")});
    EXPECT_EQ(test::Owned(retargeted(target, source, {}, log))->clips().size(), 1u);
    ASSERT_EQ(log.warnings.size(), 2u);
    EXPECT_EQ(log.warnings[0], "clips that animate nothing in this file are left out: \"Sword\"");
    EXPECT_EQ(log.warnings[1], "nothing here follows 1 joint: \"sword\"");
}

TEST(RetargetClips, SaysWhatIsMissing) {
    const Buffer human = counted(HumanModel(HumanSpec{}).spec);
    const Buffer source = swinger();
    EXPECT_EQ(problem_of(human, human), "the source has no clips");
    EXPECT_EQ(problem_of(human, source, {"Swim"}),
              "there is no clip \"Swim\"; did you mean \"Swing\"? There is \"Swing\"");
    EXPECT_EQ(problem_of(source, source), "there is a clip \"Swing\" already");
    const std::string nobody = problem_of(counted(HumanModel(HumanSpec{.has_roles = false}).spec), source);
    EXPECT_TRUE(nobody.starts_with("the target does not say what its joints are: ")) << nobody;
    EXPECT_NE(nobody.find("28 joints: \"root\", \"hips\", "), std::string::npos) << nobody;
    EXPECT_NE(problem_of(human, Buffer(64)), "");
}

}  // namespace
}  // namespace bendy::motion::retarget_clips_test
