#include <bendy/runtime/transform.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace bendy::transform_test {
namespace {

using Matrix = std::array<std::array<double, 4>, 4>;  // [row][column], as on paper

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix c{};
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            for (std::size_t k = 0; k < 4; ++k) c[i][j] += a[i][k] * b[k][j];
        }
    }
    return c;
}

/// T * R * U from the definitions.
Matrix reference(const JointTransform& t, const glm::vec3& shear) {
    const double x = t.rotation.x;
    const double y = t.rotation.y;
    const double z = t.rotation.z;
    const double w = t.rotation.w;
    const Matrix translation{
        {{1, 0, 0, t.translation.x}, {0, 1, 0, t.translation.y}, {0, 0, 1, t.translation.z}, {0, 0, 0, 1}}};
    const Matrix rotation{{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 0},
                           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 0},
                           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), 0},
                           {0, 0, 0, 1}}};
    const Matrix upper{
        {{t.scale.x, shear.x, shear.y, 0}, {0, t.scale.y, shear.z, 0}, {0, 0, t.scale.z, 0}, {0, 0, 0, 1}}};
    return product(product(translation, rotation), upper);
}

void expect_matrix(const JointTransform& transform, const glm::vec3& shear) {
    const auto matrix = to_matrix(transform, shear);
    const Matrix expected = reference(transform, shear);
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t column = 0; column < 4; ++column) {
            EXPECT_NEAR(matrix[static_cast<int>(column)][static_cast<int>(row)], expected[row][column], 2e-6)
                << row << ' ' << column;
        }
    }
}

TEST(ToMatrix, ADefaultTransformIsTheIdentity) {
    const auto matrix = to_matrix({}, glm::vec3(0.0f));
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) EXPECT_EQ(matrix[column][row], row == column ? 1.0 : 0.0);
    }
}

TEST(ToMatrix, ScalesThenTurnsThenMoves) {
    JointTransform transform;
    transform.rotation = glm::quat(0.5f, 0.5f, 0.5f, 0.5f);  // x to y, y to z, z to x
    transform.translation = {10, 20, 30};
    transform.scale = {2, 3, 4};
    const auto matrix = to_matrix(transform, glm::vec3(0.0f));
    // (1, 1, 1) is scaled to (2, 3, 4), turned to (4, 2, 3), moved to (14, 22, 33).
    const auto moved = matrix * decltype(matrix[0] * 1.0)(1, 1, 1, 1);
    EXPECT_EQ(moved.x, 14);
    EXPECT_EQ(moved.y, 22);
    EXPECT_EQ(moved.z, 33);
    EXPECT_EQ(moved.w, 1);
}

TEST(ToMatrix, ShearStandsAboveTheDiagonal) {
    JointTransform transform;
    transform.scale = {2, 3, 4};
    const auto matrix = to_matrix(transform, {5, 6, 7});
    EXPECT_EQ(matrix[0][0], 2);  // glm: [column][row]
    EXPECT_EQ(matrix[1][0], 5);
    EXPECT_EQ(matrix[1][1], 3);
    EXPECT_EQ(matrix[2][0], 6);
    EXPECT_EQ(matrix[2][1], 7);
    EXPECT_EQ(matrix[2][2], 4);
    EXPECT_EQ(matrix[0][1], 0);
    EXPECT_EQ(matrix[0][2], 0);
    EXPECT_EQ(matrix[1][2], 0);
}

TEST(ToMatrix, NegativeAndZeroScaleStay) {
    JointTransform transform;
    transform.rotation = glm::quat(0.8f, 0.0f, 0.6f, 0.0f);
    for (const glm::vec3 scale : {glm::vec3(-1, 1, 1), glm::vec3(-2, -3, -4), glm::vec3(0, 1, 1), glm::vec3(0, 0, 0),
                                  glm::vec3(1e-20f, 1, 1e20f)}) {
        transform.scale = scale;
        const Matrix expected = reference(transform, glm::vec3(0.0f));
        const auto matrix = to_matrix(transform, glm::vec3(0.0f));
        for (std::size_t row = 0; row < 4; ++row) {
            for (std::size_t column = 0; column < 4; ++column) {
                const double value = matrix[static_cast<int>(column)][static_cast<int>(row)];
                EXPECT_NEAR(value, expected[row][column], 1e-6 * std::abs(expected[row][column]))
                    << row << ' ' << column;
            }
        }
    }
}

TEST(ToMatrix, AnyTransformAgreesWithTheDefinition) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(-3.0f, 3.0f);
    for (int round = 0; round < 500; ++round) {
        JointTransform transform;
        transform.rotation = glm::normalize(glm::quat(number(random), number(random), number(random), number(random)));
        transform.translation = {number(random), number(random), number(random)};
        transform.scale = {number(random), number(random), number(random)};
        expect_matrix(transform, {number(random), number(random), number(random)});
    }
}

}  // namespace
}  // namespace bendy::transform_test
