#include "rigging/rig/attach_rig.h"

#include "../humanoid/humanoid_gltf.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace bendy::converter::articulations_test {
namespace {

using namespace test;
using test::Json;  // not that of the converter

Json stage(const char* type, double low, double high, double initial = 0) {
    return {{"name", "s"}, {"type", type}, {"minimumValue", low}, {"maximumValue", high}, {"initialValue", initial}};
}

struct Rigged {
    Scene scene;
    Report report;
    [[nodiscard]] const ConstraintRecord& constraint() const { return scene.joints.at(0).constraints.at(0); }
};

Rigged rig(const Json& articulations, Json node = Json::object()) {
    Gltf gltf;
    node["extensions"]["AGI_articulations"]["articulationName"] = "A";
    gltf.add_node(std::move(node));
    gltf.json["extensions"]["AGI_articulations"]["articulations"] = articulations;
    const Import import = gltf.import();
    Rigged result{*import, import.report};
    add_articulations(result.scene, {}, result.report);
    EXPECT_TRUE(validate(build_chunks(result.scene, "test", result.report)).empty());
    return result;
}

Rigged rig_stages(const std::vector<Json>& stages, Json node = Json::object()) {
    const Json list(stages);
    Rigged result = rig({{{"name", "A"}, {"stages", list}}}, std::move(node));
    if (result.scene.joints[0].constraints.size() != 1) {
        ADD_FAILURE() << "no limit of " << list;
        result.scene.joints[0].constraints.resize(1);
    }
    return result;
}

/// Axis 0, 1 or 2 of the limit's frame in the joint's space.
glm::dvec3 axis_of(const ConstraintRecord& constraint, int axis) {
    glm::dvec3 unit(0);
    unit[axis] = 1;
    return glm::dquat(constraint.frame[3], constraint.frame[0], constraint.frame[1], constraint.frame[2]) * unit;
}

TEST(Articulations, OneTurnIsAHinge) {
    const std::array<const char*, 3> types{"xRotate", "yRotate", "zRotate"};
    for (int axis = 0; axis < 3; ++axis) {
        const Rigged rigged = rig_stages({stage(types[static_cast<std::size_t>(axis)], -30, 90, 45)});
        const ConstraintRecord& constraint = rigged.constraint();
        EXPECT_EQ(constraint.model, static_cast<std::uint8_t>(ConstraintModel::hinge));
        EXPECT_EQ(constraint.flags, 0);
        EXPECT_NEAR(axis_of(constraint, 0)[axis], 1, 1e-6);
        EXPECT_NEAR(constraint.rotation_min[0], -30 * kTestDegree, 1e-6);
        EXPECT_NEAR(constraint.rotation_max[0], 90 * kTestDegree, 1e-6);
        EXPECT_NEAR(constraint.preferred[0], 45 * kTestDegree, 1e-6);
        EXPECT_TRUE(rigged.report.warnings().empty());
    }
}

TEST(Articulations, TurnsAboutSeveralAxesAreAnEulerBox) {
    // Rx Ry Rz: Z turns first.
    const Rigged three = rig_stages({stage("xRotate", -1, 1), stage("yRotate", -2, 2), stage("zRotate", -3, 3)});
    EXPECT_EQ(three.constraint().model, static_cast<std::uint8_t>(ConstraintModel::euler_box));
    EXPECT_EQ(three.constraint().euler_order, static_cast<std::uint8_t>(EulerOrder::zyx));
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(three.constraint().rotation_max[i], static_cast<double>(i + 1) * kTestDegree, 1e-6);
    const Rigged two = rig_stages({stage("yRotate", -2, 2), stage("xRotate", -1, 1)});
    EXPECT_EQ(two.constraint().euler_order, static_cast<std::uint8_t>(EulerOrder::xyz));
    EXPECT_EQ(two.constraint().rotation_min[2], 0.0f);
    EXPECT_EQ(two.constraint().rotation_max[2], 0.0f);
    EXPECT_EQ(two.constraint().flags, 0);
}

TEST(Articulations, ShiftsAreInTheJointsScale) {
    const Rigged rigged = rig_stages({stage("yTranslate", -1, 2), stage("zRotate", 0, 10)}, {{"scale", {-2, -2, -2}}});
    const ConstraintRecord& constraint = rigged.constraint();
    EXPECT_EQ(constraint.flags, 0);
    for (int i = 0; i < 3; ++i) {
        const bool is_y = std::abs(axis_of(constraint, i).y) > 0.9;
        EXPECT_EQ(constraint.translation_min[static_cast<std::size_t>(i)], is_y ? -4.0f : 0.0f);
        EXPECT_EQ(constraint.translation_max[static_cast<std::size_t>(i)], is_y ? 2.0f : 0.0f);
        EXPECT_GT(axis_of(constraint, i).x + axis_of(constraint, i).y + axis_of(constraint, i).z,
                  0.9);  // no axis is turned round
    }
    const Rigged slide = rig_stages({stage("xTranslate", 0, 1)});
    EXPECT_EQ(slide.constraint().model, static_cast<std::uint8_t>(ConstraintModel::locked));
}

TEST(Articulations, WhatALimitCannotSayIsApproximated) {
    for (const std::vector<Json>& stages :
         {std::vector<Json>{stage("xRotate", -1, 1), stage("yRotate", -1, 1), stage("xRotate", -1, 1)},
          std::vector<Json>{stage("xRotate", -1, 1), stage("yTranslate", 0, 1)},
          std::vector<Json>{stage("xScale", 0, 1)},
          std::vector<Json>{stage("uniformScale", 0, 1), stage("xRotate", 0, 1)}}) {
        const Rigged rigged = rig_stages(stages);
        EXPECT_NE(rigged.constraint().flags & kApproximated, 0) << Json(stages);
        EXPECT_EQ(rigged.report.warnings().size(), 1u) << Json(stages);
        EXPECT_EQ(warned(rigged.report, "extensions.AGI_articulations.articulations[0]"), 1u) << Json(stages);
    }
    EXPECT_NE(rig_stages({stage("xRotate", 0, 1)}, {{"scale", {1, 2, 1}}}).constraint().flags & kApproximated, 0);
    const Rigged side_by_side = rig_stages({stage("xRotate", -1, 1), stage("xRotate", -2, 3)});
    EXPECT_EQ(side_by_side.constraint().flags, 0);
    EXPECT_NEAR(side_by_side.constraint().rotation_max[0], 4 * kTestDegree, 1e-6);
}

TEST(Articulations, RestMayLieOutside) {
    EXPECT_EQ(rig_stages({stage("xRotate", 10, 20, 10)}).constraint().flags, kRestOutside);
    EXPECT_EQ(rig_stages({stage("xTranslate", 10, 20, 10)}).constraint().flags, kRestOutside);
}

TEST(Articulations, AreFiniteWhateverTheSourceSays) {
    const Rigged rigged = rig_stages({stage("xRotate", -1e308, 1e308), stage("yTranslate", -1e308, 1e308),
                                      stage("xRotate", -1e308, 1e308), stage("zTranslate", 1e308, 1e308, 1e308)},
                                     {{"scale", {1e30, 1e30, 1e30}}});
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(rigged.constraint().translation_max[i]));
}

TEST(Articulations, WhatIsWrongIsNamedByItsPlace) {
    const auto expect = [](const Json& articulations, const char* place) {
        const Rigged rigged = rig(articulations);
        EXPECT_TRUE(rigged.scene.joints[0].constraints.empty()) << articulations;
        EXPECT_GE(warned(rigged.report, place), 1u) << articulations;
        EXPECT_GE(warned(rigged.report, "node of an articulation that does not exist"), 1u) << articulations;
    };
    expect(Json(), "extensions.AGI_articulations.articulations");
    expect("x", "extensions.AGI_articulations.articulations");
    expect(Json::array({7}), "articulations[0]");
    expect({{{"name", 7}}}, "articulations[0]");
    expect({{{"name", "A"}}}, "articulations[0]");
    expect({{{"name", "A"}, {"stages", 1}}}, "articulations[0]");
    expect({{{"name", "A"}, {"stages", {1}}}}, "articulations[0].stages[0]");
    expect({{{"name", "A"}, {"stages", {stage("wRotate", 0, 1)}}}}, "articulations[0].stages[0]");
    expect({{{"name", "A"}, {"stages", {stage("xrotate", 0, 1)}}}}, "articulations[0].stages[0]");
    expect({{{"name", "A"}, {"stages", {stage("xRotate", 2, 1)}}}}, "articulations[0].stages[0]");
    Json text = stage("xRotate", 0, 1);
    text["maximumValue"] = "1";
    expect({{{"name", "A"}, {"stages", {text}}}}, "articulations[0].stages[0]");
}

TEST(Articulations, LeaveLimitsThatAreThere) {
    Scene scene = rig_stages({stage("xRotate", 0, 1)}).scene;
    Report report;
    add_articulations(scene, {}, report);
    EXPECT_EQ(scene.joints[0].constraints.size(), 1u);
    scene.joints[0].constraints.clear();
    add_articulations(scene, {true}, report);
    EXPECT_TRUE(scene.joints[0].constraints.empty());
}

TEST(Articulations, PointingVectorsAreSaidToBeKept) {
    const Rigged rigged = rig({{{"name", "A"}, {"stages", {stage("xRotate", 0, 1)}}, {"pointingVector", {0, 0, 1}}}});
    EXPECT_EQ(warned(rigged.report, "pointingVector"), 1u);
    EXPECT_NE(rigged.scene.extensions.find("pointingVector"), std::string::npos);
}

}  // namespace
}  // namespace bendy::converter::articulations_test
