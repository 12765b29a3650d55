#include <bendy/motion/retarget_clips.h>
#include <bendy/motion/stand.h>
#include <bendy/runtime.h>

#include "runtime/clip_model.h"
#include "runtime/human_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace bendy::motion::stand_test {
namespace {

using test::Buffer;
using test::ClipSpec;
using test::HumanModel;
using test::HumanSpec;

/// A human whose rest pose lies on its back: its hips are turned. Its clip "Stand" turns them upright, and about the
/// vertical by some degrees.
HumanModel lying(double looks = 0.0) {
    HumanModel human(HumanSpec{});
    const std::uint32_t hips = human.joint("hips");
    const std::array<float, 4> upright = human.spec.joints[hips].rest.rotation;
    ClipSpec clip{"Stand"};
    clip.tracks.push_back({TrackPath::rotation, hips, 4, {0.0f, 1.0f}, {}});
    const glm::quat looking(glm::angleAxis(looks * M_PI / 180.0, glm::dvec3(0, 1, 0)) *
                            glm::dquat(upright[3], upright[0], upright[1], upright[2]));
    for (int key = 0; key < 2; ++key) {
        for (const float part : {looking.x, looking.y, looking.z, looking.w}) clip.tracks.back().values.push_back(part);
    }
    human.spec.more.push_back(test::clip_node(clip));
    const glm::dquat turned =
        glm::angleAxis(-M_PI / 2.0, glm::dvec3(1, 0, 0)) * glm::dquat(upright[3], upright[0], upright[1], upright[2]);
    human.spec.joints[hips].rest.rotation = {static_cast<float>(turned.x), static_cast<float>(turned.y),
                                             static_cast<float>(turned.z), static_cast<float>(turned.w)};
    return human;
}

/// Returns a file whose counts are right: commands read nothing else.
Buffer file_of(const HumanModel& human) {
    test::Node root = test::to_node(test::build_file(human.spec));
    std::uint32_t clips = 0;
    for (const test::Node& chunk : human.spec.more) clips += chunk.id == FourCC("CYCL") ? 1 : 0;
    test::edit<VersionRecord>(test::at(root, "HEAD/VERS"), [&](VersionRecord& version) { version.clips = clips; });
    return test::to_file(root);
}

/// Where a joint is in the standing pose.
glm::dvec3 place(const Model& model, std::uint32_t joint) {
    Pose pose(model);
    EXPECT_TRUE(stand(pose));
    return {pose.model_space()[joint][3]};
}

TEST(Stand, SaysWhereACharacterFaces) {
    for (const double degrees : {0.0, 90.0, 180.0, -60.0}) {
        const test::Owned model(file_of(HumanModel(HumanSpec{.facing = degrees, .axes = 3})));
        EXPECT_NEAR(std::remainder(facing(*model) - degrees * M_PI / 180.0, 2.0 * M_PI), 0.0, 1e-5) << degrees;
    }
    const test::Owned leaning(file_of(HumanModel(HumanSpec{.facing = 12.0})));
    EXPECT_EQ(facing(*leaning), 0.0);
    const test::Owned nobody(file_of(HumanModel(HumanSpec{.facing = 90.0, .has_roles = false})));
    EXPECT_EQ(facing(*nobody), 0.0);
}

TEST(Stand, IsTakenFromAClip) {
    const HumanModel human = lying();
    edit::Log log;
    const auto edited = stand_as_in_clip(file_of(human), "Stand", 0.5, log);
    ASSERT_TRUE(edited) << edited.error().message;
    const Result<Model> model = Model::from_memory(*edited);
    ASSERT_TRUE(model);
    ASSERT_NE(model->standing_pose(), nullptr);
    EXPECT_EQ(model->standing_pose()->pose.evidence, 0u);
    EXPECT_EQ(model->standing_pose()->rotations.size(), model->roles().size());
    const glm::dvec3 spine = place(*model, human.joint("head")) - place(*model, human.joint("hips"));
    EXPECT_GT(spine.y / glm::length(spine), 0.99);
    EXPECT_NEAR(model->standing_pose()->pose.height, 1.58f, 0.02f);
    Pose rest(*model);
    const glm::dvec3 lies(rest.model_space()[human.joint("head")][3] - rest.model_space()[human.joint("hips")][3]);
    EXPECT_LT(std::abs(lies.y) / glm::length(lies), 0.1);
}

/// Where a body looks in one frame does not turn its clips.
TEST(Stand, FacesTheFrontWhereverTheClipLooks) {
    for (const double looks : {0.0, 60.0, 145.0, -90.0}) {
        const HumanModel human = lying(looks);
        edit::Log log;
        const auto edited = stand_as_in_clip(file_of(human), "Stand", 0.5, log);
        ASSERT_TRUE(edited) << edited.error().message;
        const Result<Model> model = Model::from_memory(*edited);
        ASSERT_TRUE(model);
        EXPECT_NEAR(model->standing_pose()->pose.axes[3], 1.0f, 1e-5f) << looks;
        const glm::dvec3 left = place(*model, human.joint("leftHand")) - place(*model, human.joint("rightHand"));
        EXPECT_GT(glm::normalize(left).x, 0.999) << looks;

        const HumanModel other(HumanSpec{.axes = 3});
        const Buffer other_file = file_of(other);
        const Result<Model> target = Model::from_memory(other_file);
        ASSERT_TRUE(target);
        auto made = Retarget::make(*model, *target, {RestPoses::measured, Limits::off, false});
        ASSERT_TRUE(made);
        Pose from(*model), to(*target);
        (void)sample(from, &model->clips()[0], 0.5f);
        RetargetState state;
        ASSERT_TRUE(retarget(to, *made, from, state));
        const glm::dvec3 across(to.model_space()[other.joint("leftHand")][3] -
                                to.model_space()[other.joint("rightHand")][3]);
        EXPECT_NEAR(std::atan2(-across.z, across.x), looks * M_PI / 180.0, 1e-4) << "as in the source";
    }
}

TEST(Stand, IsTakenFromAnotherFilesRestPose) {
    const HumanModel human = lying();
    edit::Log log;
    const auto edited = stand_as(file_of(human), file_of(HumanModel(HumanSpec{})), log);
    ASSERT_TRUE(edited) << edited.error().message;
    const Result<Model> model = Model::from_memory(*edited);
    ASSERT_TRUE(model);
    const glm::dvec3 spine = place(*model, human.joint("head")) - place(*model, human.joint("hips"));
    EXPECT_GT(spine.y / glm::length(spine), 0.99);
}

TEST(Stand, SaysWhatIsMissing) {
    edit::Log log;
    const Buffer file = file_of(lying());
    const auto problem = [&](const edit::Edited& edited) { return edited ? std::string() : edited.error().message; };
    EXPECT_NE(problem(stand_as_in_clip(file, "Run", 0.0, log)).find("Run"), std::string::npos);
    EXPECT_NE(problem(stand_as_in_clip(file, "Stand", 1.5, log)).find("is from 0"), std::string::npos);
    EXPECT_NE(problem(stand_as_in_clip(file, "Stand", std::nan(""), log)), "");
    EXPECT_NE(problem(stand_as(file, file_of(HumanModel(HumanSpec{.prefix = "other:"})), log)).find("it has no joint"),
              std::string::npos);
    const Buffer bare = file_of(HumanModel(HumanSpec{.has_roles = false}));
    EXPECT_NE(problem(stand_as(bare, file, log)).find("--role"), std::string::npos);
}

/// The ground is that of the clips, wherever the root's rest translation has the body.
TEST(Stand, FeetArePlantedOnTheGroundOfTheClips) {
    constexpr float kSunk = 0.3f;
    const HumanModel plain(HumanSpec{});
    HumanModel sunk(HumanSpec{});
    const std::uint32_t hips = sunk.joint("hips");
    sunk.spec.joints[hips].rest.translation[1] -= kSunk;
    const Buffer plain_file = file_of(plain);
    const auto standing = Model::from_memory(plain_file);
    Pose rest(*standing);
    float lowest = 1.0f;
    for (const JointRole& role : standing->roles()) lowest = std::min(lowest, rest.model_space()[role.joint][3].y);
    StandingPoseRecord record;
    record.axes = {0.0f, 0.0f, 0.0f, 1.0f};
    record.ground = lowest;
    record.height = 1.58f;
    const auto told = edit::set_standing_pose(file_of(sunk), record, {});
    ASSERT_TRUE(told) << told.error().message;
    const auto low = Model::from_memory(*told);
    ASSERT_TRUE(low);
    const std::uint32_t foot = plain.joint("leftFoot");
    const double stands = rest.model_space()[foot][3].y;
    const auto put = [&](const Model& source, const Model& target, float raised) {
        auto made = Retarget::make(source, target, {RestPoses::measured, Limits::off, true});
        EXPECT_TRUE(made);
        Pose from(source), to(target);
        JointTransform local = from.local(hips);
        local.translation.y += raised;
        from.set_local(hips, local);
        RetargetState state;
        const auto done = retarget(to, *made, from, state);
        EXPECT_TRUE(done);
        EXPECT_EQ(done->contacts[0], 1.0f);
        return double{to.model_space()[foot][3].y};
    };
    EXPECT_NEAR(put(*standing, *low, 0.0f), stands, 1e-4);
    EXPECT_NEAR(put(*low, *standing, kSunk), stands, 1e-4);
}

/// A body that lies at rest is retargeted from and to as the same body that stands.
TEST(Stand, IsWhatRetargetingMeasuresFrom) {
    const HumanModel upright(HumanSpec{});
    const HumanModel human = lying();
    edit::Log log;
    const auto told = stand_as(file_of(human), file_of(upright), log);
    ASSERT_TRUE(told);
    HumanModel other(HumanSpec{.facing = 90.0, .arms_down = 40.0, .axes = 3});
    const Buffer other_file = file_of(other);
    const Buffer upright_file = file_of(upright);
    const auto models =
        std::array{Model::from_memory(upright_file), Model::from_memory(*told), Model::from_memory(other_file)};
    const Model &standing = *models[0], &turned = *models[1], &third = *models[2];
    constexpr RetargetOptions kDirections{RestPoses::measured, Limits::off, false};
    Pose from_standing(standing), from_turned(turned);
    for (const JointRole& role : standing.roles()) {
        JointTransform local = from_standing.local(role.joint);
        local.rotation =
            glm::normalize(local.rotation * glm::quat(1.0f, 0.1f, -0.2f, 0.05f * static_cast<float>(role.role % 5)));
        from_standing.set_local(role.joint, local);
        from_turned.set_local(role.joint, local);
    }
    const auto worst = [](Pose& a, Pose& b) {
        float largest = 0.0f;
        for (std::size_t joint = 0; joint < a.model_space().size(); ++joint)
            largest = std::max(largest, glm::distance(a.model_space()[joint][3], b.model_space()[joint][3]));
        return largest;
    };
    const auto put = [&](const Model& source, const Model& target, Pose& from) {
        auto made = Retarget::make(source, target, kDirections);
        EXPECT_TRUE(made);
        Pose pose(target);
        RetargetState state;
        EXPECT_TRUE(retarget(pose, *made, from, state));
        return pose;
    };
    Pose a = put(standing, third, from_standing);
    Pose b = put(turned, third, from_turned);
    EXPECT_LT(worst(a, b), 2e-4f);
    Pose third_pose(third);
    for (const JointRole& role : third.roles()) {
        JointTransform local = third_pose.local(role.joint);
        local.rotation = glm::normalize(local.rotation * glm::quat(1.0f, 0.2f, 0.1f, -0.1f));
        third_pose.set_local(role.joint, local);
    }
    Pose c = put(third, standing, third_pose);
    Pose d = put(third, turned, third_pose);
    EXPECT_LT(worst(c, d), 2e-4f);
}

/// How the trunk leans in a moment of a clip does not say how it runs in the rig, as it does in a pose that is made to
/// stand.
TEST(Stand, OfAMomentTheTrunkHasTheSourcesDirections) {
    constexpr double kBent = 10.0;
    HumanModel bent(HumanSpec{.bent = kBent});
    const HumanModel straight(HumanSpec{.axes = 2});
    const Buffer straight_file = file_of(straight);
    const auto target = Model::from_memory(straight_file);
    for (const auto& [evidence, off] :
         {std::pair(StandingEvidence::told, kBent), {StandingEvidence::clip, 0.0}, {StandingEvidence::assumed, 0.0}}) {
        StandingPoseRecord record;
        record.axes = {0.0f, 0.0f, 0.0f, 1.0f};
        record.height = 1.58f;
        record.evidence = static_cast<std::uint8_t>(evidence);
        const auto file = edit::set_standing_pose(file_of(bent), record, {});
        ASSERT_TRUE(file) << file.error().message;
        const auto source = Model::from_memory(*file);
        ASSERT_TRUE(source);
        Pose from(*source), to(*target);
        auto made = Retarget::make(*source, *target, {RestPoses::measured, Limits::off, false});
        ASSERT_TRUE(made);
        RetargetState state;
        ASSERT_TRUE(retarget(to, *made, from, state));
        const auto way = [](Pose& pose, const HumanModel& human) {
            return glm::normalize(glm::dvec3(pose.model_space()[human.joint("spine2")][3]) -
                                  glm::dvec3(pose.model_space()[human.joint("spine1")][3]));
        };
        const double cosine = glm::dot(way(from, bent), way(to, straight));
        EXPECT_NEAR(std::acos(std::min(1.0, cosine)) * 180.0 / M_PI, off, 0.1) << static_cast<int>(evidence);
    }
}

}  // namespace
}  // namespace bendy::motion::stand_test
