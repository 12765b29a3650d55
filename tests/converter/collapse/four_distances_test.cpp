#include "optimise/collapse/distances.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <random>

namespace bendy::converter::four_distances_test {
namespace {

using Places = std::array<glm::vec3, 4>;

FourPlaces four(const Places& places) {
    FourPlaces result;
    for (std::size_t k = 0; k < kFour; ++k) {
        result.x[k] = places[k].x;
        result.y[k] = places[k].y;
        result.z[k] = places[k].z;
    }
    return result;
}

TEST(FourDistances, AreThoseOfClosestPointToTheBit) {
    std::mt19937 random(7);
    // Few different coordinates, so that triangles without area and places on edges and corners are met, too.
    const auto coordinate = [&](bool is_coarse) {
        return is_coarse ? static_cast<float>(random() % 4) - 1.5f : static_cast<float>(random()) * 0x1p-31f - 1.0f;
    };
    for (int round = 0; round < 20000; ++round) {
        std::array<Places, 4> points;
        for (Places& places : points) {
            for (glm::vec3& place : places) {
                for (int axis = 0; axis < 3; ++axis) place[axis] = coordinate(round % 2 == 0);
            }
        }
        const auto& [p, a, b, c] = points;
        const FourFloats distances = four_distances(four(p), four(a), four(b), four(c));
        for (std::size_t k = 0; k < kFour; ++k) {
            const float expected = closest_point(p[k], a[k], b[k], c[k]).distance_squared;
            const float found = distances[k];
            ASSERT_EQ(std::bit_cast<std::uint32_t>(found), std::bit_cast<std::uint32_t>(expected)) << round;
        }
    }
}

}  // namespace
}  // namespace bendy::converter::four_distances_test
