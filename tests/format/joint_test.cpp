#include <bendy/format/joint.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace bendy::joint_test {
namespace {

using namespace test;

Node make_joint(std::vector<Node> more = {}) {
    Node joint = make_container(FourCC("SKIN"),
                                {make_container(FourCC("PIVO"), {make_leaf(FourCC("REST"), bytes_of(RestRecord{}))})});
    for (Node& node : more) joint.children.push_back(std::move(node));
    return joint;
}

TEST(Skeleton, NumbersJointsInPreOrder) {
    const Loaded sample(sample_file());
    ASSERT_EQ(sample.lines(), Lines{});
    const SkeletonView& skeleton = sample.document.objects.at(0).skeleton;
    std::vector<std::string> names;
    std::vector<std::uint32_t> parents;
    for (const JointView& joint : skeleton.joints) {
        names.emplace_back(joint.name);
        parents.push_back(joint.parent);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"hip", "spine", "head", "tail \xc3\xa9"}));
    EXPECT_EQ(parents, (std::vector<std::uint32_t>{kNone, 0, 1, 0}));
    EXPECT_EQ(skeleton.joints[0].extras, "{\"mass\":3}");
    EXPECT_EQ(skeleton.joints[1].extras, "");
    EXPECT_EQ(skeleton.joints[2].rest.translation[1], 0.25f);
    EXPECT_EQ(skeleton.joints[3].extensions, "{\"KHR_y\":[]}");
    EXPECT_EQ(skeleton.joints[0].extensions, "");
}

TEST(Skeleton, TakesSeveralRoots) {
    Node root = sample();
    at(root, "HEAD/OBJE").children.push_back(make_joint({make_joint()}));
    at(root, "HEAD/OBJE").children.push_back(make_joint());
    edit<VersionRecord>(at(root, "HEAD/VERS"), [](auto& version) { version.joints = 7; });
    EXPECT_EQ(faults_in(root), Lines{});
    const Loaded loaded(root);
    std::vector<std::uint32_t> parents;
    for (const JointView& joint : loaded.document.objects.at(0).skeleton.joints) parents.push_back(joint.parent);
    EXPECT_EQ(parents, (std::vector<std::uint32_t>{kNone, 0, 1, 0, kNone, 4, kNone}));
}

TEST(Skeleton, GivesPolygonsToTheJointThatHoldsThem) {
    const Loaded sample(sample_file());
    struct Expected {
        std::uint32_t joint, mesh, first, count;
        Topology topology;
    };
    const std::vector<Expected> expected{{0, 0, 0, 3, Topology::triangles},
                                         {1, 0, 3, 3, Topology::triangles},
                                         {1, 1, 5, 1, Topology::points},
                                         {2, 1, 0, 3, Topology::triangles},
                                         {2, 1, 3, 2, Topology::lines}};
    const auto& submeshes = sample.document.objects.at(0).skeleton.submeshes;
    ASSERT_EQ(submeshes.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(submeshes[i].joint, expected[i].joint) << i;
        EXPECT_EQ(submeshes[i].mesh, expected[i].mesh) << i;
        EXPECT_EQ(submeshes[i].first, expected[i].first) << i;
        EXPECT_EQ(submeshes[i].count, expected[i].count) << i;
        EXPECT_EQ(submeshes[i].topology, expected[i].topology) << i;
    }
}

TEST(Skeleton, GivesPolygonsAfterAChildToTheParent) {
    Node root = sample();
    Node& hip = at(root, "HEAD/OBJE/SKIN");
    const Node polygons = child(hip, "POLY");
    remove(hip, "POLY");
    hip.children.push_back(polygons);  // behind the two joints in it
    EXPECT_EQ(faults_in(root), Lines{});
    const Loaded loaded(root);
    EXPECT_EQ(loaded.document.objects.at(0).skeleton.submeshes.back().joint, 0u);
}

TEST(Skeleton, KeepsLocalMaterialsByJoint) {
    Node root = sample();
    Node& spine = at(root, "HEAD/OBJE/SKIN/SKIN");
    const Node material = at(root, "HEAD/OBJE/SKIN/MATE");
    spine.children.insert(spine.children.begin(), {material, material});
    edit<VersionRecord>(at(root, "HEAD/VERS"), [](auto& version) { version.materials = 4; });
    edit<SubmeshRecord>(at(root, "HEAD/OBJE/SKIN/SKIN/POLY"),
                        [](auto& submesh) { submesh.material = kLocalMaterial | 1u; });
    EXPECT_EQ(faults_in(root), Lines{});
    const Loaded loaded(root);
    const SkeletonView& skeleton = loaded.document.objects.at(0).skeleton;
    EXPECT_EQ(skeleton.local_materials.size(), 3u);
    EXPECT_EQ(skeleton.first_local_material, (std::vector<std::uint32_t>{0, 1, 3, 3}));
}

TEST(Skeleton, RefusesALocalMaterialAfterAJoint) {
    Node root = sample();
    Node& hip = at(root, "HEAD/OBJE/SKIN");
    hip.children.push_back(child(hip, "MATE"));
    EXPECT_EQ(Loaded(root).lines(), Lines{"CHUNK_MISPLACED HEAD/OBJE/SKIN/MATE[1]"});
}

TEST(Skeleton, IgnoresJointsThatStandElsewhere) {
    Node root = sample();
    at(root, "HEAD/OBJE/SKIN/PIVO").children.push_back(make_joint());
    at(root, "HEAD/OBJE/VECT").children.push_back(make_joint());
    const Loaded loaded(root);
    EXPECT_EQ(loaded.document.objects.at(0).skeleton.joints.size(), 4u);
    EXPECT_EQ(loaded.lines(),
              (Lines{"CHUNK_MISPLACED HEAD/OBJE/SKIN/PIVO/SKIN", "CHUNK_MISPLACED HEAD/OBJE/VECT/SKIN"}));
}

TEST(Skeleton, RefusesATopologyItDoesNotKnow) {
    Node root = sample();
    edit<SubmeshRecord>(at(root, "HEAD/OBJE/SKIN/POLY"), [](auto& submesh) { submesh.topology = kTopologies; });
    EXPECT_EQ(faults_in(root), Lines{"ENUM_RANGE HEAD/OBJE/SKIN/POLY"});
}

TEST(Skeleton, WantsWholePolygons) {
    const auto faults = [](const char* path, std::uint32_t count) {
        Node root = sample();
        edit<SubmeshRecord>(at(root, path), [=](auto& submesh) { submesh.count = count; });
        return faults_in(root);
    };
    const std::string triangles = "HEAD/OBJE/SKIN/POLY";
    const std::string lines = "HEAD/OBJE/SKIN/SKIN/SKIN/POLY[1]";
    for (const std::uint32_t count : {0u, 3u}) EXPECT_EQ(faults(triangles.c_str(), count), Lines{}) << count;
    for (const std::uint32_t count : {1u, 2u, 4u, 5u})
        EXPECT_EQ(faults(triangles.c_str(), count), Lines{"POLYGON_CUT " + triangles}) << count;
    EXPECT_EQ(faults(lines.c_str(), 1), Lines{"POLYGON_CUT " + lines});
    EXPECT_EQ(faults(lines.c_str(), 0), Lines{});
}

TEST(Skeleton, RefusesReservedBytesOfPolygons) {
    for (std::size_t byte = 0; byte < 3; ++byte) {
        Node root = sample();
        edit<SubmeshRecord>(at(root, "HEAD/OBJE/SKIN/POLY"), [=](auto& submesh) { submesh.reserved[byte] = 1; });
        EXPECT_EQ(faults_in(root), Lines{"RESERVED_FIELD HEAD/OBJE/SKIN/POLY"});
    }
}

TEST(Skeleton, RefusesARestTransformThatIsNotFinite) {
    const auto faults = [](std::size_t number, float value) {
        Node root = sample();
        set(at(root, "HEAD/OBJE/SKIN/SKIN[1]/PIVO/REST"), number * sizeof(float), value);
        return faults_in(root);
    };
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()}) {
        for (std::size_t number = 0; number < 4; ++number)
            EXPECT_EQ(faults(number, bad), Lines{"ROTATION_NOT_UNIT HEAD/OBJE/SKIN/SKIN[1]/PIVO/REST"}) << number;
        for (std::size_t number = 4; number < 13; ++number)
            EXPECT_EQ(faults(number, bad), Lines{"NOT_FINITE HEAD/OBJE/SKIN/SKIN[1]/PIVO/REST"}) << number;
    }
}

TEST(Skeleton, WantsRotationsOfUnitLength) {
    const auto faults = [](float w) {
        Node root = sample();
        edit<RestRecord>(at(root, "HEAD/OBJE/SKIN/PIVO/REST"), [w](auto& rest) { rest.rotation = {0, 0, 0, w}; });
        return faults_in(root);
    };
    EXPECT_EQ(faults(-1.0f), Lines{});
    EXPECT_EQ(faults(1.00009f), Lines{});
    EXPECT_EQ(faults(0.99991f), Lines{});
    EXPECT_EQ(faults(1.00011f), Lines{"ROTATION_NOT_UNIT HEAD/OBJE/SKIN/PIVO/REST"});
    EXPECT_EQ(faults(0.99989f), Lines{"ROTATION_NOT_UNIT HEAD/OBJE/SKIN/PIVO/REST"});
    EXPECT_EQ(faults(0.0f), Lines{"ROTATION_NOT_UNIT HEAD/OBJE/SKIN/PIVO/REST"});
}

TEST(Skeleton, TakesNegativeAndZeroScales) {
    Node root = sample();
    edit<RestRecord>(at(root, "HEAD/OBJE/SKIN/PIVO/REST"), [](auto& rest) { rest.scale = {-1, 0, 1}; });
    EXPECT_EQ(faults_in(root), Lines{});
}

TEST(Skeleton, ReadsARestTransformWithoutShear) {
    Node root = sample();
    Node& rest = at(root, "HEAD/OBJE/SKIN/PIVO/REST");
    rest.payload.resize(offsetof(RestRecord, shear));
    EXPECT_EQ(faults_in(root), Lines{});
    rest.payload.pop_back();
    EXPECT_EQ(faults_in(root), Lines{"RECORD_TOO_SHORT HEAD/OBJE/SKIN/PIVO/REST"});
}

TEST(Skeleton, ReadsARopeOfTenThousandJoints) {
    constexpr std::uint32_t kJoints = 10'000;
    const Loaded loaded(rope_file(kJoints));
    EXPECT_TRUE(validate(loaded.file).empty());
    EXPECT_TRUE(loaded.faults.empty());
    const auto& joints = loaded.document.objects.at(0).skeleton.joints;
    ASSERT_EQ(joints.size(), kJoints);
    EXPECT_EQ(joints[0].parent, kNone);
    for (std::uint32_t joint = 1; joint < kJoints; ++joint) ASSERT_EQ(joints[joint].parent, joint - 1);
}

// A walk that is not linear in the joints would take minutes here.
TEST(Skeleton, ReadsTheLongestRopeAndRefusesALongerOne) {
    EXPECT_TRUE(validate(rope_file(kMaxJoints)).empty());
    const Buffer longer = rope_file(kMaxJoints + 1);
    EXPECT_EQ(faults_in(longer), Lines{"TOO_MANY_JOINTS HEAD/OBJE"});
    // HEAD, OBJE and PIVO are levels too.
    const Faults too_many = validate(rope_file(kMaxDepth - 3));
    EXPECT_EQ(too_many.list().at(0).code, ErrorCode::kTooManyJoints);
    const Faults too_deep = validate(rope_file(kMaxDepth - 2));
    ASSERT_EQ(too_deep.list().size(), 1u);
    EXPECT_EQ(too_deep.list()[0].code, ErrorCode::kTooDeep);
}

TEST(Skeleton, ReadsAWideFanOfJoints) {
    Node root = make_container(FourCC("HEAD"));
    VersionRecord version;
    version.objects = 1;
    version.joints = 20'001;
    root.children = {make_leaf(FourCC("VERS"), bytes_of(version)),
                     make_container(FourCC("OBJE"), {make_joint(std::vector<Node>(20'000, make_joint()))})};
    EXPECT_EQ(faults_in(root), Lines{});
}

}  // namespace
}  // namespace bendy::joint_test
