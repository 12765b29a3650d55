#include <bendy/runtime/kernels.h>
#include <bendy/runtime/skin.h>

#include "plan/skin_plan.h"
#include "runtime/build_model.h"
#include "runtime/skin_comparison.h"
#include "runtime/tried_kernels.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace bendy::skin_kernels_test {
namespace {

using test::Buffer;
using test::kUntouched;
using test::Output;
using test::RandomBlock;
using test::Tried;
using test::tried_kernels;

void compare(RandomBlock& random, const Tried& kernel, std::size_t positions, std::size_t normals,
             std::size_t tangents) {
    const test::SkinErrors errors = test::errors_of(random, kernel.linear, positions, normals, tangents);
    EXPECT_TRUE(errors.are_small()) << kernel.name << ", " << random.block.vertices << " vertices of "
                                    << random.block.influences << ": positions " << errors.positions
                                    << " units in the last place, directions " << errors.directions
                                    << (errors.has_strayed ? ", and memory of others written" : "");
}

TEST(SkinKernels, AllAgreeWithDoublesWhateverTheCounts) {
    for (const Tried& kernel : tried_kernels()) {
        for (const std::size_t vertices : {0u, 1u, 2u, 3u, 4u, 5u, 7u, 8u, 9u, 12u, 15u, 16u, 17u, 31u, 64u, 101u}) {
            for (std::size_t influences = 1; influences <= 10; ++influences) {
                RandomBlock random(vertices, influences, static_cast<unsigned>(vertices * 100 + influences));
                compare(random, kernel, 3, 3, 4);
            }
        }
    }
}

TEST(SkinKernels, WideBonesAndOneMatrix) {
    for (const Tried& kernel : tried_kernels()) {
        for (const std::size_t influences : {1u, 3u, 4u, 8u, 9u}) {
            RandomBlock random(45, influences, 7);
            random.block.bones8 = nullptr;
            random.block.bones16 = random.bones16.data();
            compare(random, kernel, 3, 3, 4);
            random.block.bones16 = nullptr;
            random.block.weights = nullptr;
            compare(random, kernel, 3, 3, 4);
        }
    }
}

TEST(SkinKernels, AnyStrideAndAnySubset) {
    for (const Tried& kernel : tried_kernels()) {
        for (const std::size_t positions : {0u, 3u, 4u, 5u, 12u}) {
            for (const std::size_t normals : {0u, 3u, 4u, 11u}) {
                for (const std::size_t tangents : {0u, 4u, 5u, 9u}) {
                    RandomBlock random(29, 4, 11);
                    if (positions == 0) random.block.positions = nullptr;
                    if (normals == 0) random.block.normals = nullptr;
                    if (tangents == 0) random.block.tangents = nullptr;
                    compare(random, kernel, positions, normals, tangents);
                }
            }
        }
    }
}

/// The block's lists as a mesh, for make_skin_plan.
Mesh as_mesh(const RandomBlock& random) {
    const auto stream = [&](ComponentType type, Bytes data) {
        StreamView view;
        view.type = type;
        view.components = static_cast<std::uint32_t>(random.block.influences);
        view.elements = static_cast<std::uint32_t>(random.block.vertices);
        view.data = data;
        return view;
    };
    Mesh mesh;
    mesh.vertices = static_cast<std::uint32_t>(random.block.vertices);
    mesh.bones = stream(ComponentType::u8, std::as_bytes(std::span(random.bones8)));
    mesh.weights = stream(ComponentType::f32, std::as_bytes(std::span(random.weights.memory).subspan(1)));
    return mesh;
}

TEST(SkinKernels, SharedBonesGiveTheSame) {
    for (const Tried& kernel : tried_kernels()) {
        for (const std::size_t vertices : {1u, 5u, 8u, 9u, 40u, 133u}) {
            for (const std::size_t influences : {1u, 2u, 4u, 8u}) {
                RandomBlock random(vertices, influences, static_cast<unsigned>(vertices + influences));
                // By turns groups that share six bones, one bone, and too many for a list.
                for (std::size_t at = 0; at < random.bones8.size(); ++at) {
                    const std::size_t group = at / influences / 8;
                    if (group % 3 != 2)
                        random.bones8[at] = static_cast<std::uint8_t>(random.bones8[at] % (group % 3 == 0 ? 6 : 1));
                    random.bones16[at] = random.bones8[at];
                }
                const SkinPlan plan = make_skin_plan(as_mesh(random));
                ASSERT_EQ(plan.first.size(), (vertices + 7) / 8 + 1);
                ASSERT_EQ(plan.bones.size(), plan.weights.size());
                EXPECT_EQ(plan.first.back(), plan.bones.size());
                random.block.plan_first = plan.first.data();
                random.block.plan_bones = plan.bones.data();
                random.block.plan_weights = plan.weights.empty() ? nullptr : plan.weights.front().of;
                compare(random, kernel, 3, 3, 4);
                compare(random, kernel, 5, 0, 0);
                random.block.bones16 = random.bones16.data();
                random.block.bones8 = nullptr;
                compare(random, kernel, 3, 3, 0);
            }
        }
    }
}

TEST(SkinKernels, NormalsOnTheOctahedronGiveTheSame) {
    for (const Kernel each : kernels()) {
        for (const std::size_t vertices : {1u, 7u, 8u, 9u, 133u}) {
            RandomBlock random(vertices, 4, static_cast<unsigned>(vertices));
            for (std::uint8_t& bone : random.bones8) bone %= 6;
            const SkinPlan plan = make_skin_plan(as_mesh(random));
            random.block.plan_first = plan.first.data();
            random.block.plan_bones = plan.bones.data();
            random.block.plan_weights = plan.weights.front().of;
            std::mt19937 numbers(2);
            std::vector<std::int8_t> folded(2 * vertices);
            for (std::int8_t& number : folded) number = static_cast<std::int8_t>(numbers());
            folded[0] = folded[1] = -128;
            kernel_table(each).decode_directions({{folded.data(), 1, true}, vertices, 2, random.normals.data()});
            for (const std::size_t positions : {0u, 3u, 5u}) {
                for (const char* way : {"planned", "planned with tangents", "blended", "rigid"}) {
                    SkinBlock floats = random.block;
                    const std::size_t tangents = way == std::string("planned with tangents") ? 4 : 0;
                    if (way[0] != 'p') floats.plan_first = nullptr;
                    if (way[0] == 'r') floats.bones8 = nullptr;
                    SkinBlock bytes = floats;
                    bytes.normals8 = folded.data();
                    if (each == Kernel::avx2) bytes.normals = nullptr;
                    Output expected(floats, positions, 3, tangents), found(bytes, positions, 3, tangents);
                    kernel_table(each).skin(floats);
                    kernel_table(each).skin(bytes);
                    EXPECT_EQ(found.positions.memory, expected.positions.memory) << way;
                    EXPECT_EQ(found.normals.memory, expected.normals.memory) << way;
                    EXPECT_EQ(found.tangents.memory, expected.tangents.memory) << way;
                }
            }
        }
    }
}

TEST(SkinPlan, ListsWhatAGroupFollows) {
    RandomBlock random(19, 2, 1);
    for (std::size_t v = 0; v < 19; ++v) {
        for (std::size_t k = 0; k < 2; ++k) {
            random.weights.data()[2 * v + k] = v < 8 ? static_cast<float>(k) : 0.5f;
            random.bones8[2 * v + k] = static_cast<std::uint8_t>(v < 8 ? 3 + k : v < 16 ? 2 * v + k : 7);
        }
    }
    const SkinPlan plan = make_skin_plan(as_mesh(random));
    EXPECT_EQ(plan.first, (std::vector<std::uint32_t>{0, 1, 1, 2}));  // bone 4 alone; sixteen; 7 twice
    EXPECT_EQ(plan.bones, (std::vector<std::uint16_t>{4, 7}));
    for (std::size_t lane = 0; lane < 8; ++lane) {
        EXPECT_EQ(plan.weights[0].of[lane], 1.0f);
        EXPECT_EQ(plan.weights[1].of[lane], lane < 3 ? 1.0f : 0.0f);
    }
    EXPECT_FALSE(plan.is_complete);
    EXPECT_TRUE(make_skin_plan(Mesh{}).first.empty());
}

TEST(SkinKernels, WritingPastTheCachesWritesTheSame) {
    for (const Tried& kernel : tried_kernels()) {
        RandomBlock random(77, 4, 3);
        std::vector<glm::vec4> near(77), past(77);  // aligned
        for (auto* out : {&near, &past}) {
            SkinBlock block = random.block;
            block.streams = out == &past;
            block.out_positions = {&out->front().x, 3};
            kernel.linear(block);
        }
        EXPECT_EQ(near, past);
    }
}

TEST(SkinKernels, DirectionsWithoutLengthStayZero) {
    for (const Tried& kernel : tried_kernels()) {
        RandomBlock random(24, 4, 5);
        for (std::size_t k = 0; k < 3 * 24; ++k) random.normals.data()[k] = 0.0f;
        for (std::size_t k = 0; k < 4 * 24; ++k) random.tangents.data()[k] = 0.0f;
        Output out(random.block, 0, 3, 4);
        kernel.linear(random.block);
        for (std::size_t k = 0; k < 3 * 24; ++k) EXPECT_EQ(out.normals.data()[k], 0.0f);
        for (std::size_t k = 0; k < 4 * 24; ++k) EXPECT_EQ(out.tangents.data()[k], 0.0f);
    }
}

TEST(Kernels, OneIsChosenAndOthersCanBeForced) {
    const Kernel first = kernel();
    ASSERT_FALSE(kernels().empty());
    EXPECT_EQ(kernels().back(), Kernel::plain);
    for (const Kernel each : kernels()) {
        EXPECT_TRUE(set_kernel(each));
        EXPECT_EQ(kernel(), each);
        EXPECT_FALSE(kernel_name(each).empty());
    }
    const bool has_neon = std::find(kernels().begin(), kernels().end(), Kernel::neon) != kernels().end();
    const Kernel foreign = has_neon ? Kernel::avx2 : Kernel::neon;
    EXPECT_FALSE(set_kernel(foreign));
    EXPECT_EQ(kernel(), Kernel::plain);
    EXPECT_TRUE(set_kernel(first));
}

// --- every kind of stream, through a model

/// One component type of weights; `box` instead of normalising.
template <class Weight>
test::Node weights_leaf(std::uint16_t influences, const std::vector<Weight>& weights) {
    return test::make_leaf(FourCC("WGHT"),
                           test::stream_payload<Weight>(influences, weights, !std::is_same_v<Weight, float>));
}

/// Integers that stand for minimum + step * integer.
template <class T>
test::Node boxed_leaf(FourCC id, const std::vector<T>& numbers, const std::vector<StreamBox>& boxes) {
    Buffer payload = test::stream_payload<T>(static_cast<std::uint16_t>(boxes.size()), numbers);
    StreamRecord record;
    std::memcpy(&record, payload.data(), sizeof record);
    record.normalised = static_cast<std::uint8_t>(Numbers::boxed);
    std::memcpy(payload.data(), &record, sizeof record);
    Buffer between(padded(boxes.size() * sizeof(StreamBox)));
    std::memcpy(between.data(), boxes.data(), boxes.size() * sizeof(StreamBox));
    payload.insert(payload.begin() + sizeof record, between.begin(), between.end());
    return test::make_leaf(id, payload);
}

/// Makes a mesh's streams narrow: boxed positions and weights, directions on the octahedron.
void narrow(test::MeshSpec& mesh) {
    std::vector<std::uint16_t> positions;
    std::vector<std::int8_t> normals;
    std::vector<std::int16_t> tangents;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        for (int c = 0; c < 3; ++c) positions.push_back(static_cast<std::uint16_t>((mesh.positions[v][c] + 1) * 20000));
        for (int c = 0; c < 2; ++c) normals.push_back(static_cast<std::int8_t>(mesh.normals[v][c] * 100));
        for (int c = 0; c < 2; ++c) tangents.push_back(static_cast<std::int16_t>(mesh.tangents[v][c] * 30000));
        tangents.push_back(v % 2 == 0 ? 32767 : -32767);
    }
    const std::vector<std::uint8_t> weights = [&] {
        std::vector<std::uint8_t> four;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            if (v * v / 7 % 2 == 0)
                four.insert(four.end(), {0, 64, 128, 64});
            else
                four.insert(four.end(), {0, 128, 32, 96});
        }
        return four;
    }();
    std::erase_if(mesh.more, [](const test::Node& node) { return node.id == FourCC("WGHT"); });
    mesh.more.push_back(boxed_leaf<std::uint16_t>(FourCC("POSI"), positions, {{-1, 5e-5f}, {-1, 5e-5f}, {-1, 5e-5f}}));
    mesh.more.push_back(test::make_leaf(FourCC("NORM"), test::stream_payload<std::int8_t>(2, normals, true)));
    mesh.more.push_back(test::make_leaf(FourCC("TANG"), test::stream_payload<std::int16_t>(3, tangents, true)));
    mesh.more.push_back(boxed_leaf<std::uint8_t>(
        FourCC("WGHT"), weights, {{0.0f, 0.1f}, {0.0f, 1 / 256.0f}, {0.0f, 1 / 256.0f}, {0.0f, 1 / 256.0f}}));
    mesh.normals.clear();
    mesh.tangents.clear();
}

/// More vertices than are staged at a time, and not whole groups of eight.
constexpr std::uint32_t kVertices = 1301;

/// Vertices of four bones, in a form of each stream; every third group follows few bones. With targets, dense and
/// sparse.
template <class Bone, class Weight>
Buffer file_of(bool has_targets, bool is_narrow = false) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    const auto vector = [&] { return glm::vec3(number(random), number(random), number(random)); };
    test::ModelSpec spec;
    spec.joints.resize(20);
    std::vector<std::uint32_t> joints;
    std::vector<glm::mat4> bind;
    for (std::uint32_t joint = 0; joint < 20; ++joint) {
        if (joint > 0) spec.joints[joint].parent = joint - 1;
        spec.joints[joint].rest.translation = {number(random), number(random), number(random)};
        const glm::quat q = glm::normalize(glm::quat(1.0f, 0.3f * vector()));
        spec.joints[joint].rest.rotation = {q.x, q.y, q.z, q.w};
        joints.push_back(19 - joint);
        bind.push_back(glm::mat4(1.0f));
        bind.back()[3] = glm::vec4(vector(), 1.0f);
    }
    spec.meshes.resize(1);
    test::MeshSpec& mesh = spec.meshes[0];
    std::vector<Bone> bones;
    std::vector<Weight> weights;
    std::vector<float> shifts;
    std::vector<std::uint32_t> touched;
    for (std::uint32_t v = 0; v < kVertices; ++v) {
        mesh.positions.push_back(vector());
        mesh.normals.push_back(glm::normalize(vector()));
        mesh.tangents.push_back(glm::vec4(glm::normalize(vector()), 1.0f));
        const int most = static_cast<int>(random() % 4);
        for (int k = 0; k < 4; ++k) {
            bones.push_back(static_cast<Bone>(random() % (v / 8 % 3 == 0 ? 3 : 20)));
            constexpr float kOne = std::is_same_v<Weight, float> ? 1.0f : std::numeric_limits<Weight>::max();
            weights.push_back(static_cast<Weight>((k == most ? 0.4f : 0.2f) * kOne));
        }
        if (v % 7 == 3) touched.push_back(v);
    }
    for (std::uint32_t k = 0; k < 3 * kVertices; ++k) shifts.push_back(number(random));
    mesh.more = {test::make_leaf(FourCC("BONE"), test::stream_payload<Bone>(4, bones)),
                 weights_leaf<Weight>(4, weights), test::palette_leaf(joints, bind)};
    if (has_targets) {
        MorphTargetRecord rest;
        rest.rest_weight = 0.5f;
        test::Node dense = test::make_container(FourCC("TARG"));
        dense.children = {test::make_leaf(FourCC("TINF"), bytes_of(rest)),
                          test::make_leaf(FourCC("POSI"), test::stream_payload<float>(3, shifts)),
                          test::make_leaf(FourCC("NORM"), test::stream_payload<float>(3, shifts))};
        shifts.resize(touched.size() * 3);
        test::Node sparse = test::make_container(FourCC("TARG"));
        sparse.children = {test::make_leaf(FourCC("TINF"), bytes_of(rest)),
                           test::make_leaf(FourCC("INDX"), test::stream_payload<std::uint32_t>(1, touched)),
                           test::make_leaf(FourCC("POSI"), test::stream_payload<float>(3, shifts)),
                           test::make_leaf(FourCC("TANG"), test::stream_payload<float>(3, shifts))};
        mesh.more.push_back(dense);
        mesh.more.push_back(sparse);
    }
    if (is_narrow) narrow(mesh);
    return test::build_file(spec);
}

/// What skin() says it does, by the streams' own readers and in doubles.
void expect_as_defined(const Buffer& file) {
    const test::Owned model{Buffer(file)};
    Pose pose(*model);
    const Mesh& mesh = model->meshes()[0];
    std::vector<glm::vec3> base(mesh.vertices), base_normals(mesh.vertices);
    std::vector<glm::vec4> base_tangents(mesh.vertices);
    ASSERT_TRUE(apply_morph_targets(mesh, pose.morph_weights(), {base, base_normals, base_tangents}));
    const Kernel before = kernel();
    for (const Kernel each : kernels()) {
        ASSERT_TRUE(set_kernel(each));
        std::vector<glm::vec3> positions(mesh.vertices), normals(mesh.vertices);
        std::vector<glm::vec4> tangents(mesh.vertices);
        ASSERT_TRUE(skin(pose, {.out = {positions, normals, tangents}}));
        for (std::uint32_t v = 0; v < mesh.vertices; ++v) {
            glm::dmat4 matrix(0.0);
            for (std::uint32_t k = 0; k < 4; ++k) {
                const std::uint32_t bone = mesh.bones->index(v, k);
                matrix +=
                    double{mesh.weights->number(v, k)} * (glm::dmat4(pose.model_space()[mesh.palette.joints[bone]]) *
                                                          glm::dmat4(mesh.palette.inverse_bind()[bone]));
            }
            const glm::dvec4 expected = matrix * glm::dvec4(base[v], 1.0);
            const glm::dmat3 cofactors = glm::determinant(matrix) * glm::transpose(glm::inverse(glm::dmat3(matrix)));
            const double volume = glm::determinant(glm::dmat3(matrix));
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(positions[v][c], expected[c], 2e-5) << kernel_name(each);
            if (std::abs(volume) < 1e-2) continue;
            const glm::dvec3 normal =
                (volume < 0.0 ? -1.0 : 1.0) * glm::normalize(cofactors * glm::dvec3(base_normals[v]));
            const glm::dvec3 tangent = glm::normalize(glm::dmat3(matrix) * glm::dvec3(base_tangents[v]));
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(normals[v][c], (volume < 0.0 ? -1.0 : 1.0) * normal[c], 1e-4) << kernel_name(each);
                EXPECT_NEAR(tangents[v][c], tangent[c], 1e-4) << kernel_name(each);
            }
            EXPECT_EQ(tangents[v].w, volume < 0.0 ? -base_tangents[v].w : base_tangents[v].w);
        }
    }
    EXPECT_TRUE(set_kernel(before));
}

TEST(SkinStreams, BonesAndWeightsOfEveryType) {
    expect_as_defined(file_of<std::uint8_t, float>(false));
    expect_as_defined(file_of<std::uint16_t, float>(false));
    expect_as_defined(file_of<std::uint8_t, std::uint8_t>(false));
    expect_as_defined(file_of<std::uint16_t, std::uint16_t>(false));
}

TEST(SkinStreams, TargetsMoveBlockByBlock) {
    expect_as_defined(file_of<std::uint8_t, float>(true));
    expect_as_defined(file_of<std::uint16_t, std::uint16_t>(true));
}

TEST(SkinStreams, BoxesAndTheOctahedron) {
    expect_as_defined(file_of<std::uint8_t, float>(false, true));
    expect_as_defined(file_of<std::uint16_t, float>(true, true));
}

TEST(SkinStreams, NormalsOnTheOctahedronOfMeshesWithoutBones) {
    for (const std::uint32_t joint : {kNone, 1u}) {
        test::ModelSpec spec;
        spec.joints.resize(2);
        spec.joints[1].rest.rotation = {0.0f, 0.0f, 1.0f, 0.0f};  // x and y change their signs
        test::MeshSpec& mesh = spec.meshes.emplace_back();
        mesh.joint = joint;
        mesh.positions.resize(kVertices);
        std::vector<std::int8_t> normals(2 * std::size_t{kVertices});
        std::mt19937 random(3);
        for (std::int8_t& number : normals) number = static_cast<std::int8_t>(random() % 255 - 127);
        mesh.more = {test::make_leaf(FourCC("NORM"), test::stream_payload<std::int8_t>(2, normals, true))};
        const test::Owned model{test::build_file(spec)};
        std::vector<glm::vec3> expected(kVertices), found(kVertices), positions(kVertices);
        model->meshes()[0].normals->decode(std::span(expected));
        const Kernel before = kernel();
        for (const Kernel each : kernels()) {
            ASSERT_TRUE(set_kernel(each));
            Pose pose(*model);
            ASSERT_TRUE(skin(pose, {.out = {positions, found, {}}}));
            const float sign = joint == kNone ? 1.0f : -1.0f;
            for (std::uint32_t v = 0; v < kVertices; ++v) {
                const glm::vec3 normal = expected[v] * glm::vec3(sign, sign, 1.0f);
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[v][c], normal[c], 1e-6) << kernel_name(each);
            }
        }
        EXPECT_TRUE(set_kernel(before));
    }
}

// --- the caller's layout

TEST(SkinBuffer, InterleavedIsAsApart) {
    const test::Owned model(file_of<std::uint8_t, float>(true));
    Pose pose(*model);
    const std::size_t count = model->vertex_count();
    std::vector<glm::vec3> positions(count), normals(count);
    std::vector<glm::vec4> tangents(count);
    ASSERT_TRUE(skin(pose, {.out = {positions, normals, tangents}}));
    std::vector<float> buffer(count * 13,
                              kUntouched);  // position, 2 of the caller's, normal, tangent, 1 of the caller's
    const auto from = [&](std::size_t at) { return StridedFloats{std::span(buffer).subspan(at), 13}; };
    ASSERT_TRUE(skin(pose, {.out = {from(0), from(5), from(8)}}));
    for (std::size_t v = 0; v < count; ++v) {
        const float* const vertex = &buffer[v * 13];
        for (int c = 0; c < 3; ++c) EXPECT_EQ(vertex[c], positions[v][c]);
        for (int c = 0; c < 3; ++c) EXPECT_EQ(vertex[5 + c], normals[v][c]);
        for (int c = 0; c < 4; ++c) EXPECT_EQ(vertex[8 + c], tangents[v][c]);
        for (const int c : {3, 4, 12}) EXPECT_EQ(vertex[c], kUntouched);
    }
}

TEST(SkinBuffer, WhatIsTooSmallIsRefusedAndNothingIsWritten) {
    const test::Owned model(file_of<std::uint8_t, float>(false));
    Pose pose(*model);
    const std::size_t count = model->vertex_count();
    std::vector<float> buffer(count * 8, kUntouched);
    const auto attempt = [&](std::size_t size, std::size_t stride) {
        const StridedFloats memory{std::span(buffer).first(size), stride};
        return skin(pose, {.out = {memory, {}, {}}}) || skin(pose, {.out = {{}, memory, {}}}) ||
               skin(pose, {.mesh = 0, .out = {{}, {}, memory}});
    };
    EXPECT_FALSE(attempt((count - 1) * 8 + 2, 8));
    EXPECT_FALSE(attempt(count * 8, 2));
    EXPECT_FALSE(attempt(count * 8, 0));
    EXPECT_FALSE(attempt(count * 8, 9));
    EXPECT_FALSE(attempt(count * 8, std::numeric_limits<std::size_t>::max() / 2));
    EXPECT_FALSE(attempt(2, 8));
    EXPECT_EQ(buffer, std::vector<float>(count * 8, kUntouched));
    const StridedFloats exact{std::span(buffer).first((count - 1) * 8 + 3), 8};
    EXPECT_TRUE(skin(pose, {.out = {exact, {}, {}}}));
}

}  // namespace
}  // namespace bendy::skin_kernels_test
