#include "scene/source/normalise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

namespace bendy::converter::transform_test {
namespace {

/// T * R * U, column-major, in double.
std::array<double, 16> compose(const Transform& t) {
    const double x = t.rotation.x;
    const double y = t.rotation.y;
    const double z = t.rotation.z;
    const double w = t.rotation.w;
    const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    const double u[3][3] = {{t.scale.x, t.shear.x, t.shear.y}, {0, t.scale.y, t.shear.z}, {0, 0, t.scale.z}};
    std::array<double, 16> m{};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            for (std::size_t k = 0; k < 3; ++k) m[column * 4 + row] += r[row][k] * u[k][column];
        }
        m[12 + row] = t.translation[static_cast<int>(row)];
    }
    m[15] = 1;
    return m;
}

void expect_recomposed(const std::array<double, 16>& matrix) {
    const auto again = compose(decompose(matrix));
    double largest = 1e-30;
    for (std::size_t i = 0; i < 12; ++i) largest = std::max(largest, std::abs(matrix[i]));
    for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(again[i], matrix[i], 5e-7 * largest) << i;
    for (std::size_t i = 12; i < 15; ++i) EXPECT_EQ(again[i], matrix[i]);
}

/// Rows as one writes them, with translation 1 2 3.
std::array<double, 16> matrix_of(const std::array<double, 9>& rows) {
    return {rows[0], rows[3], rows[6], 0, rows[1], rows[4], rows[7], 0, rows[2], rows[5], rows[8], 0, 1, 2, 3, 1};
}

TEST(GltfTransform, OrdinaryMatricesHaveNoShear) {
    const double s = std::sqrt(0.5);
    const Transform t = decompose(matrix_of({2 * s, -3 * s, 0, 2 * s, 3 * s, 0, 0, 0, 4}));
    EXPECT_EQ(t.shear, glm::vec3(0));
    EXPECT_NEAR(t.scale.x, 2, 1e-6);
    EXPECT_NEAR(t.scale.y, 3, 1e-6);
    EXPECT_NEAR(t.scale.z, 4, 1e-6);
    EXPECT_NEAR(t.rotation.z, std::sin(std::acos(-1.0) / 8), 1e-7);
    EXPECT_EQ(t.translation, glm::vec3(1, 2, 3));
}

/// The number in the nearest text of that `printf` format.
double written(const char* format, double number) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, number);
    return std::strtod(text.data(), nullptr);
}

TEST(GltfTransform, ShearThatRoundingToDigitsMakesIsNone) {
    std::mt19937 random(57);
    std::normal_distribution<float> normal;
    const auto shear_of = [&](const char* format, const glm::vec3& scale, float shear) {
        Transform t;
        t.rotation = make_unit({normal(random), normal(random), normal(random), normal(random)}).value;
        t.scale = scale;
        t.shear = {shear, 0, 0};
        auto matrix = compose(t);
        for (double& number : matrix) number = written(format, number);
        return glm::length(decompose(matrix).shear) / scale.x;
    };
    for (int i = 0; i < 1000; ++i) {
        for (const char* format : {"%.6f", "%.6g", "%.5f", "%.4f", "%.5e"}) {
            EXPECT_EQ(shear_of(format, glm::vec3(1), 0.0f), 0.0f) << format;
            EXPECT_EQ(shear_of(format, {2.54f, 30.0f, 100.0f}, 0.0f), 0.0f) << format;
            EXPECT_NEAR(shear_of(format, glm::vec3(1), 0.002f), 0.002f, 2e-4) << format;
        }
        EXPECT_EQ(shear_of("%.6f", glm::vec3(0.01f), 0.0f), 0.0f);
        EXPECT_EQ(shear_of("%.6g", glm::vec3(0.01f), 0.0f), 0.0f);
        EXPECT_NEAR(shear_of("%.9f", glm::vec3(1), 1e-5f), 1e-5f, 5e-7) << "more digits are not rounded";
    }
    EXPECT_EQ(decompose(matrix_of({1, 0.00001, 0, 0, 1, 0, 0, 0, 1})).shear.x, 0.00001f) << "its last digit";
}

TEST(GltfTransform, IdentityStaysExact) {
    const Transform t = decompose(matrix_of({1, 0, 0, 0, 1, 0, 0, 0, 1}));
    EXPECT_EQ(t.rotation, glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(t.scale, glm::vec3(1));
    EXPECT_EQ(t.shear, glm::vec3(0));
}

TEST(GltfTransform, EveryAffineMatrixIsRecomposed) {
    std::uint32_t state = 7;
    for (int i = 0; i < 200; ++i) {
        std::array<double, 9> rows{};
        for (double& value : rows) {
            state = state * 1664525 + 1013904223;
            value = static_cast<double>(state) / 4294967296.0 * 4 - 2;
        }
        expect_recomposed(matrix_of(rows));
    }
}

TEST(GltfTransform, MirroredAndFlatMatricesAreRecomposed) {
    const std::vector<std::array<double, 9>> cases = {
        {-1, 0, 0, 0, 1, 0, 0, 0, 1}, {-1, 0, 0, 0, -1, 0, 0, 0, -1}, {0, 1, 0, 1, 0, 0, 0, 0, 1},
        {1, 0, 0, 0, 0, 0, 0, 0, 1},  {0, 0, 0, 0, 1, 0, 0, 0, 1},    {0, 0, 0, 0, 0, 0, 0, 0, 0},
        {0, 0, 1, 0, 0, 2, 0, 0, 3},  {0, 1, 0, 0, 2, 0, 0, 3, 0},    {1, 2, 3, 2, 4, 6, 3, 6, 9},
        {1, 1, 0, 1, 1, 0, 0, 0, 1},  {1e6, 1, 0, 0, 1, 0, 0, 1, 1},  {1e-9, 0, 0, 0, 1e-9, 0, 0, 0, 1e-9},
        {0, 0, 1, 0, 0, 0, 1, 0, 0},  {0, 5, 5, 0, 0, 5, 0, 0, 0},
    };
    for (const auto& rows : cases) expect_recomposed(matrix_of(rows));
}

TEST(GltfTransform, UnitQuaternionsKeepTheirBits) {
    const float x = 0.6f;
    const float w = 0.8f;
    const UnitQuaternion unit = make_unit({x, 0, 0, w});
    EXPECT_EQ(unit.value, glm::vec4(x, 0, 0, w));
}

TEST(GltfTransform, OtherQuaternionsAreNormalised) {
    EXPECT_EQ(make_unit({0, 0, 0, -2}).value, glm::vec4(0, 0, 0, -1));
    EXPECT_EQ(make_unit({0, 0, 0, -2}).length, 2.0);
    EXPECT_EQ(make_unit({1e-200, 0, 0, 0}).value, glm::vec4(1, 0, 0, 0));
    EXPECT_EQ(make_unit({0, 0, 0, 0}).value, glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(make_unit({0, 0, 0, 0}).length, 0.0);
}

}  // namespace
}  // namespace bendy::converter::transform_test
