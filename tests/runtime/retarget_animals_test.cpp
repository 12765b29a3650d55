#include <bendy/runtime/constrain.h>
#include <bendy/runtime/retarget.h>

#include "mutation/allocations.h"
#include "runtime/animal_model.h"
#include "runtime/human_model.h"
#include "runtime/local_joints.h"
#include "runtime/posed_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

// Retargeting between animals. Directions and turns are judged by joint matrices alone.
namespace bendy::retarget_animals_test {
namespace {

using test::angle_of;
using test::AnimalModel;
using test::AnimalSpec;
using test::HumanModel;
using test::HumanSpec;
using test::kDirections;
using test::made;

/// A horse is as long in the cannon as a fox in the forearm: its wrist is high above the ground.
const AnimalSpec kHorse{.body = {.axes = 3},
                        .hind = {0.22, 0.46, 0.37},
                        .hind_leans = {17.0, -31.0, -6.0},
                        .front = {0.23, 0.42, 0.3},
                        .front_leans = {-42.0, -3.0, -8.0},
                        .trunk = 1.3};

/// An animal and a pose of it.
class Animal : public test::PosedBody<AnimalModel> {
public:
    explicit Animal(const AnimalSpec& spec) : PosedBody(AnimalModel(spec), spec.body.facing), spec_(spec) {}

    [[nodiscard]] const AnimalSpec& spec() const { return spec_; }

private:
    AnimalSpec spec_;
};

constexpr const char* kLegs[] = {"leftHind", "rightHind", "leftFront", "rightFront"};

/// Bones above the foot, which is the wrist of an animal with low wrists.
std::size_t bones_of(const AnimalSpec& spec, const std::string& leg) {
    return leg.ends_with("Hind") ? spec.hind.size() : spec.has_front ? spec.front.size() : 0;
}

double worst_direction(Animal& source, Animal& target) {
    double worst = 0.0;
    for (const std::string leg : kLegs) {
        const std::size_t bones = std::min(bones_of(source.spec(), leg), bones_of(target.spec(), leg));
        for (std::size_t k = 0; k < bones; ++k) {
            const std::string from = leg + std::to_string(k), to = leg + std::to_string(k + 1);
            worst = std::max(worst, glm::length(source.way(from, to) - target.way(from, to)));
        }
    }
    return worst;
}

const std::vector<AnimalSpec> kTargets{
    {.body = {.axes = 2}},
    kHorse,
    {.body = {.facing = 90.0, .axes = 4}, .has_girdles = false, .has_toes = false},
    {.body = {.is_z_up = true, .axes = 5}, .trunk = 0.7, .spine = 1, .neck = 0, .tail = 2},
    {.body = {.facing = 37.0, .axes = 0}, .hind = {0.2, 0.2, 0.2}, .spine = 5, .neck = 4, .tail = 0},
};

TEST(RetargetAnimals, LegsHaveTheSourcesDirections) {
    for (const AnimalSpec& from : {AnimalSpec{}, kHorse}) {
        Animal source(from);
        for (const AnimalSpec& to : kTargets) {
            Animal target(to);
            Retarget retargeted = made(source, target, kDirections);
            for (unsigned seed = 0; seed < 20; ++seed) {
                source.pose_at_random(seed, 0.4);
                RetargetState state;
                ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
                EXPECT_LT(worst_direction(source, target), 2e-5) << seed << ", axes " << to.body.axes;
            }
        }
    }
}

TEST(RetargetAnimals, SpinesNecksAndTailsOfOtherNumbersEndAsTheSources) {
    Animal source(AnimalSpec{});
    for (const std::uint32_t count : {1u, 2u, 3u, 6u}) {
        Animal target(AnimalSpec{.body = {.facing = 90.0, .axes = 3}, .spine = count, .neck = count, .tail = count});
        Retarget retargeted = made(source, target, {RestPoses::alike, Limits::off, false});
        const std::string last = std::to_string(count - 1);
        for (unsigned seed = 0; seed < 5; ++seed) {
            source.pose_at_random(seed, 0.2);
            RetargetState state;
            ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
            EXPECT_LT(angle_of(source.turn("hips"), target.turn("hips")), 2e-5);
            EXPECT_LT(angle_of(source.turn("head"), target.turn("head")), 2e-5);
            EXPECT_LT(angle_of(source.turn("tail3"), target.turn("tail" + last)), 2e-5);
        }
    }
    source.pose().set_rest();
    Animal bent(AnimalSpec{.body = {.axes = 6}, .spine = 5});
    Retarget retargeted = made(source, bent, kDirections);
    test::local_of(source.pose(), source.joint("spine2"))->rotation *= glm::angleAxis(0.6f, glm::vec3(0, 1, 0));
    RetargetState state;
    ASSERT_TRUE(retarget(bent.pose(), retargeted, source.pose(), state));
    EXPECT_LT(angle_of(source.turn("spine2"), bent.turn("spine4")), 2e-5);
    EXPECT_LT(angle_of(bent.turn("spine2"), glm::dquat(1, 0, 0, 0)), 2e-5);
    EXPECT_GT(angle_of(bent.turn("spine3"), glm::dquat(1, 0, 0, 0)), 0.1);
}

TEST(RetargetAnimals, TheHipsTravelWithTheLengthOfTheHindLegs) {
    Animal source(AnimalSpec{});
    Animal target(AnimalSpec{.body = {.facing = 90.0, .is_z_up = true, .axes = 3}, .hind = {0.66, 0.86, 0.48}});
    Retarget retargeted = made(source, target, kDirections);
    EXPECT_NEAR(retargeted.scale(), 2.0f, 1e-5f);
    EXPECT_NEAR(retargeted.leg(), 2.0f, 1e-5f);
    source.move_hips({0.2f, -0.05f, 0.3f});
    const glm::dvec3 travelled = source.place("hips") - source.rest_place("hips");
    RetargetState state;
    ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
    EXPECT_LT(glm::length(target.place("hips") - target.rest_place("hips") - 2.0 * travelled), 1e-4);
}

TEST(RetargetAnimals, FourFeetMoveAsFarAsTheSources) {
    Animal source(AnimalSpec{});
    for (const AnimalSpec& to : kTargets) {
        Animal target(to);
        Retarget retargeted = made(source, target);
        RetargetState state;
        const double leg = retargeted.leg(), scale = retargeted.scale();
        source.pose().set_rest();
        ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
        const auto feet = [](Animal& animal) {
            std::vector<glm::dvec3> places;
            for (const std::string name : kLegs) {
                const std::size_t foot = name.ends_with("Hind") ? 3 : animal.spec().front.size();
                places.push_back(animal.place(name + std::to_string(foot)));
            }
            return places;
        };
        const std::vector<glm::dvec3> stood = feet(target), source_stood = feet(source);
        for (std::size_t k = 0; k < stood.size(); ++k)
            EXPECT_NEAR(stood[k].y, 0.1, 2e-4 * leg) << k << ", axes " << to.body.axes;
        for (int frame = 0; frame < 30; ++frame) {
            source.pose().set_rest();
            const double phase = 2.0 * M_PI * frame / 30.0;
            source.move_hips(
                glm::vec3(0.02 * std::sin(phase), 0.005 * (std::cos(phase) - 1.0), 0.03 * std::sin(phase)));
            const ContactWeights firm{1, 1, 1, 1, 1, 1, 1, 1};
            const auto done = retarget(target.pose(), retargeted, source.pose(), state, firm);
            ASSERT_TRUE(done);
            EXPECT_LT(done->missed, 2e-4 * leg) << "axes " << to.body.axes;
            const std::vector<glm::dvec3> now = feet(target), source_now = feet(source);
            for (std::size_t k = 0; k < now.size(); ++k) {
                const glm::dvec3 off = now[k] - stood[k] - scale * (source_now[k] - source_stood[k]);
                EXPECT_LT(glm::length(off), 2e-4 * leg) << k << ", axes " << to.body.axes;
            }
        }
    }
}

/// Metres by which the elbow is ahead of the line from shoulder to foot.
double ahead(Animal& animal, const std::string& leg) {
    const glm::dvec3 way = animal.way(leg + "0", leg + "2");
    const glm::dvec3 middle = animal.place(leg + "1") - animal.place(leg + "0");
    return (middle - way * glm::dot(middle, way)).z;
}

TEST(RetargetAnimals, AFootThatStandsBendsItsLegAsTheSource) {
    Animal source(AnimalSpec{});
    // Its leg is counted from the elbow, so that the wrist stands ahead of it, where the source's elbow is behind.
    Animal target(AnimalSpec{.front_leans = {15.0, -15.0}});
    Retarget retargeted = made(source, target);
    RetargetState state;
    for (int frame = 0; frame < 40; ++frame) {
        source.pose().set_rest();
        source.move_hips(glm::vec3(0.0f, -0.03f, 0.05f * static_cast<float>(std::sin(0.3 * frame))));
        ContactWeights contacts{1, 1, 1, 1, 1, 1, 1, 1};
        if (frame % 20 >= 10) contacts.fill(0);
        ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state, contacts));
        for (const std::string leg : {"leftFront", "rightFront"}) {
            ASSERT_LT(ahead(source, leg), -0.01);
            EXPECT_LT(ahead(target, leg), -0.01) << leg << " in frame " << frame;
        }
    }
}

TEST(RetargetAnimals, NoLegTurnsOverToReachItsFoot) {
    ConstraintRecord narrow, wide;
    narrow.model = static_cast<std::uint8_t>(ConstraintModel::largest_angle);
    narrow.rotation_max = {0.15f, 0.0f, 0.0f};
    wide.model = static_cast<std::uint8_t>(ConstraintModel::hinge);
    wide.rotation_min = {-1.7f, 0.0f, 0.0f};
    wide.rotation_max = {1.9f, 0.0f, 0.0f};
    Animal source(AnimalSpec{});
    Animal target(AnimalSpec{.body = {.axes = 0}, .shoulders = {narrow}, .elbows = {wide}});
    Retarget retargeted = made(source, target);
    RetargetState state;
    const ContactWeights firm{1, 1, 1, 1, 1, 1, 1, 1};
    double missed = 0.0;
    for (int frame = 0; frame < 200; ++frame) {
        source.pose().set_rest();
        for (const std::string leg : {"leftFront", "rightFront"}) {
            source.turn_by(leg + "0", {1, 0, 0}, 40.0 * std::sin(0.06 * frame));
            source.turn_by(leg + "1", {1, 0, 0}, -30.0 * (1.0 - std::cos(0.06 * frame)));
        }
        const auto done = retarget(target.pose(), retargeted, source.pose(), state, firm);
        ASSERT_TRUE(done);
        missed = std::max(missed, double{done->missed});
        for (const std::string leg : {"leftFront", "rightFront"})
            EXPECT_LT(ahead(target, leg), 0.03) << leg << " in frame " << frame;
    }
    EXPECT_GT(missed, 0.01) << "no limit acted";
}

TEST(RetargetAnimals, AnAnimalAtRestStandsOnAllFeet) {
    Animal source(AnimalSpec{});
    Animal target(kHorse);
    Retarget retargeted = made(source, target);
    RetargetState state;
    const auto done = retarget(target.pose(), retargeted, source.pose(), state);
    ASSERT_TRUE(done);
    EXPECT_EQ(done->contacts, (ContactWeights{1, 1, 1, 1, 1, 1, 1, 1}));
    test::local_of(source.pose(), source.joint("rightFront0"))->rotation *= glm::angleAxis(1.0f, glm::vec3(1, 0, 0));
    Animal lifted(AnimalSpec{.body = {.axes = 0}});
    test::local_of(lifted.pose(), lifted.joint("rightFront0"))->rotation *= glm::angleAxis(-1.0f, glm::vec3(1, 0, 0));
    Retarget other = made(lifted, target);
    RetargetState new_state;
    const auto stepping = retarget(target.pose(), other, lifted.pose(), new_state);
    ASSERT_TRUE(stepping);
    EXPECT_EQ(stepping->contacts[static_cast<std::size_t>(Contact::left_front_heel)], 1.0f);
    EXPECT_EQ(stepping->contacts[static_cast<std::size_t>(Contact::right_front_heel)], 0.0f);
}

TEST(RetargetAnimals, PosesOfTheSameBuildAreCopiedBitByBit) {
    Animal source(kHorse);
    AnimalSpec renamed = kHorse;
    renamed.body.prefix = "other_";
    Animal target(renamed);
    Retarget retargeted = made(source, target);
    RetargetState state;
    for (unsigned seed = 0; seed < 10; ++seed) {
        source.pose_at_random(seed, 0.1);
        ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
        const auto from = source.pose().local_blocks();
        const auto to = target.pose().local_blocks();
        EXPECT_EQ(std::memcmp(from.data(), to.data(), from.size_bytes()), 0) << seed;
    }
}

TEST(RetargetAnimals, ThereAndBackIsTheSamePose) {
    Animal source(AnimalSpec{});
    Animal target(AnimalSpec{.body = {.facing = 90.0, .is_z_up = true, .axes = 3},
                             .hind = {0.22, 0.46, 0.37},
                             .hind_leans = {17.0, -31.0, -6.0},
                             .front_leans = {-40.0, 5.0}});
    Animal back(AnimalSpec{});
    Retarget there = made(source, target, kDirections);
    Retarget and_back = made(target, back, kDirections);
    for (unsigned seed = 0; seed < 10; ++seed) {
        source.pose_at_random(seed, 0.3);
        RetargetState state;
        ASSERT_TRUE(retarget(target.pose(), there, source.pose(), state));
        ASSERT_TRUE(retarget(back.pose(), and_back, target.pose(), state));
        for (const JointRole& role : source.model().roles()) {
            EXPECT_LT(angle_of(glm::dquat(source.pose().local(role.joint).rotation),
                               glm::dquat(back.pose().local(role.joint).rotation)),
                      1e-4)
                << source.model().joints()[role.joint].name;
        }
    }
}

TEST(RetargetAnimals, StaysInsideTheTargetsConstraints) {
    ConstraintRecord bend;
    bend.model = static_cast<std::uint8_t>(ConstraintModel::largest_angle);
    bend.rotation_max = {0.2f, 0.0f, 0.0f};
    Animal source(AnimalSpec{});
    AnimalSpec stiff = kHorse;
    stiff.hocks = {bend};
    Animal target(stiff);
    Retarget retargeted = made(source, target);
    RetargetState state;
    bool acted = false;
    for (unsigned seed = 0; seed < 20; ++seed) {
        source.pose_at_random(seed, 0.2);
        const auto done = retarget(target.pose(), retargeted, source.pose(), state);
        ASSERT_TRUE(done);
        acted = acted || done->turned > 0.05f;
        for (const Constraint& constraint : target.model().constraints()) {
            const glm::quat rest = target.model().joints()[constraint.joint].rest.rotation;
            const glm::quat local = target.pose().local(constraint.joint).rotation;
            EXPECT_LT(violation(constraint, to_constraint_space(constraint, rest, local)), 1e-4) << seed;
        }
    }
    EXPECT_TRUE(acted);
}

TEST(RetargetAnimals, AnimalsOnTwoLegsAreOfTheirOwnKind) {
    Animal source(AnimalSpec{.has_front = false});
    Animal target(AnimalSpec{.body = {.axes = 3}, .hind = {0.2, 0.5, 0.3}, .has_front = false, .neck = 4});
    Retarget retargeted = made(source, target, kDirections);
    RetargetState state;
    source.pose_at_random(1, 0.3);
    ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
    EXPECT_LT(worst_direction(source, target), 2e-5);

    const test::Owned human(HumanModel(HumanSpec{}).file());
    const Animal four(kHorse);
    const std::vector<std::tuple<Model, Model, std::string>> pairs{
        {*human, four.model(),
         "the source is a human and the target an animal on four legs: nothing is retargeted between them"},
        {four.model(), source.model(),
         "the source is an animal on four legs and the target an animal on two legs: nothing is retargeted between "
         "them"}};
    for (const auto& [from, to, text] : pairs) {
        const auto refused = Retarget::make(from, to);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().reason, RetargetError::Reason::other_body);
        EXPECT_EQ(error_text(refused.error()), text);
    }
}

TEST(RetargetAnimals, HalfBodiesFollowAsFarAsTheyGo) {
    Animal whole(AnimalSpec{});
    AnimalModel model(AnimalSpec{.body = {.axes = 3}, .trunk = 1.0});
    model.forget({Role::hips, Role::right_hind_leg, Role::left_front_leg});
    test::PosedBody<AnimalModel> half(model, 0.0);
    for (const bool is_source : {false, true}) {
        test::PosedBody<AnimalModel>&source = is_source ? half : whole, &target = is_source ? whole : half;
        Retarget retargeted = made(source, target, kDirections);
        RetargetState state;
        source.pose_at_random(2, 0.2);
        ASSERT_TRUE(retarget(target.pose(), retargeted, source.pose(), state));
        for (const char* leg : {"leftHind", "rightFront"}) {
            const std::string name = leg;
            EXPECT_LT(glm::length(source.way(name + "0", name + "1") - target.way(name + "0", name + "1")), 2e-5)
                << leg;
        }
    }
}

TEST(RetargetAnimals, TakesRolesOfWrongJoints) {
    Animal whole(AnimalSpec{});
    std::vector<RoleRecord> roles(whole.model().roles().begin(), whole.model().roles().end());
    std::mt19937 random(1);
    for (int round = 0; round < 100; ++round) {
        for (std::size_t k = roles.size() - 1; k > 0; --k) {
            const std::size_t other = random() % (k + 1);
            std::swap(roles[k].role, roles[other].role);
            std::swap(roles[k].place, roles[other].place);
        }
        test::ModelSpec spec = AnimalModel(AnimalSpec{}).spec;
        spec.more = {test::make_leaf(FourCC("ROLE"), std::as_bytes(std::span(roles)))};
        const test::Owned odd(test::build_file(spec));
        Pose pose(*odd);
        auto to_odd = Retarget::make(whole.model(), *odd);
        auto from_odd = Retarget::make(*odd, whole.model());
        ASSERT_TRUE(to_odd);
        ASSERT_TRUE(from_odd);
        RetargetState state, back;
        whole.pose_at_random(static_cast<unsigned>(round), 0.3);
        const ContactWeights standing{1, 1, 1, 1, 1, 1, 1, 1};
        EXPECT_TRUE(retarget(pose, *to_odd, whole.pose(), state, standing));
        EXPECT_TRUE(retarget(whole.pose(), *from_odd, pose, back, standing));
        for (const JointTransform& local : test::locals_of(pose))
            EXPECT_TRUE(std::isfinite(local.rotation.x + local.translation.y)) << round;
    }
}

TEST(RetargetAnimals, AllocatesNothing) {
    Animal source(AnimalSpec{});
    Animal target(kHorse);
    Retarget retargeted = made(source, target);
    RetargetState state;
    source.pose_at_random(1, 0.2);
    (void)source.pose().model_space();
    const std::uint64_t before = test::allocations().count;
    bool is_good = true;
    for (int frame = 0; frame < 20; ++frame) {
        test::local_of(source.pose(), source.joint("hips"))->translation.y -= 0.01f;
        is_good = retarget(target.pose(), retargeted, source.pose(), state) && is_good;
    }
    EXPECT_EQ(test::allocations().count - before, 0u);
    EXPECT_TRUE(is_good);
}

}  // namespace
}  // namespace bendy::retarget_animals_test
