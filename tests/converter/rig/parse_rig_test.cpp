#include "build_scene.h"

#include "source_folder.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>

namespace bendy::converter::parse_rig_test {
namespace {

using namespace test;

constexpr float kFree = ConstraintRecord::kFree;
constexpr float kPi = std::numbers::pi_v<float>;

ConstraintRecord constraint_record_of(const std::string& constraint) {
    return parse(R"("joints": {"j": )" + constraint + "}").joints.at(0).constraints.at(0);
}

std::string constraint_error(const std::string& constraint) {
    return rig_error(R"("joints": {"j": )" + constraint + "}");
}

std::string chain_error(const std::string& members) {
    return rig_error(R"("chains": [{"name": "c", "start": "s", "effector": "e")" + members + "}]");
}

TEST(ParseRig, TheExampleOfTheSpecification) {
    std::ifstream file((source_folder() / "spec/rig.md").string());
    const std::string page((std::istreambuf_iterator<char>(file)), {});
    const std::size_t begin = page.find("```json\n") + 8;
    Report report;
    const Rig rig = parse_rig(page.substr(begin, page.find("```", begin) - begin), report);
    EXPECT_FALSE(rig.complete);
    ASSERT_EQ(rig.joints.size(), 4u);
    EXPECT_EQ(rig.joints[0].key.kind, JointKey::Kind::glob);
    EXPECT_EQ(rig.joints[0].constraints.at(0).rotation_max[0], 150.0f / 180.0f * kPi);
    EXPECT_EQ(rig.joints[2].constraints.size(), 2u);
    EXPECT_TRUE(rig.joints[3].constraints.empty());
    ASSERT_EQ(rig.chains.size(), 1u);
    EXPECT_EQ(rig.chains[0].weights.at(0).second, 0.5f);
}

TEST(ParseRig, LeftOutKeysAreDefaults) {
    const ConstraintRecord constraint = constraint_record_of(R"({"model": "euler_box"})");
    ConstraintRecord usual;
    usual.model = static_cast<std::uint8_t>(ConstraintModel::euler_box);
    EXPECT_EQ(std::memcmp(&constraint, &usual, sizeof constraint), 0);
    const RigChain chain = parse(R"("chains": [{"name": "c", "start": "s", "effector": "e"}])").chains.at(0);
    const ChainRecord plain;
    EXPECT_EQ(std::memcmp(&chain.record, &plain, sizeof plain), 0);
    EXPECT_TRUE(chain.target.empty() && chain.pole.empty() && chain.extras.empty() && chain.weights.empty());
}

TEST(ParseRig, EveryKeyOfAConstraint) {
    const ConstraintRecord constraint = constraint_record_of(
        R"({"model": "euler_box", "order": "ZXY", "scope": "all_but_ik", "frame": [0, 0, 2, 0], "x": [-90, null],)"
        R"( "y": [null, 180], "z": [-45.5, 0], "translation": {"y": [-1, null]}, "stiffness": [0, 0.5, 1],)"
        R"( "preferred": [360, 0, -90], "soft_zone": 18, "approximated": true, "proposed": true, "rest_outside": true})");
    EXPECT_EQ(constraint.model, 5);
    EXPECT_EQ(constraint.euler_order, 4);
    EXPECT_EQ(constraint.scope, 2);
    EXPECT_EQ(constraint.flags, 7);
    EXPECT_EQ(constraint.frame, (std::array{0.0f, 0.0f, 1.0f, 0.0f}));
    EXPECT_EQ(constraint.rotation_min,
              (std::array{-kPi / 2, -kFree, static_cast<float>(-45.5 / 180 * std::numbers::pi)}));
    EXPECT_EQ(constraint.rotation_max, (std::array{kFree, kPi, 0.0f}));
    EXPECT_EQ(constraint.translation_min, (std::array{-kFree, -1.0f, -kFree}));
    EXPECT_EQ(constraint.translation_max, (std::array{kFree, kFree, kFree}));
    EXPECT_EQ(constraint.stiffness, (std::array{0.0f, 0.5f, 1.0f}));
    EXPECT_EQ(constraint.preferred, (std::array{2 * kPi, 0.0f, -kPi / 2}));
    EXPECT_EQ(constraint.soft_zone, kPi / 10);
    EXPECT_EQ(constraint_record_of(R"({"model": "largest_angle", "angle": 30})").rotation_max[0], kPi / 6);
    EXPECT_EQ(constraint_record_of(R"({"model": "largest_angle", "angle": null})").rotation_max[0], kFree);
}

TEST(ParseRig, EveryKeyOfAChain) {
    const RigChain chain =
        parse(
            R"("chains": [{"name": "arm", "start": "a", "effector": "#2", "target": "t", "pole": "p", "solver": "aim",)"
            R"( "iterations": 65535, "priority": 255, "tolerance": 0.25, "pole_vector": [1, 2, 3], "pole_angle": -180,)"
            R"( "tip_offset": [4, 5, 6], "tip_rotation": [1, 0, 0, 0], "position_weight": 0.5, "rotation_weight": 1,)"
            R"( "influence": 0, "stretch": 7, "compress": 0.125, "weights": {"a": 0, "*": 1, "#2": 0.75},)"
            R"( "approximated": true, "proposed": true, "extras": {"z": [1.5], "a": null}}])")
            .chains.at(0);
    EXPECT_EQ(chain.name, "arm");
    EXPECT_EQ(chain.start + chain.effector + chain.target + chain.pole, "a#2tp");
    const ChainRecord& record = chain.record;
    EXPECT_EQ(record.solver, static_cast<std::uint8_t>(Solver::aim));
    EXPECT_EQ(record.iterations, 65535);
    EXPECT_EQ(record.priority, 255);
    EXPECT_EQ(record.tolerance, 0.25f);
    EXPECT_EQ(record.pole_vector, (std::array{1.0f, 2.0f, 3.0f}));
    EXPECT_EQ(record.pole_angle, -kPi);
    EXPECT_EQ(record.tip_offset, (std::array{4.0f, 5.0f, 6.0f}));
    EXPECT_EQ(record.tip_rotation, (std::array{1.0f, 0.0f, 0.0f, 0.0f}));
    EXPECT_EQ(record.position_weight, 0.5f);
    EXPECT_EQ(record.rotation_weight, 1.0f);
    EXPECT_EQ(record.influence, 0.0f);
    EXPECT_EQ(record.stretch, 7.0f);
    EXPECT_EQ(record.compress, 0.125f);
    EXPECT_EQ(record.flags, 3);
    ASSERT_EQ(chain.weights.size(), 3u);
    EXPECT_EQ(chain.weights[1].first.kind, JointKey::Kind::glob);
    EXPECT_EQ(chain.weights[2].second, 0.75f);
    EXPECT_EQ(chain.extras, R"({"z":[1.5],"a":null})");
}

TEST(ParseRig, BadConstraintsNameTheirPlace) {
    EXPECT_EQ(constraint_error("7"), "joints.j: it must be an object, not 7");
    EXPECT_EQ(constraint_error("{}"), "joints.j.model: it is required and missing");
    EXPECT_EQ(constraint_error(R"({"model": "hing"})"),
              "joints.j.model: 'hing' is none of free, locked, hinge, swing_twist_ellipse, swing_twist_pyramid, "
              "euler_box, largest_angle");
    EXPECT_EQ(constraint_error(R"({"model": 2})"),
              "joints.j.model: 2 is none of free, locked, hinge, swing_twist_ellipse, swing_twist_pyramid, euler_box, "
              "largest_angle");
    EXPECT_EQ(rig_error(R"("joints": {"*Knee*": {"model": "hinge", "x": ["a", 1]}})"),
              "joints.'*Knee*'.x[0]: expected a number, found 'a'");
    EXPECT_EQ(constraint_error(R"({"model": "hinge", "x": [1]})"), "joints.j.x: expected 2 elements, found 1");
    EXPECT_EQ(constraint_error(R"({"model": "hinge", "x": 1})"), "joints.j.x: it must be a list, not 1");
    EXPECT_EQ(constraint_error(R"({"model": "hinge", "x": [30, 20.5]})"),
              "joints.j.x: the minimum 30.0 is above the maximum 20.5");
    EXPECT_EQ(constraint_error(R"({"model": "hinge", "x": [-1e300, 0]})"),
              "joints.j.x[0]: -1e+300 does not fit a 32-bit float");
    EXPECT_EQ(constraint_error(R"({"model": "hinge", "y": [0, 1]})"), "joints.j.y: it means nothing for model hinge");
    EXPECT_EQ(constraint_error(R"({"model": "free", "x": [0, 1]})"), "joints.j.x: it means nothing for model free");
    EXPECT_EQ(constraint_error(R"({"model": "largest_angle", "x": [0, 1]})"),
              "joints.j.x: it means nothing for model largest_angle");
    EXPECT_EQ(constraint_error(R"({"model": "hinge", "angle": 1})"),
              "joints.j.angle: it means nothing for model hinge");
    EXPECT_EQ(constraint_error(R"({"model": "hinge", "order": "XYZ"})"),
              "joints.j.order: it means nothing for model hinge");
    EXPECT_EQ(constraint_error(R"({"model": "largest_angle", "angle": -1})"), "joints.j.angle: it is less than 0");
    EXPECT_EQ(constraint_error(R"({"model": "swing_twist_ellipse", "z": [10, 20]})"),
              "joints.j.z: a swing's range must hold 0");
    EXPECT_EQ(constraint_error(R"({"model": "free", "frame": [0, 0, 0, 0]})"),
              "joints.j.frame: 0 0 0 0 is not a rotation");
    EXPECT_EQ(constraint_error(R"({"model": "free", "frame": [0, 0, 0, null]})"),
              "joints.j.frame[3]: expected a number, found null");
    EXPECT_EQ(constraint_error(R"({"model": "free", "stiffness": [0, 0, 1.5]})"),
              "joints.j.stiffness[2]: 1.5 is not between 0.0 and 1.0");
    EXPECT_EQ(constraint_error(R"({"model": "free", "soft_zone": -1})"), "joints.j.soft_zone: it is less than 0");
    EXPECT_EQ(constraint_error(R"({"model": "free", "proposed": "yes"})"),
              "joints.j.proposed: it must be true or false, not 'yes'");
    EXPECT_EQ(constraint_error(R"({"model": "free", "translation": {"w": [0, 1]}})"),
              "joints.j.translation.w: there is no such key; there are x, y, z");
    EXPECT_EQ(constraint_error(R"([{"model": "free"}, {"model": "locked"}])"),
              "joints.j[1]: there is a second constraint of scope every_pose");
    EXPECT_EQ(constraint_error(R"({"model": "free", "stifness": [0, 0, 0]})").substr(0, 46),
              "joints.j.stifness: there is no such key; there");
}

TEST(ParseRig, BadChainsNameTheirPlace) {
    EXPECT_EQ(rig_error(R"("chains": {})"), "chains: it must be a list, not object");
    EXPECT_EQ(rig_error(R"("chains": [{"name": "c", "start": "s"}])"),
              "chains[0].effector: it is required and missing");
    EXPECT_EQ(rig_error(R"("chains": [{"name": 3, "start": "s", "effector": "e"}])"),
              "chains[0].name: it must be a string, not 3");
    EXPECT_EQ(chain_error(R"(, "iterations": 65536)"), "chains[0].iterations: 65536 is not between 0 and 65535");
    EXPECT_EQ(chain_error(R"(, "iterations": 1.5)"), "chains[0].iterations: it must be a whole number, not 1.5");
    EXPECT_EQ(chain_error(R"(, "priority": -1)"), "chains[0].priority: -1 is not between 0 and 255");
    EXPECT_EQ(chain_error(R"(, "tolerance": -1)"), "chains[0].tolerance: -1.0 is less than 0.0");
    EXPECT_EQ(chain_error(R"(, "compress": 2)"), "chains[0].compress: 2.0 is not between 0.0 and 1.0");
    EXPECT_EQ(chain_error(R"(, "weights": {"a b": 2})"), "chains[0].weights.'a b': 2 is not between 0 and 1");
    EXPECT_EQ(chain_error(R"(, "solver": "IK")").substr(0, 40), "chains[0].solver: 'IK' is none of any, p");
    EXPECT_EQ(chain_error(R"(}, {"name": "c", "start": "s", "effector": "e")"),
              "chains[1].name: there is an earlier chain 'c'");
}

TEST(ParseRig, BadFilesNameTheirPlace) {
    const auto error = [](const std::string& text) {
        return failure_of([&] {
            Report report;
            parse_rig(text, report);
        });
    };
    EXPECT_EQ(error(""), "invalid JSON: the text is empty");
    EXPECT_EQ(error("{}"), "bendy_rig: it is required and missing");
    EXPECT_EQ(error("[]"), "it must be an object, not array");
    EXPECT_EQ(error(R"({"bendy_rig": 2})"), "bendy_rig: layout 2 is not supported, only 1");
    EXPECT_EQ(
        error(R"({"bendy_rig": 1, "chain": []})"),
        "chain: there is no such key; there are bendy_rig, complete, joints, chains, roles, standing_pose, markers, "
        "curves, $schema");
    EXPECT_EQ(error(R"({"bendy_rig": 1, "bendy_rig": 1})"), "bendy_rig: it stands twice");
    EXPECT_EQ(error(R"({"bendy_rig": 1, "joints": {"a": [], "b": [], "a": []}})"), "joints.a: it stands twice");
    EXPECT_EQ(error("{\n  \"bendy_rig\" 1}").substr(0, 41), "invalid JSON at line 2, column 15 (byte 1");
    EXPECT_EQ(error(R"({"bendy_rig": NaN})").substr(0, 22), "invalid JSON at line 1");
    EXPECT_NE(error(R"({"bendy_rig": 1e999})").find("number overflow"), std::string::npos);
    EXPECT_EQ(error(std::string(1'000'000, '[')).substr(0, 31), "the JSON is nested deeper than ");
    EXPECT_NE(error("{\"bendy_rig\": 1, \"joints\": {\"\xff\": []}}").find("UTF-8"), std::string::npos);
    EXPECT_EQ(error(R"({"bendy_rig": 1, "complete": 3})"), "complete: it must be true or false, not 3");
    EXPECT_EQ(error(R"({"bendy_rig": 1, "joints": []})"), "joints: it must be an object, not array");
    EXPECT_EQ(error(R"({"bendy_rig": 1, "joints": {"a[": []}})"), "joints.'a[': it has a [ without a ]");
    EXPECT_EQ(error(R"({"bendy_rig": 1, "$schema": "rig.schema.json"})"), "no error");
}

TEST(ParseRig, EveryPrefixIsRefused) {
    const std::string text = rig_text(R"("joints": {"a*": {"model": "hinge", "x": [0, 1]}}, "chains": [])");
    for (std::size_t size = 0; size < text.size(); ++size) {
        Report report;
        EXPECT_NE(failure_of([&] { parse_rig(text.substr(0, size), report); }), "no error") << size;
    }
}

}  // namespace
}  // namespace bendy::converter::parse_rig_test
