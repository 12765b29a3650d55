#include <bendy/runtime/constrain.h>

#include "source_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>

// Rotations that Blender limited: tests/blender/cases.json says what its fields mean, make_cases.py makes it.
namespace bendy::blender_cases_test {
namespace {

using Json = nlohmann::json;

double angle_of(const glm::dquat& a, const glm::dquat& b) {
    const glm::dquat d = glm::conjugate(a) * b;
    return 2.0 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::abs(d.w));
}

ConstraintRecord record_of(const Json& limit) {
    constexpr std::array<std::string_view, 6> kOrders{"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"};
    ConstraintRecord record;
    const bool is_box = limit.at("model") == "euler_box";
    record.model =
        static_cast<std::uint8_t>(is_box ? ConstraintModel::euler_box : ConstraintModel::swing_twist_ellipse);
    if (is_box) {
        const auto order = std::find(kOrders.begin(), kOrders.end(), limit.at("order").get<std::string>());
        record.euler_order = static_cast<std::uint8_t>(order - kOrders.begin());
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto range = limit.find(std::string(1, "xyz"[axis]));
        if (range == limit.end()) continue;
        record.rotation_min[axis] = range->at(0).get<float>();
        record.rotation_max[axis] = range->at(1).get<float>();
    }
    if (limit.contains("frame")) record.frame = limit.at("frame").get<std::array<float, 4>>();
    return record;
}

/// R of a rotation relative to rest, x y z w.
glm::dquat limited_part(const Constraint& constraint, const Json& q) {
    const auto v = q.get<std::array<double, 4>>();
    return glm::normalize(glm::conjugate(constraint.frame) * glm::dquat(v[3], v[0], v[1], v[2]) * constraint.frame);
}

TEST(BlenderCases, AreLegalAndNearestWhereTheySaySo) {
    std::ifstream file(source_folder() / "tests/blender/cases.json");
    const Json document = Json::parse(file);
    const double tolerance = document.at("tolerance").get<double>();
    ASSERT_LE(tolerance, 1e-4);  // radians
    int cases = 0;
    int same = 0;
    double worst_same = 0.0;
    double worst_legal = 0.0;
    for (const Json& entry : document.at("cases")) {
        const Constraint constraint = make_constraint({0, 0, record_of(entry.at("limit"))});
        const glm::dquat asked = limited_part(constraint, entry.at("in"));
        const glm::dquat got = limited_part(constraint, entry.at("out"));
        const glm::dquat clamped = clamp_rotation(constraint, asked);
        ++cases;
        EXPECT_LE(violation(constraint, got), tolerance) << entry;
        EXPECT_LE(angle_of(clamped, asked), angle_of(got, asked) + tolerance) << entry;
        worst_legal = std::max(worst_legal, violation(constraint, got));
        if (!entry.at("same").get<bool>()) continue;
        ++same;
        EXPECT_LE(angle_of(clamped, got), tolerance) << entry;
        worst_same = std::max(worst_same, angle_of(clamped, got));
    }
    EXPECT_GE(cases, 250);
    EXPECT_GE(same, 150);
    RecordProperty("worst_same", std::to_string(worst_same));
    RecordProperty("worst_legal", std::to_string(worst_legal));
}

}  // namespace
}  // namespace bendy::blender_cases_test
