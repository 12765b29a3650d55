#include <bendy/format/ik_chain.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace bendy::ik_chain_test {
namespace {

using namespace test;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
const std::string kBack = "HEAD/OBJE/IKCH/KINF";

Node make_chain(std::uint32_t start, std::uint32_t effector) {
    ChainRecord record;
    record.start = start;
    record.effector = effector;
    return make_container(FourCC("IKCH"), {make_leaf(FourCC("KINF"), bytes_of(record))});
}

Node make_chain_weight(std::uint32_t chain, float weight = 1.0f) {
    return make_leaf(FourCC("PULL"), bytes_of(ChainWeightRecord{chain, weight}));
}

/// The faults of the sample with its first chain changed.
Lines faults_with(const std::function<void(ChainRecord&)>& change) {
    Node root = sample();
    edit<ChainRecord>(at(root, kBack), change);
    return faults_in(root);
}

/// The faults of the sample with one more chain.
Lines faults_with_chain(std::uint32_t start, std::uint32_t effector) {
    Node root = sample();
    at(root, "HEAD/OBJE").children.push_back(make_chain(start, effector));
    return faults_in(root);
}

TEST(Chain, AreReadWithTheirWeights) {
    const Loaded sample(sample_file());
    ASSERT_EQ(sample.lines(), Lines{});
    const ObjectView& object = sample.document.objects.at(0);
    ASSERT_EQ(object.chains.size(), 2u);
    const ChainView& back = object.chains[0];
    EXPECT_EQ(back.name, "back");
    EXPECT_EQ(back.extras, "[1]");
    EXPECT_EQ(back.record.start, 0u);
    EXPECT_EQ(back.record.effector, 2u);
    EXPECT_EQ(back.record.target, 3u);
    EXPECT_EQ(back.record.pole, kNone);
    EXPECT_EQ(back.record.solver, static_cast<std::uint8_t>(Solver::fabrik));
    EXPECT_EQ(back.record.iterations, 12);
    EXPECT_EQ(back.record.priority, 7);
    EXPECT_EQ(back.record.pole_angle, -0.5f);
    EXPECT_EQ(back.record.tip_rotation, (std::array{0.0f, 1.0f, 0.0f, 0.0f}));
    EXPECT_EQ(back.record.compress, 0.125f);
    EXPECT_EQ(sample.tree[back.chunk].offset, place_of(sample.file, "HEAD/OBJE/IKCH"));
    EXPECT_EQ(object.chains[1].name, "");
    EXPECT_EQ(object.chains[1].record.pole, 0u);

    const auto& chain_weights = object.skeleton.chain_weights;
    ASSERT_EQ(chain_weights.size(), 2u);
    EXPECT_EQ(chain_weights[0].joint, 0u);
    EXPECT_EQ(chain_weights[0].chain, 0u);
    EXPECT_EQ(chain_weights[0].weight, 0.5f);
    EXPECT_EQ(chain_weights[1].joint, 3u);
    EXPECT_EQ(chain_weights[1].chain, 1u);
}

TEST(Chain, StartsAtTheEffectorOrAboveIt) {
    // hip 0, spine 1, head 2, tail 3: tail is spine's sibling
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> good{{0, 0}, {0, 1}, {0, 2}, {0, 3},
                                                                    {1, 1}, {1, 2}, {2, 2}, {3, 3}};
    for (std::uint32_t start = 0; start < 4; ++start) {
        for (std::uint32_t effector = 0; effector < 4; ++effector) {
            const bool is_good = std::find(good.begin(), good.end(), std::pair(start, effector)) != good.end();
            EXPECT_EQ(faults_with_chain(start, effector),
                      is_good ? Lines{} : Lines{"CHAIN_PATH HEAD/OBJE/IKCH[2]/KINF"})
                << start << " to " << effector;
        }
    }
}

TEST(Chain, WantsJointsThatAreThere) {
    EXPECT_EQ(faults_with([](auto& chain) { chain.start = 4; }), Lines{"JOINT_RANGE " + kBack});
    EXPECT_EQ(faults_with([](auto& chain) { chain.start = kNone; }), Lines{"JOINT_RANGE " + kBack});
    EXPECT_EQ(faults_with([](auto& chain) { chain.effector = 4; }), Lines{"JOINT_RANGE " + kBack});
    EXPECT_EQ(faults_with([](auto& chain) { chain.target = 4; }), Lines{"JOINT_RANGE " + kBack});
    EXPECT_EQ(faults_with([](auto& chain) { chain.pole = kNone - 1; }), Lines{"JOINT_RANGE " + kBack});
    EXPECT_EQ(faults_with([](auto& chain) { chain.start = chain.effector = chain.pole = 4; }),
              Lines(3, "JOINT_RANGE " + kBack));
    EXPECT_EQ(faults_with([](auto& chain) { chain.target = chain.pole = kNone; }), Lines{});
    EXPECT_EQ(faults_with([](auto& chain) { chain.target = chain.pole = 3; }), Lines{});
}

TEST(Chain, RefusesValuesThatItDoesNotKnow) {
    EXPECT_EQ(faults_with([](auto& chain) { chain.solver = kSolvers; }), Lines{"ENUM_RANGE " + kBack});
    EXPECT_EQ(faults_with([](auto& chain) { chain.flags = kChainFlags; }), Lines{"ENUM_RANGE " + kBack});
    EXPECT_EQ(faults_with([](auto& chain) { chain.solver = kSolvers - 1, chain.flags = kChainFlags - 1; }), Lines{});
    for (std::size_t byte = 0; byte < 3; ++byte)
        EXPECT_EQ(faults_with([=](auto& chain) { chain.reserved[byte] = 1; }), Lines{"RESERVED_FIELD " + kBack});
}

TEST(Chain, WantsFiniteNumbers) {
    struct Number {
        std::size_t at;
        const char* code;
    };
    std::vector<Number> numbers;
    for (std::size_t at = offsetof(ChainRecord, tolerance); at < sizeof(ChainRecord); at += sizeof(float)) {
        const char* code = "NOT_FINITE ";
        if (at >= offsetof(ChainRecord, tip_rotation)) code = "ROTATION_NOT_UNIT ";
        if (at >= offsetof(ChainRecord, position_weight)) code = "FRACTION_RANGE ";
        if (at == offsetof(ChainRecord, stretch)) code = "NOT_FINITE ";
        numbers.push_back({at, code});
    }
    ASSERT_EQ(numbers.size(), 17u);
    for (const float bad : {kNaN, kInf, -kInf}) {
        for (const Number& number : numbers) {
            Node root = sample();
            set(at(root, kBack), number.at, bad);
            EXPECT_EQ(faults_in(root), Lines{number.code + kBack}) << number.at;
        }
    }
}

TEST(Chain, HoldsWeightsToTheirRanges) {
    for (const std::size_t at_byte : {offsetof(ChainRecord, position_weight), offsetof(ChainRecord, rotation_weight),
                                      offsetof(ChainRecord, influence), offsetof(ChainRecord, compress)}) {
        for (const float number : {0.0f, 1.0f, -0.001f, 1.001f}) {
            Node root = sample();
            set(at(root, kBack), at_byte, number);
            const Faults faults = validate(to_file(root));
            if (number == 0.0f || number == 1.0f) {
                EXPECT_TRUE(faults.empty());
                continue;
            }
            ASSERT_EQ(faults.list().size(), 1u);
            EXPECT_EQ(faults.list()[0].code, ErrorCode::kFractionRange);
            EXPECT_EQ(faults.list()[0].value, at_byte);  // which of them, as the specification's table counts
        }
    }
    EXPECT_EQ(faults_with([](auto& chain) { chain.stretch = 1000.0f, chain.tolerance = 1000.0f; }), Lines{});
    EXPECT_EQ(faults_with([](auto& chain) { chain.stretch = -0.001f; }), Lines{"BELOW_ZERO " + kBack});
    EXPECT_EQ(faults_with([](auto& chain) { chain.tolerance = -0.001f; }), Lines{"BELOW_ZERO " + kBack});
}

TEST(Chain, WithoutARecordIsMissingThatAndNothingElse) {
    Node root = sample();
    remove(at(root, "HEAD/OBJE/IKCH"), "KINF");
    EXPECT_EQ(faults_in(root), Lines{"CHUNK_MISSING HEAD/OBJE/IKCH"});
    root = sample();
    at(root, kBack).payload.resize(sizeof(ChainRecord) - 1);
    EXPECT_EQ(faults_in(root), Lines{"RECORD_TOO_SHORT " + kBack});
    root = sample();
    remove(at(root, "HEAD/OBJE/SKIN/PIVO"), "REST");  // a fault elsewhere hides no weight
    edit<ChainWeightRecord>(at(root, "HEAD/OBJE/SKIN/PIVO/PULL"), [](auto& chain_weight) { chain_weight.chain = 9; });
    EXPECT_EQ(faults_in(root), (Lines{"CHUNK_MISSING HEAD/OBJE/SKIN/PIVO", "CHAIN_RANGE HEAD/OBJE/SKIN/PIVO/PULL"}));
}

TEST(Chain, TakesWeightsOfItsLinksOnly) {
    // Chain 0 from hip to head; another from spine to head: of that hip is no link, nor is tail.
    const auto faults = [](const std::string& joint, std::uint32_t chain) {
        Node root = sample();
        at(root, "HEAD/OBJE").children.push_back(make_chain(1, 1));
        for (const char* pivot : {"HEAD/OBJE/SKIN/PIVO", "HEAD/OBJE/SKIN/SKIN[1]/PIVO"})
            remove(at(root, pivot), "PULL");
        at(root, joint + "/PIVO").children.push_back(make_chain_weight(chain));
        return faults_in(root);
    };
    const std::string hip = "HEAD/OBJE/SKIN";
    for (const std::string& link : {hip, hip + "/SKIN", hip + "/SKIN/SKIN"})
        EXPECT_EQ(faults(link, 0), Lines{}) << link;
    EXPECT_EQ(faults(hip + "/SKIN[1]", 0), Lines{"CHAIN_WEIGHT_PATH HEAD/OBJE/SKIN/SKIN[1]/PIVO/PULL"});
    EXPECT_EQ(faults(hip + "/SKIN", 2), Lines{});
    EXPECT_EQ(faults(hip, 2), Lines{"CHAIN_WEIGHT_PATH HEAD/OBJE/SKIN/PIVO/PULL"});  // above the start
    EXPECT_EQ(faults(hip + "/SKIN/SKIN", 2),
              Lines{"CHAIN_WEIGHT_PATH HEAD/OBJE/SKIN/SKIN/SKIN/PIVO/PULL"});  // below the effector
    for (const std::uint32_t chain : {3u, kNone})
        EXPECT_EQ(faults(hip, chain), Lines{"CHAIN_RANGE HEAD/OBJE/SKIN/PIVO/PULL"});
}

TEST(Chain, TakesOneWeightOfAJoint) {
    Node root = sample();
    auto& children = at(root, "HEAD/OBJE/SKIN/PIVO").children;
    at(root, "HEAD/OBJE").children.push_back(make_chain(0, 3));
    children.push_back(make_chain_weight(2));
    EXPECT_EQ(faults_in(root), Lines{});
    children.push_back(make_chain_weight(0));
    children.push_back(make_chain_weight(2));
    EXPECT_EQ(faults_in(root), (Lines{"CHAIN_WEIGHT_REPEATED HEAD/OBJE/SKIN/PIVO/PULL[2]",
                                      "CHAIN_WEIGHT_REPEATED HEAD/OBJE/SKIN/PIVO/PULL[3]"}));
}

TEST(Chain, WantsWeightsBetweenNothingAndAll) {
    for (const float good : {0.0f, -0.0f, 1.0f}) {
        Node root = sample();
        edit<ChainWeightRecord>(at(root, "HEAD/OBJE/SKIN/PIVO/PULL"),
                                [=](auto& chain_weight) { chain_weight.weight = good; });
        EXPECT_EQ(faults_in(root), Lines{});
    }
    for (const float bad : {-0.001f, 1.001f, kNaN, kInf, -kInf}) {
        Node root = sample();
        edit<ChainWeightRecord>(at(root, "HEAD/OBJE/SKIN/PIVO/PULL"),
                                [=](auto& chain_weight) { chain_weight.weight = bad; });
        EXPECT_EQ(faults_in(root), Lines{"FRACTION_RANGE HEAD/OBJE/SKIN/PIVO/PULL"});
    }
}

TEST(Chain, WeightsNeedAChain) {
    Node root = sample();
    for (int chain = 0; chain < 2; ++chain) remove(at(root, "HEAD/OBJE"), "IKCH");
    EXPECT_EQ(faults_in(root),
              (Lines{"CHAIN_RANGE HEAD/OBJE/SKIN/PIVO/PULL", "CHAIN_RANGE HEAD/OBJE/SKIN/SKIN[1]/PIVO/PULL"}));
}

TEST(Chain, NeedsJoints) {
    VersionRecord version;
    version.objects = 1;
    Node root = make_container(FourCC("HEAD"), {make_leaf(FourCC("VERS"), bytes_of(version)),
                                                make_container(FourCC("OBJE"), {make_chain(0, 0)})});
    EXPECT_EQ(faults_in(root), Lines(2, "JOINT_RANGE HEAD/OBJE/IKCH/KINF"));
}

TEST(Chain, IsNumberedInItsOwnObject) {
    Node root = sample();
    edit<VersionRecord>(at(root, "HEAD/VERS"), [](auto& version) { version.objects = 2; });
    root.children.push_back(make_container(FourCC("OBJE"), {make_chain(0, 0)}));
    EXPECT_EQ(faults_in(root), Lines(2, "JOINT_RANGE HEAD/OBJE[1]/IKCH/KINF"));
    // Two objects alike: what the second's weights mean are its own chains.
    root = sample();
    root.children.push_back(at(root, "HEAD/OBJE"));
    edit<ChainWeightRecord>(at(root, "HEAD/OBJE[1]/SKIN/PIVO/PULL"),
                            [](auto& chain_weight) { chain_weight.chain = 2; });
    const Loaded loaded(root);
    EXPECT_EQ(loaded.lines(), Lines{"CHAIN_RANGE HEAD/OBJE[1]/SKIN/PIVO/PULL"});
}

/// A rope of joints with chains of the whole length, and a weight in every chain at each of the first joints.
Buffer rope_with_chains(std::uint32_t joints, std::uint32_t chains, std::uint32_t weighted, bool reversed) {
    ChunkWriter writer;
    writer.begin(FourCC("HEAD"));
    VersionRecord version;
    version.objects = 1;
    version.joints = joints;
    writer.leaf(FourCC("VERS"), bytes_of(version));
    writer.begin(FourCC("OBJE"));
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
        writer.begin(FourCC("SKIN"));
        writer.begin(FourCC("PIVO"));
        writer.leaf(FourCC("REST"), bytes_of(RestRecord{}));
        for (std::uint32_t chain = 0; joint < weighted && chain < chains; ++chain)
            writer.leaf(FourCC("PULL"), bytes_of(ChainWeightRecord{chain, 0.5f}));
        writer.end();
    }
    for (std::uint32_t joint = 0; joint < joints; ++joint) writer.end();
    for (std::uint32_t chain = 0; chain < chains; ++chain) {
        ChainRecord record;
        record.effector = joints - 1;
        if (reversed) std::swap(record.start, record.effector);
        writer.begin(FourCC("IKCH"));
        writer.leaf(FourCC("KINF"), bytes_of(record));
        writer.end();
    }
    writer.end();
    writer.end();
    return std::move(writer).finish();
}

// A check that walked along each chain would take minutes here.
TEST(Chain, OfTheLongestRopeAreManyInLinearTime) {
    EXPECT_EQ(faults_in(rope_with_chains(kMaxJoints, 50'000, 2, false)), Lines{});
}

TEST(Chain, OfARopeStartsAboveItsEffector) {
    EXPECT_EQ(faults_in(rope_with_chains(100, 1, 1, true)), Lines{"CHAIN_PATH HEAD/OBJE/IKCH/KINF"});
}

TEST(Chain, OfAFanHasNoSiblings) {
    constexpr std::uint32_t kChildren = 1'000;
    Node pivot = make_container(FourCC("PIVO"), {make_leaf(FourCC("REST"), bytes_of(RestRecord{}))});
    Node joint = make_container(FourCC("SKIN"), {pivot});
    Node hub = joint;
    hub.children.insert(hub.children.end(), kChildren, joint);
    Node object = make_container(FourCC("OBJE"), {hub});
    for (std::uint32_t child = 1; child <= kChildren; ++child) object.children.push_back(make_chain(0, child));
    object.children.push_back(make_chain(1, kChildren));
    VersionRecord version;
    version.objects = 1;
    version.joints = kChildren + 1;
    const Node root = make_container(FourCC("HEAD"), {make_leaf(FourCC("VERS"), bytes_of(version)), object});
    EXPECT_EQ(faults_in(root), Lines{"CHAIN_PATH HEAD/OBJE/IKCH[1000]/KINF"});
}

}  // namespace
}  // namespace bendy::ik_chain_test
