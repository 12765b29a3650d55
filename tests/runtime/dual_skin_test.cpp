
#include <bendy/runtime/kernels.h>
#include <bendy/runtime/skin.h>

#include "runtime/build_model.h"
#include "runtime/limb_model.h"
#include "runtime/local_joints.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace bendy::dual_skin_test {
namespace {

using test::Owned;

struct Skinned {
    explicit Skinned(std::size_t vertices) : positions(vertices), normals(vertices), tangents(vertices) {}
    [[nodiscard]] Vertices all() { return {positions, normals, tangents}; }
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> tangents;
};

Skinned linear(const Model& model, Pose& pose) {
    Skinned out(model.vertex_count());
    EXPECT_TRUE(skin(pose, {.out = out.all()}));
    return out;
}

Skinned dual(const Model& model, Pose& pose) {
    Skinned out(model.vertex_count());
    EXPECT_TRUE(skin(pose, {.method = SkinningMethod::dual_quaternion, .out = out.all()}));
    return out;
}

std::vector<Skinned> dual_by_every_kernel(const Model& model, Pose& pose) {
    const Kernel before = kernel();
    std::vector<Skinned> all;
    for (const Kernel each : kernels()) {
        EXPECT_TRUE(set_kernel(each));
        all.push_back(dual(model, pose));
    }
    EXPECT_TRUE(set_kernel(before));
    return all;
}

void expect_near(const glm::vec3& is, const glm::dvec3& expected, double tolerance) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(is[c], expected[c], tolerance) << "component " << c;
}

void expect_same(const Skinned& is, const Skinned& expected, double tolerance) {
    for (std::size_t v = 0; v < is.positions.size(); ++v) {
        expect_near(is.positions[v], expected.positions[v], tolerance);
        expect_near(is.normals[v], expected.normals[v], tolerance);
        expect_near(glm::vec3(is.tangents[v]), glm::dvec3(glm::vec3(expected.tangents[v])), tolerance);
        EXPECT_EQ(is.tangents[v].w, expected.tangents[v].w);
    }
}

/// A tube of radius 1 along y, from joint 0 at y = 0 to joint 1 at y = `length`; weights go over evenly.
struct Tube {
    static constexpr std::size_t kRings = 9;
    static constexpr std::size_t kSides = 8;
    /// Of the way along the tube.
    static double share(std::size_t vertex) {
        const std::size_t ring = vertex / kSides;
        return static_cast<double>(ring) / (kRings - 1);
    }
    explicit Tube(float length) {
        spec.joints.resize(2);
        spec.joints[1] = {0, test::moved(0, length, 0), {}, ""};
        test::MeshSpec mesh;
        std::vector<std::uint8_t> bones;
        std::vector<float> weights;
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            const float share = static_cast<float>(ring) / (kRings - 1);
            for (std::size_t side = 0; side < kSides; ++side) {
                const double angle = 2.0 * M_PI * static_cast<double>(side) / kSides;
                const glm::vec3 out(std::cos(angle), 0.0, std::sin(angle));
                mesh.positions.push_back(out + glm::vec3(0, share * length, 0));
                mesh.normals.push_back(out);
                mesh.tangents.emplace_back(0, 1, 0, side % 2 == 0 ? 1 : -1);
                bones.insert(bones.end(), {0, 1});
                weights.insert(weights.end(), {1.0f - share, share});
            }
        }
        glm::mat4 down(1.0f);
        down[3] = {0, -length, 0, 1};
        mesh.more = {test::make_leaf(FourCC("BONE"), test::stream_payload<std::uint8_t>(2, bones)),
                     test::make_leaf(FourCC("WGHT"), test::stream_payload<float>(2, weights)),
                     test::palette_leaf({0, 1}, {glm::mat4(1.0f), down})};
        spec.meshes = {mesh};
    }
    test::ModelSpec spec;
};

TEST(DualSkin, ATwistKeepsTheRadius) {
    const Owned model(test::build_file(Tube(4.0f).spec));
    Pose pose(*model);
    for (const double degrees : {90.0, -150.0, 179.0}) {
        const double half = degrees * M_PI / 360.0;
        test::local_of(pose, 1)->rotation =
            glm::quat(static_cast<float>(std::cos(half)), 0, static_cast<float>(std::sin(half)), 0);
        const Skinned by_dual = dual(*model, pose);
        const Skinned by_linear = linear(*model, pose);
        for (std::size_t v = 0; v < by_dual.positions.size(); ++v) {
            const glm::dvec3 p(by_dual.positions[v]);
            EXPECT_NEAR(std::hypot(p.x, p.z), 1.0, 1e-6);
            EXPECT_NEAR(p.y, 4.0 * Tube::share(v), 1e-6);
            expect_near(by_dual.normals[v], {p.x, 0.0, p.z}, 1e-6);
        }
        // The middle ring: half of each joint's place, cos of half the angle away from the axis.
        const glm::dvec3 thin(by_linear.positions[4 * Tube::kSides]);
        EXPECT_NEAR(std::hypot(thin.x, thin.z), std::abs(std::cos(half)), 1e-5);
        EXPECT_LT(std::hypot(thin.x, thin.z), 0.75);
        // Evenly mixed, the middle ring turns by half.
        const glm::dvec3 middle(by_dual.positions[4 * Tube::kSides]);
        EXPECT_NEAR(middle.x, std::cos(half), 1e-5);
        EXPECT_NEAR(middle.z, -std::sin(half), 1e-5);
    }
}

TEST(DualSkin, WhereAllJointsMoveAlikeItIsLinear) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
        test::LimbModel limb(seed);
        const Owned model(test::build_file(limb.spec));
        Pose pose(*model);
        for (int round = 0; round < 10; ++round) {
            pose.set_rest();
            JointTransform trunk = pose.local(0);
            trunk.rotation = glm::normalize(glm::quat(limb.number(), limb.number(), limb.number(), limb.number()));
            trunk.translation = 5.0f * glm::vec3(limb.number(), limb.number(), limb.number());
            if (round % 2 == 1) trunk.scale = glm::vec3(round % 4 == 1 ? 2.5f : -0.3f);  // all alike, mirrored too
            pose.set_local(0, trunk);
            for (float& weight : pose.change_morph_weights()) weight = limb.number();
            expect_same(dual(*model, pose), linear(*model, pose), 4e-6);
        }
    }
}

TEST(DualSkin, AVertexOfOneJointGoesWhereLinearTakesIt) {
    // Any matrices: sheared, mirrored, flat.
    std::mt19937 random(5);
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    for (int round = 0; round < 60; ++round) {
        test::ModelSpec spec;
        spec.joints.resize(3);
        test::MeshSpec mesh;
        std::vector<std::uint8_t> bones;
        std::vector<glm::mat4> binds;
        for (std::uint32_t joint = 0; joint < 3; ++joint) {
            glm::mat4 bind(1.0f);
            for (int c = 0; c < 4; ++c) {
                for (int row = 0; row < 3; ++row) bind[c][row] = number(random);
            }
            binds.push_back(bind);
            spec.joints[joint].rest = test::scaled(number(random), number(random), round % 5 == 0 ? 0.0f : 1.0f);
            spec.joints[joint].rest.shear = {number(random), 0.0f, number(random)};
            for (int k = 0; k < 4; ++k) {
                mesh.positions.emplace_back(number(random), number(random), number(random));
                mesh.normals.push_back(glm::normalize(glm::vec3(number(random), number(random), 0.5f)));
                mesh.tangents.emplace_back(glm::normalize(glm::vec3(0.5f, number(random), number(random))), 1.0f);
                bones.push_back(static_cast<std::uint8_t>(joint));
            }
        }
        mesh.more = {test::make_leaf(FourCC("BONE"), test::stream_payload<std::uint8_t>(1, bones)),
                     test::make_leaf(FourCC("WGHT"), test::stream_payload<float>(1, std::vector<float>(12, 1.0f))),
                     test::palette_leaf({0, 1, 2}, binds)};
        spec.meshes = {mesh};
        const Owned model(test::build_file(spec));
        Pose pose(*model);
        const Skinned is = dual(*model, pose);
        const Skinned expected = linear(*model, pose);
        for (std::size_t v = 0; v < 12; ++v) expect_near(is.positions[v], expected.positions[v], 2e-5);
        if (round % 5 == 0) continue;  // a flat one's normals hang on rounding
        for (std::size_t v = 0; v < 12; ++v) {
            expect_near(glm::vec3(is.tangents[v]), glm::dvec3(glm::vec3(expected.tangents[v])), 1e-3);
            expect_near(is.normals[v], expected.normals[v], 1e-3);
        }
    }
}

// --- an independent calculation: dual quaternions as 8 numbers, multiplied out

struct Dual {
    std::array<double, 8> n{};  // w x y z, and the dual part's
};

std::array<double, 4> product(const double* a, const double* b) {
    return {
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

Dual multiply(const Dual& a, const Dual& b) {
    Dual c;
    const auto real = product(a.n.data(), b.n.data());
    const auto left = product(a.n.data(), b.n.data() + 4);
    const auto right = product(a.n.data() + 4, b.n.data());
    for (std::size_t k = 0; k < 4; ++k) {
        c.n.at(k) = real.at(k);
        c.n.at(k + 4) = left.at(k) + right.at(k);
    }
    return c;
}

/// A rotation, then a translation.
Dual make_dual(const glm::dquat& q, const glm::dvec3& t) {
    const Dual turn{{q.w, q.x, q.y, q.z, 0, 0, 0, 0}};
    const Dual move{{1, 0, 0, 0, 0, 0.5 * t.x, 0.5 * t.y, 0.5 * t.z}};
    return multiply(move, turn);
}

/// The dual number whose square is |q|^2, divided out: a unit dual quaternion (Kavan et al., equation 3 and after).
Dual unit(const Dual& q) {
    double real = 0.0;
    double mixed = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        real += q.n.at(k) * q.n.at(k);
        mixed += q.n.at(k) * q.n.at(k + 4);
    }
    const double length = std::sqrt(real);
    Dual out;
    for (std::size_t k = 0; k < 4; ++k) {
        out.n.at(k) = q.n.at(k) / length;
        out.n.at(k + 4) = q.n.at(k + 4) / length - q.n.at(k) * mixed / (length * real);
    }
    return out;
}

/// q (1 + e v) q*, with both conjugations: the point that v is taken to.
glm::dvec3 transform(const Dual& q, const glm::dvec3& v) {
    const Dual point{{1, 0, 0, 0, 0, v.x, v.y, v.z}};
    const Dual both{{q.n[0], -q.n[1], -q.n[2], -q.n[3], -q.n[4], q.n[5], q.n[6], q.n[7]}};
    const Dual moved = multiply(multiply(q, point), both);
    return {moved.n[5], moved.n[6], moved.n[7]};
}

TEST(DualSkin, IsTheSumOfDualQuaternionsByTheirWeights) {
    // Free joints, some bound apart from the origin, with rotations of either sign; up to six of them to a vertex.
    constexpr std::uint32_t kJoints = 6;
    std::mt19937 random(8);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    const auto turn = [&] {
        return glm::normalize(glm::dquat(number(random), number(random), number(random), number(random)));
    };
    for (int round = 0; round < 20; ++round) {
        test::ModelSpec spec;
        spec.joints.resize(kJoints);
        std::vector<glm::mat4> binds;
        std::vector<std::uint32_t> entries;
        for (std::uint32_t joint = 0; joint < kJoints; ++joint) {
            glm::dmat4 bind(glm::mat3_cast(turn()));
            bind[3] = {number(random), number(random), number(random), 1.0};
            binds.emplace_back(bind);
            entries.push_back(joint);
        }
        test::MeshSpec mesh;
        std::vector<std::uint8_t> bones;
        std::vector<float> weights;
        for (int v = 0; v < 30; ++v) {
            mesh.positions.emplace_back(number(random), number(random), number(random));
            mesh.normals.push_back(glm::normalize(glm::vec3(number(random), number(random), number(random))));
            std::array<double, kJoints> share{};
            double sum = 0.0;
            for (double& part : share) sum += part = random() % 3 == 0 ? 0.0 : 0.1 + std::abs(number(random));
            for (std::uint32_t k = 0; k < kJoints; ++k) {
                bones.push_back(static_cast<std::uint8_t>((k + static_cast<std::uint32_t>(v)) % kJoints));
                weights.push_back(static_cast<float>(sum > 0.0 ? share.at(k) / sum : (k == 0 ? 1.0 : 0.0)));
            }
        }
        mesh.more = {test::make_leaf(FourCC("BONE"), test::stream_payload<std::uint8_t>(kJoints, bones)),
                     test::make_leaf(FourCC("WGHT"), test::stream_payload<float>(kJoints, weights)),
                     test::palette_leaf(entries, binds)};
        spec.meshes = {mesh};
        const Owned model(test::build_file(spec));
        Pose pose(*model);
        test::change_locals(pose, [&](JointTransform& local) {
            local.rotation = glm::quat(turn());
            local.translation = {number(random), number(random), number(random)};
        });
        const std::vector<Skinned> by_kernel = dual_by_every_kernel(*model, pose);
        std::vector<Dual> motions;
        for (std::uint32_t joint = 0; joint < kJoints; ++joint) {
            const JointTransform& local = pose.local(joint);
            const glm::dquat bound = glm::normalize(glm::quat_cast(glm::dmat3(glm::dmat4(binds[joint]))));
            motions.push_back(multiply(make_dual(glm::normalize(glm::dquat(local.rotation)), local.translation),
                                       make_dual(bound, glm::dvec3(binds[joint][3]))));
        }
        for (std::size_t v = 0; v < 30; ++v) {
            std::size_t heaviest = v * kJoints;
            for (std::size_t at = v * kJoints; at < (v + 1) * kJoints; ++at) {
                if (weights[at] > weights[heaviest]) heaviest = at;
            }
            const Dual& pivot = motions[bones[heaviest]];
            Dual sum;
            bool is_close = false;  // at right angles to the pivot, a sign hangs on rounding
            for (std::size_t at = v * kJoints; at < (v + 1) * kJoints; ++at) {
                const Dual& motion = motions[bones[at]];
                double dot = 0.0;
                for (std::size_t k = 0; k < 4; ++k) dot += motion.n.at(k) * pivot.n.at(k);
                is_close = is_close || (std::abs(dot) < 1e-4 && weights[at] > 0.0f);
                for (std::size_t k = 0; k < 8; ++k)
                    sum.n.at(k) += (dot < 0.0 ? -1.0 : 1.0) * double{weights[at]} * motion.n.at(k);
            }
            if (is_close) continue;
            const Dual blended = unit(sum);
            const glm::dvec3 at_normal = transform(blended, glm::dvec3(mesh.normals[v]));
            const glm::dvec3 at_origin = transform(blended, glm::dvec3(0.0));
            for (const Skinned& is : by_kernel) {
                expect_near(is.positions[v], transform(blended, glm::dvec3(mesh.positions[v])), 1e-5);
                expect_near(is.normals[v], at_normal - at_origin, 1e-5);
            }
        }
    }
}

TEST(DualSkin, AScaledJointScalesAboutItself) {
    // The upper joint doubles; in the middle of the tube a vertex is 1.5 times as far from the axis, whichever way the
    // joint is turned about it.
    const Owned model(test::build_file(Tube(4.0f).spec));
    Pose pose(*model);
    for (const double degrees : {0.0, 60.0, 170.0}) {
        const double half = degrees * M_PI / 360.0;
        test::local_of(pose, 1)->rotation =
            glm::quat(static_cast<float>(std::cos(half)), 0, static_cast<float>(std::sin(half)), 0);
        test::local_of(pose, 1)->scale = glm::vec3(2.0f);
        const Skinned is = dual(*model, pose);
        for (std::size_t v = 0; v < is.positions.size(); ++v) {
            const double share = Tube::share(v);
            EXPECT_NEAR(std::hypot(is.positions[v].x, is.positions[v].z), 1.0 + share, 1e-5);
            // Joint 0 leaves the height 4 s, joint 1 takes it to 4 + 2 (4 s - 4).
            const double height = 4.0 * share;
            EXPECT_NEAR(is.positions[v].y, (1 - share) * height + share * (4.0 + 2.0 * (height - 4.0)), 1e-5);
        }
    }
}

TEST(DualSkin, MeshesThatShareAPaletteAreAsEachAlone) {
    // Twice the same palette, a rigid mesh between them, then the other way round, and the first one again.
    Tube tube(4.0f);
    test::MeshSpec other = tube.spec.meshes[0];
    glm::mat4 down(1.0f);
    down[3] = {0, -4, 0, 1};
    other.more.back() = test::palette_leaf({1, 0}, {down, glm::mat4(1.0f)});
    test::MeshSpec rigid;
    rigid.positions = {{1, 2, 3}};
    rigid.normals = {{0, 0, 1}};
    rigid.tangents = {{1, 0, 0, 1}};
    tube.spec.meshes = {tube.spec.meshes[0], rigid, tube.spec.meshes[0], other, tube.spec.meshes[0]};
    const Owned model(test::build_file(tube.spec));
    Pose pose(*model);
    for (const float turn : {0.3f, -0.8f}) {
        test::local_of(pose, 1)->rotation = glm::quat(std::sqrt(1.0f - turn * turn), 0, turn, 0);
        Skinned all(model->vertex_count());
        EXPECT_TRUE(skin(pose, {.method = SkinningMethod::dual_quaternion, .out = all.all()}));
        for (std::uint32_t mesh = 0; mesh < 5; ++mesh) {
            Skinned alone(model->meshes()[mesh].vertices);
            EXPECT_TRUE(skin(pose, {.mesh = mesh, .method = SkinningMethod::dual_quaternion, .out = alone.all()}));
            for (std::size_t v = 0; v < alone.positions.size(); ++v)
                EXPECT_EQ(all.positions[model->first_vertex(mesh) + v], alone.positions[v]) << mesh;
        }
    }
}

TEST(DualSkin, LevelsOfDetailAndRigidMeshesAsLinear) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    test::local_of(pose, 1)->rotation = glm::normalize(glm::quat(1, 0, 0, 0.4f));
    Skinned all(model->vertex_count());
    ASSERT_TRUE(skin(pose, {.method = SkinningMethod::dual_quaternion, .out = all.all()}));
    Skinned flat(model->vertex_count());
    ASSERT_TRUE(skin(pose, {.out = flat.all()}));
    for (std::uint64_t v = model->first_vertex(1); v < model->first_vertex(2); ++v)
        EXPECT_EQ(all.positions[v], flat.positions[v]);
    Lod lod(*model);
    lod.set_share(0.0f);
    constexpr glm::vec3 kUntouched(-77.0f);
    std::vector<glm::vec3> some(model->vertex_count(), kUntouched);
    ASSERT_TRUE(skin(pose, {.lod = &lod, .method = SkinningMethod::dual_quaternion, .out = {.positions = some}}));
    std::size_t left = 0;
    for (std::uint32_t mesh = 0; mesh < model->meshes().size(); ++mesh) {
        for (std::uint32_t v = 0; v < model->meshes()[mesh].vertices; ++v) {
            const std::uint64_t at = model->first_vertex(mesh) + v;
            EXPECT_EQ(some[at], v < lod.vertices(mesh) ? all.positions[at] : kUntouched);
            left += v < lod.vertices(mesh) ? 0 : 1;
        }
    }
    EXPECT_GT(left, 0u);
}

TEST(DualSkin, RefusesShortMemoryAndBearsNoNumbers) {
    const Owned model(test::build_file(Tube(4.0f).spec));
    Pose pose(*model);
    std::vector<glm::vec3> positions(model->vertex_count() - 1, glm::vec3(5.0f));
    EXPECT_FALSE(skin(pose, {.method = SkinningMethod::dual_quaternion, .out = {.positions = positions}}));
    EXPECT_FALSE(skin(pose, {.mesh = 0, .method = SkinningMethod::dual_quaternion, .out = {.positions = positions}}));
    EXPECT_EQ(positions[0], glm::vec3(5.0f));
    positions.emplace_back();
    test::local_of(pose, 1)->translation.x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(
        skin(pose, {.method = SkinningMethod::dual_quaternion, .out = {.positions = positions}}));  // as skin has it
    EXPECT_FALSE(std::isfinite(positions.back().x));
    EXPECT_TRUE(std::isfinite(positions.front().x));
}

}  // namespace
}  // namespace bendy::dual_skin_test
