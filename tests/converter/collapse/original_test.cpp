#include "optimise/collapse/deviation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace bendy::converter::original_test {
namespace {

TEST(Original, NeedlesThatOverlapTakeBoundedWork) {
    constexpr std::uint32_t kNeedles = 20'000;
    Surface surface;
    std::vector<glm::vec3> places{{0.0f, 1.0f, 0.0f}};
    for (std::uint32_t k = 0; k < kNeedles; ++k) {
        const float angle = 6.2831853f * static_cast<float>(k) / kNeedles;
        places.emplace_back(std::cos(angle), 0.0f, std::sin(angle));
        Surface::Triangle triangle;
        triangle.vertices = triangle.points = {0, 1 + k, 1 + (k + 1) % kNeedles};
        surface.triangles.push_back(triangle);
    }
    const std::vector<std::vector<glm::vec3>> shapes{places};
    Original original(surface, shapes);
    constexpr std::uint64_t kQueries = 1000;
    for (std::uint32_t k = 0; k < kQueries; ++k) {
        std::uint32_t near = k * (kNeedles / kQueries);
        const glm::vec3 place(0.0f, 0.5f, 0.001f * static_cast<float>(k));
        const float found = original.distance_squared(0, place, 0.0f, near);
        // The cone's surface: at this height its radius is 0.5, and its sides rise by 45 degrees.
        EXPECT_GE(std::sqrt(found), std::abs(0.5f - 0.001f * static_cast<float>(k)) * 0.70f);
    }
    EXPECT_LT(original.work(), 520 * kQueries);  // of kNeedles * kQueries
}

}  // namespace
}  // namespace bendy::converter::original_test
