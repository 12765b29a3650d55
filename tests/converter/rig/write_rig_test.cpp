#include "build_scene.h"
#include "format/sample_file.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/export.h>
#include <bendy/converter/import.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <span>

namespace bendy::converter::write_rig_test {
namespace {

using namespace test;

constexpr float kFree = ConstraintRecord::kFree;

std::string written(const Scene& scene) {
    Report report;
    const std::vector<std::byte> bytes = build_chunks(scene, "test", report);
    const Faults wrong = validate(bytes);
    for (const Error& fault : wrong.list()) ADD_FAILURE() << describe_with_place(fault, bytes);
    const Result<ChunkTree> tree = read_chunk_tree(bytes);
    Faults faults;
    const Document document = read_document(*tree, faults);
    return write_rig(document.objects.at(0));
}

/// The scene's joints with the rig that its file's rig file gives.
Scene round_trip(const Scene& scene) {
    Scene bare = scene;
    bare.chains.clear();
    for (Joint& joint : bare.joints) joint.constraints.clear();
    Report report;
    const Rig rig = parse_rig(written(scene), report);
    EXPECT_TRUE(rig.complete);
    const JointIndex index(bare);
    Claims claims{std::vector<bool>(bare.joints.size()), {}};
    attach_rig(bare, rig, index, claims, report);
    for (const std::string& line : lines_of(report)) ADD_FAILURE() << line;
    return bare;
}

std::vector<std::byte> bytes_of(const Scene& scene) {
    Report report;
    return build_chunks(scene, "test", report);
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}

    unsigned below(unsigned count) { return static_cast<unsigned>(engine_() % count); }
    /// Of every size, now and then a special one.
    float number() {
        constexpr std::array kSpecial{0.0f, -0.0f, 1.0f, -1.0f, 1e-40f, 3.4e38f, 0.1f, 3.14159274f};
        if (below(4) == 0) return kSpecial[below(kSpecial.size())];
        return std::ldexp(static_cast<float>(static_cast<std::int32_t>(engine_())), static_cast<int>(below(60)) - 60);
    }
    float share() { return below(3) == 0 ? static_cast<float>(below(2)) : static_cast<float>(engine_()) / 4.3e9f; }
    float above(float least) { return below(3) == 0 ? kFree : least + std::abs(number()); }
    std::array<float, 4> rotation() {
        if (below(3) == 0) return {0.0f, 0.0f, 0.0f, 1.0f};
        std::array<float, 4> q{};
        float square = 0.0f;
        for (float& component : q) {
            component = static_cast<float>(below(2001)) / 1000.0f - 1.0f;
            square += component * component;
        }
        if (square < 0.01f) return {0.0f, 1.0f, 0.0f, 0.0f};
        // Some are as far from unit length as the format allows.
        const float length = std::sqrt(square) * (below(2) == 0 ? 1.0f : 1.00009f);
        for (float& component : q) component /= length;
        return q;
    }

private:
    std::mt19937 engine_;
};

ConstraintRecord any_limit(Random& random, unsigned scope) {
    ConstraintRecord constraint;
    constraint.model = static_cast<std::uint8_t>(random.below(kConstraintModels));
    const auto model = static_cast<ConstraintModel>(constraint.model);
    if (model == ConstraintModel::euler_box)
        constraint.euler_order = static_cast<std::uint8_t>(random.below(kEulerOrders));
    constraint.scope = static_cast<std::uint8_t>(scope);
    constraint.flags = static_cast<std::uint8_t>(random.below(4) | kRestOutside);
    constraint.soft_zone = random.below(2) == 0 ? 0.0f : std::abs(random.number());
    constraint.frame = random.rotation();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        constraint.stiffness[axis] = random.share();
        constraint.preferred[axis] = random.number();
        constraint.translation_max[axis] = random.above(0.0f);
        constraint.translation_min[axis] = random.below(2) == 0 ? -kFree : -std::abs(random.number());
        const bool counts = axis < limited_axes(model);
        if (!counts) continue;
        constraint.rotation_max[axis] = random.above(0.0f);
        if (model != ConstraintModel::largest_angle)
            constraint.rotation_min[axis] = random.below(2) == 0 ? -kFree : -std::abs(random.number());
    }
    return constraint;
}

/// Ten joints with any constraints, and three chains.
Scene any_rig(Random& random) {
    Scene scene = make_row({"a", "b*", "a", "", R"(x\[y])", "#3", "\xc3\xa4\"\n\x01", "?", "", "z"});
    for (Joint& joint : scene.joints) {
        for (unsigned scope = 0; scope < kConstraintScopes; ++scope) {
            if (random.below(2) == 0) joint.constraints.push_back(any_limit(random, scope));
        }
    }
    for (unsigned number = 0; number < 3; ++number) {
        Chain chain;
        chain.name = "chain \"" + std::to_string(number) + '"';
        if (number == 1) chain.name.clear();
        if (number == 2) chain.extras = R"({"b":[1.5,null],"a":"x"})";
        ChainRecord& record = chain.record;
        record.effector = random.below(10);
        record.start = random.below(record.effector + 1);
        if (random.below(2) == 0) record.target = random.below(10);
        if (random.below(2) == 0) record.pole = random.below(10);
        record.solver = static_cast<std::uint8_t>(random.below(kSolvers));
        record.flags = static_cast<std::uint8_t>(random.below(kChainFlags));
        record.iterations = static_cast<std::uint16_t>(random.below(65536));
        record.priority = static_cast<std::uint8_t>(random.below(256));
        record.tolerance = std::abs(random.number());
        for (float& component : record.pole_vector) component = random.number();
        for (float& component : record.tip_offset) component = random.number();
        record.pole_angle = random.number();
        record.tip_rotation = random.rotation();
        record.position_weight = random.share();
        record.rotation_weight = random.share();
        record.influence = random.share();
        record.stretch = std::abs(random.number());
        record.compress = random.share();
        for (std::uint32_t joint = record.start; joint <= record.effector; ++joint) {
            if (random.below(2) == 0) chain.weights.push_back({joint, random.share()});
        }
        scene.chains.push_back(std::move(chain));
    }
    return scene;
}

TEST(WriteRig, AnyRigComesBackToTheBit) {
    Random random(7);
    for (int round = 0; round < 200; ++round) {
        const Scene scene = any_rig(random);
        const Scene back = round_trip(scene);
        ASSERT_EQ(bytes_of(back), bytes_of(scene)) << written(scene);
    }
}

TEST(WriteRig, AnyRigComesBackFromGltfToTheBit) {
    Random random(8);
    for (int round = 0; round < 200; ++round) {
        Scene scene = any_rig(random);
        scene.chains.back().extras = R"({"a":"x","b":[1.5,null]})";  // in the order that export writes
        Report report;
        const bendy::test::Buffer file(build_chunks(scene, "test", report));
        const auto exported = export_gltf(file, {}, report);
        ASSERT_TRUE(exported) << exported.error().message;
        const auto text = std::as_bytes(std::span(exported->json));
        const auto back = import_gltf({text.begin(), text.end()}, "rig.gltf", {}, report);
        ASSERT_TRUE(back) << back.error().place << ": " << back.error().message;
        for (const std::string& line : lines_of(report)) ADD_FAILURE() << line;
        Scene same = scene;
        for (std::size_t joint = 0; joint < scene.joints.size(); ++joint)
            same.joints[joint].constraints = back->joints[joint].constraints;
        same.chains = back->chains;
        ASSERT_EQ(bytes_of(same), bytes_of(scene)) << exported->json;
    }
}

TEST(WriteRig, NothingIsLittle) {
    EXPECT_EQ(written(make_row({"a"})), "{\n  \"bendy_rig\": 1,\n  \"complete\": true\n}\n");
}

TEST(WriteRig, NumbersAreShortAndDefaultsLeftOut) {
    Scene scene = make_row({"Hip", "Knee*", "Knee*"});
    Report report;
    attach(
        scene,
        R"("joints": {"#1": {"model": "hinge", "x": [0, 150]}, "Hip": [{"model": "swing_twist_pyramid",)"
        R"( "x": [-35.5, null], "y": [-0.001, 90], "stiffness": [0, 0.1, 1]}, {"scope": "ik_only", "model": "locked"}]},)"
        R"( "chains": [{"name": "leg", "start": "Hip", "effector": "#2", "pole_angle": -120, "tolerance": 1e-7,)"
        R"( "weights": {"Hip": 0.3}}])",
        report);
    EXPECT_EQ(written(scene), R"({
  "bendy_rig": 1,
  "complete": true,
  "joints": {
    "Hip": [
      {"model": "swing_twist_pyramid", "x": [-35.5, null], "y": [-0.001, 90], "stiffness": [0, 0.1, 1]},
      {"model": "locked", "scope": "ik_only"}
    ],
    "#1": {"model": "hinge", "x": [0, 150]}
  },
  "chains": [
    {"name": "leg", "start": "Hip", "effector": "#2", "tolerance": 1e-07, "pole_angle": -120, "weights": {"Hip": 0.3}}
  ]
}
)");
}

}  // namespace
}  // namespace bendy::converter::write_rig_test
