#include "optimise/passes/auto_skin.h"

#include "gltf/build_gltf.h"
#include "posed_scene.h"
#include "rig/build_scene.h"
#include "scene/evaluate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace bendy::converter::auto_skin_test {
namespace {

using test::JointPlan;
using test::make_scene;
using Point = std::array<double, 3>;

// --- the same worked out otherwise: points carried up the hierarchy one by one, bones searched in small steps

Point rotated(const glm::vec4& q, const Point& p) {
    const Point axis{q.x, q.y, q.z};
    const auto cross = [](const Point& a, const Point& b) {
        return Point{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const Point once = cross(axis, p);
    const Point twice = cross(axis, once);
    Point result{};
    for (std::size_t i = 0; i < 3; ++i) result[i] = p[i] + 2.0 * (double{q.w} * once[i] + twice[i]);
    return result;
}

/// A point in a joint's space as one of model space.
Point in_model(const Scene& scene, std::uint32_t joint, Point p) {
    for (; joint != kNone; joint = scene.joints[joint].parent) {
        const Transform& rest = scene.joints[joint].rest;
        p = {p[0] * double{rest.scale.x} + p[1] * double{rest.shear.x} + p[2] * double{rest.shear.y},
             p[1] * double{rest.scale.y} + p[2] * double{rest.shear.z}, p[2] * double{rest.scale.z}};
        p = rotated(rest.rotation, p);
        for (int i = 0; i < 3; ++i) p[static_cast<std::size_t>(i)] += double{rest.translation[i]};
    }
    return p;
}

/// Along a line the distance falls, then rises: thirds are cut away until nothing is left.
double distance_to_line(const Point& p, const Point& a, const Point& b) {
    const auto at = [&](double share) {
        double sum = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            const double apart = a[i] + share * (b[i] - a[i]) - p[i];
            sum += apart * apart;
        }
        return std::sqrt(sum);
    };
    double low = 0.0;
    double high = 1.0;
    for (int step = 0; step < 60; ++step) {
        const double third = (high - low) / 3.0;
        (at(low + third) < at(high - third) ? high : low) =
            at(low + third) < at(high - third) ? high - third : low + third;
    }
    return std::min({at(low), at(0.0), at(1.0)});
}

/// Distance from a point of model space to the nearest bone of each joint of a skeleton; infinite for other joints.
std::vector<double> distances(const Scene& scene, const std::vector<bool>& skeleton, const Point& p) {
    std::vector<double> found(scene.joints.size(), INFINITY);
    std::vector<bool> has_child(scene.joints.size());
    const auto place = [&](std::uint32_t joint) { return in_model(scene, joint, {0.0, 0.0, 0.0}); };
    for (std::uint32_t child = 0; child < scene.joints.size(); ++child) {
        const std::uint32_t parent = scene.joints[child].parent;
        if (!skeleton[child] || parent == kNone || !skeleton[parent]) continue;
        has_child[parent] = true;
        found[parent] = std::min(found[parent], distance_to_line(p, place(parent), place(child)));
    }
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        if (!skeleton[joint] || has_child[joint]) continue;
        const std::uint32_t parent = scene.joints[joint].parent;
        const Point start = place(joint);
        Point end = start;
        for (std::size_t i = 0; i < 3 && parent != kNone && skeleton[parent]; ++i)
            end[i] += (start[i] - place(parent)[i]) / 2.0;
        found[joint] = distance_to_line(p, start, end);
    }
    return found;
}

/// How many vertices are bound to another joint than that calculation says. Where the two nearest joints are equally
/// far but for rounding, it takes either.
std::size_t count_wrong(const Scene& scene, const std::vector<bool>& skeleton, const Mesh& mesh) {
    std::size_t wrong = 0;
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        const glm::vec3& position = mesh.positions[vertex];
        const auto all = distances(scene, skeleton, in_model(scene, mesh.joint, {position.x, position.y, position.z}));
        const double least = *std::min_element(all.begin(), all.end());
        const double ours = all[mesh.palette.joints[mesh.bones[vertex]]];
        if (!(ours <= least + 1e-7)) ++wrong;
    }
    return wrong;
}

Joint random_joint(test::Numbers& numbers, std::uint32_t parent) {
    Joint joint;
    joint.parent = parent;
    joint.rest.translation = numbers.vector(1.0f);
    joint.rest.rotation = numbers.rotation();
    joint.rest.scale = glm::vec3(1.0f) + numbers.vector(0.2f);
    joint.rest.shear = numbers.vector(0.1f);
    return joint;
}

/// A root, a branching tree of 30 bones below it, and beside that a turned node with a mesh of 100 vertices.
Scene random_character(std::uint32_t seed) {
    test::Numbers numbers(seed);
    Scene scene;
    scene.joints.push_back(random_joint(numbers, kNone));
    for (std::uint32_t joint = 1; joint <= 30; ++joint)
        scene.joints.push_back(
            random_joint(numbers, joint == 1 ? 0 : joint - 1 - numbers.below(std::min(joint - 1, 3u))));
    for (std::uint32_t joint = 1; joint <= 30; ++joint) scene.joints[joint].in_skin = true;
    scene.joints.push_back(random_joint(numbers, 0));
    Mesh mesh;
    mesh.name = "body";
    mesh.joint = 31;
    for (int vertex = 0; vertex < 100; ++vertex) mesh.positions.push_back(numbers.vector(4.0f));
    scene.meshes.push_back(mesh);
    return scene;
}

/// A row of three joints a metre apart, and a node beside it with a mesh of these vertices.
Scene row_with_mesh(std::vector<glm::vec3> positions) {
    Scene scene = make_scene({{"root"}, {"arm", 0, {0, 1, 0}}, {"hand", 1, {0, 1, 0}}, {"holder"}});
    Mesh mesh;
    mesh.joint = 3;
    mesh.positions = std::move(positions);
    scene.meshes.push_back(mesh);
    return scene;
}

std::vector<std::uint32_t> joints_of(const Mesh& mesh) {
    std::vector<std::uint32_t> joints;
    for (const std::uint32_t bone : mesh.bones) joints.push_back(mesh.palette.joints[bone]);
    return joints;
}

/// Binds what must bind: warnings, then what is proposed.
std::vector<std::string> bind(Scene& scene, const std::string& skeleton = {}) {
    Report report;
    const auto bound = auto_skin(scene, skeleton, report);
    std::vector<std::string> lines = test::lines_of(report);
    if (!bound) lines.push_back("error: " + bound.error().message);
    for (const Proposal& proposal : report.proposals()) lines.push_back(proposal.line);
    return lines;
}

using Lines = std::vector<std::string>;
const std::string kNoSkeleton =
    ": no vertices bound: the file has no skeleton; --skeleton takes a joint and all below it";

TEST(AutoSkin, EveryVertexGoesToTheNearestBone) {
    for (const std::uint32_t seed : {1u, 2u}) {
        Scene scene = random_character(seed);
        std::vector<bool> skeleton(scene.joints.size(), true);
        skeleton.front() = skeleton.back() = false;
        const Lines lines = bind(scene);
        const Mesh& mesh = scene.meshes[0];
        ASSERT_EQ(mesh.influences, 1u);
        ASSERT_EQ(mesh.bones.size(), mesh.positions.size());
        EXPECT_EQ(mesh.weights, std::vector<float>(mesh.positions.size(), 1.0f));
        EXPECT_EQ(count_wrong(scene, skeleton, mesh), 0u);
        EXPECT_GT(mesh.palette.joints.size(), 10u);
        EXPECT_EQ(lines, Lines{"skin of mesh 'body': 100 vertices bound to " +
                               std::to_string(mesh.palette.joints.size()) + " joints"});
        // That calculation can tell.
        Mesh turned = mesh;
        std::rotate(turned.bones.begin(), turned.bones.begin() + 1, turned.bones.end());
        EXPECT_GT(count_wrong(scene, skeleton, turned), 50u);
    }
}

TEST(AutoSkin, TheRestPoseStaysAsItIs) {
    Scene scene = random_character(4);
    const Mesh before = scene.meshes[0];
    bind(scene);
    EvaluatedPose pose;
    evaluate_rest(scene, pose);
    const auto vertices = evaluate_vertices(scene.meshes[0], {}, pose.joints);
    for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
        const glm::vec3& p = before.positions[vertex];
        const Point there = in_model(scene, before.joint, {p.x, p.y, p.z});
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(vertices[vertex][i], there[static_cast<std::size_t>(i)], 1e-4);
    }
}

TEST(AutoSkin, ABoneWithoutChildrenGoesOnHalfAsFar) {
    Scene scene = row_with_mesh({{0, -1, 0}, {1, 0.5f, 0}, {0.1f, 1.9f, 0}, {0.1f, 2.1f, 0}, {0, 9, 0}});
    EXPECT_EQ(bind(scene), Lines{"skin of mesh #0: 5 vertices bound to 3 joints"});
    EXPECT_EQ(joints_of(scene.meshes[0]), (std::vector<std::uint32_t>{0, 0, 1, 2, 2}));
}

TEST(AutoSkin, OfBonesEquallyNearTheLowerJointIsTaken) {
    Scene scene = row_with_mesh({{1, 1, 0}, {0, 2, 3}, {0, 1, 0}});  // beside the places where two bones meet
    bind(scene);
    EXPECT_EQ(joints_of(scene.meshes[0]), (std::vector<std::uint32_t>{0, 1, 0}));
    scene = make_scene(
        {{"root"}, {"left", 0, {-1, 0, 0}}, {"l", 1, {0, 1, 0}}, {"right", 0, {1, 0, 0}}, {"r", 3, {0, 1, 0}}});
    for (std::size_t joint = 1; joint < 5; ++joint) scene.joints[joint].in_skin = true;
    Mesh mesh;
    mesh.positions = {{0, 0.5f, 0}, {0, -7, 0}, {0, 1.25f, 2}};
    scene.meshes.push_back(mesh);
    bind(scene);
    EXPECT_EQ(joints_of(scene.meshes[0]), (std::vector<std::uint32_t>{1, 1, 2}));
}

TEST(AutoSkin, WhatHasASkinOrHangsOnABoneStays) {
    Scene scene = random_character(5);
    Mesh sword;
    sword.joint = 30;
    sword.positions.resize(3);
    Mesh worn = sword;
    worn.joint = 31;
    worn.influences = 1;
    worn.bones = {0, 0, 0};
    worn.weights = {1, 1, 1};
    worn.palette = {{7}, {glm::mat4(1.0f)}};
    Scene as_it_was = scene;
    scene.meshes = {sword, worn};
    EXPECT_EQ(bind(scene), Lines{": no vertices bound: every mesh has a skin or hangs on a joint of the skeleton"});
    EXPECT_EQ(scene.meshes[0].influences, 0u);
    EXPECT_EQ(scene.meshes[1].palette.joints, std::vector<std::uint32_t>{7});
    scene.meshes.push_back(as_it_was.meshes[0]);
    EXPECT_EQ(bind(scene).size(), 1u);
    EXPECT_EQ(scene.meshes[0].influences, 0u);
    EXPECT_EQ(scene.meshes[2].influences, 1u);
}

TEST(AutoSkin, TheSkeletonIsTheSkinsOrWhatCarriesNoMeshOrWhatIsNamed) {
    // An armature as Blender exports it: the body hangs beside the bones, below the same node.
    const std::vector<JointPlan> plans{{"Armature"}, {"Hips", 0, {0, 1, 0}}, {"Spine", 1, {0, 1, 0}}, {"Body", 0}};
    Scene scene = make_scene(plans);
    Mesh mesh;
    mesh.joint = 3;
    mesh.positions = {{0, 0, 0}, {0, 5, 0}};  // at the armature's own place, and above
    scene.meshes = {mesh};
    bind(scene);
    EXPECT_EQ(joints_of(scene.meshes[0]), (std::vector<std::uint32_t>{1, 2}));

    scene = make_scene(plans);  // only one joint is in a skin
    scene.joints[2].in_skin = true;
    scene.meshes = {mesh};
    bind(scene);
    EXPECT_EQ(joints_of(scene.meshes[0]), (std::vector<std::uint32_t>{2, 2}));

    for (const char* name : {"Hips", "#1"}) {
        scene.meshes = {mesh};
        bind(scene, name);
        EXPECT_EQ(joints_of(scene.meshes[0]), (std::vector<std::uint32_t>{1, 2})) << name;
    }
    scene.meshes = {mesh};
    EXPECT_EQ(bind(scene, "Armature"),
              Lines{": no vertices bound: every mesh has a skin or hangs on a joint of the skeleton"});
    EXPECT_EQ(bind(scene, "Tail"),
              Lines{"error: there is no joint \"Tail\"; there are \"Armature\", \"Hips\", \"Spine\" and \"Body\""});
}

TEST(AutoSkin, WithoutASkeletonItWarns) {
    Scene scene = make_scene({{"only"}});
    Mesh mesh;
    mesh.joint = 0;
    mesh.positions.resize(3);
    scene.meshes = {mesh};
    EXPECT_EQ(bind(scene), Lines{kNoSkeleton});
    EXPECT_EQ(scene.meshes[0].influences, 0u);
}

/// A box of a width, from one height to another above its joint.
Mesh box_on(std::uint32_t joint, float low, float high, float width) {
    Mesh mesh;
    mesh.joint = joint;
    for (const float y : {low, 0.5f * (low + high), high}) {
        for (const float x : {-width, width})
            mesh.positions.insert(mesh.positions.end(), {{x, y, -width}, {x, y, width}});
    }
    return mesh;
}

/// A body, and three parts a metre apart, as in the paper: each carries the next.
Scene body_with_parts(float width) {
    Scene scene =
        make_scene({{"Body"}, {"upper"}, {"lower", 1, {0, 1, 0}}, {"hand", 2, {0, 1, 0}}, {"tip", 3, {0, 1, 0}}});
    scene.meshes.push_back(box_on(0, 0.0f, 3.0f, width));
    for (std::uint32_t joint = 1; joint <= 3; ++joint) scene.meshes.push_back(box_on(joint, 0.05f, 0.95f, 0.1f));
    return scene;
}

TEST(AutoSkin, PartMeshesInsideTheSkinAreItsBones) {
    Scene scene = body_with_parts(0.3f);
    EXPECT_EQ(bind(scene),
              (Lines{": the skin is bound to the 4 joints whose part meshes lie inside it; --skeleton takes others",
                     "skin of mesh #0: 12 vertices bound to 3 joints"}));
    EXPECT_EQ(joints_of(scene.meshes[0]), (std::vector<std::uint32_t>{1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3}));
    for (std::size_t part = 1; part <= 3; ++part) EXPECT_EQ(scene.meshes[part].influences, 0u);
}

TEST(AutoSkin, PartsThatTheOtherMeshesDoNotEncloseAreNoBones) {
    Scene scene = body_with_parts(0.05f);
    scene.joints.pop_back();
    EXPECT_EQ(bind(scene), Lines{kNoSkeleton});
    EXPECT_EQ(scene.meshes[0].influences, 0u);
    scene = make_scene({{"Body"}, {"alone"}});  // one part is no hierarchy
    scene.meshes = {box_on(0, 0.0f, 3.0f, 0.3f), box_on(1, 0.05f, 0.95f, 0.1f)};
    EXPECT_EQ(bind(scene), Lines{kNoSkeleton});
    scene = body_with_parts(0.3f);  // a proper skeleton goes first
    scene.joints.push_back(make_scene({{"Hips"}}).joints[0]);
    EXPECT_EQ(bind(scene).front(), "skin of mesh #0: 12 vertices bound to 2 joints");
}

TEST(AutoSkin, JointsWithoutVolumeCarryNothing) {
    Scene scene = row_with_mesh({{0, 0.5f, 0}, {0, 1.5f, 0}});
    scene.joints[2].rest.scale = glm::vec3(0.0f);
    bind(scene);
    EXPECT_EQ(joints_of(scene.meshes[0]), (std::vector<std::uint32_t>{0, 1}));
    scene = row_with_mesh({{0, 0.5f, 0}});
    scene.joints[0].rest.scale = glm::vec3(0.0f);
    EXPECT_EQ(bind(scene), Lines{kNoSkeleton});
}

TEST(AutoSkin, TooMuchWorkIsRefused) {
    Scene scene;
    scene.joints.resize(100'000);
    for (Joint& joint : scene.joints) joint.in_skin = true;
    Mesh mesh;
    mesh.positions.resize(90'000);
    scene.meshes = {mesh};
    EXPECT_EQ(bind(scene), Lines{"error: 90000 vertices and 100000 bones are too many to find the nearest"});
}

TEST(AutoSkin, JointsOfASkinAreKnownThoughNoVertexFollowsThem) {
    const auto import =
        test::import_text(R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,3]}],"skins":[{"joints":[1,2]}],)"
                          R"("nodes":[{"children":[1]},{"children":[2]},{},{}]})");
    std::vector<bool> in_skin;
    for (const Joint& joint : import->joints) in_skin.push_back(joint.in_skin);
    EXPECT_EQ(in_skin, (std::vector<bool>{false, true, true, false}));
}

}  // namespace
}  // namespace bendy::converter::auto_skin_test
