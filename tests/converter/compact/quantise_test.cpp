#include "optimise/compact/quantise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace bendy::converter::quantise_test {
namespace {

std::vector<float> numbers(std::size_t count, float low, float high, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> values(count);
    for (float& value : values) value = low + (high - low) * (static_cast<float>(random() % 65536) / 65535.0f);
    return values;
}

/// The largest distance of an element from its source, read as any reader would.
double worst_of(const StoredStream& stream, const std::vector<float>& values) {
    const StreamView view = stream.view();
    double worst = 0.0;
    for (std::uint32_t e = 0; e < view.elements; ++e) {
        double square = 0.0;
        for (std::uint32_t c = 0; c < view.components; ++c) {
            const double d = double{view.number(e, c)} - values[std::size_t{e} * view.components + c];
            square += d * d;
        }
        worst = std::max(worst, std::sqrt(square));
    }
    return worst;
}

TEST(Quantise, BoxedNumbersKeepTheirBoundAtEveryScale) {
    for (const float scale : {1e-20f, 1e-6f, 1.0f, 1e4f, 1e20f}) {
        for (const double share : {0.1, 1e-3, 3e-5}) {
            const auto values = numbers(999, -scale, scale, 5);
            const double bound = share * scale;
            const auto stream = quantise_boxed(values, 3, bound);
            ASSERT_TRUE(stream) << scale << ' ' << share;
            EXPECT_LE(worst_of(*stream, values), bound);
            EXPECT_EQ(stream->type, share > 0.01 ? ComponentType::u8 : ComponentType::u16);
        }
        const auto fine = numbers(999, -scale, scale, 5);
        EXPECT_FALSE(quantise_boxed(fine, 3, 3e-6 * scale)) << "too fine for 16 bits";
        const auto wide = quantise_boxed(fine, 3, 3e-6 * scale, true);
        ASSERT_TRUE(wide);
        EXPECT_EQ(wide->type, ComponentType::u32);
        EXPECT_LE(worst_of(*wide, fine), 3e-6 * scale);
        EXPECT_FALSE(quantise_boxed(fine, 3, 1e-9 * scale, true)) << "too fine for 24 bits";
    }
}

TEST(Quantise, FarFromTheOriginTheFloatsDecide) {
    const auto values = numbers(300, 1e6f, 1e6f + 1.0f, 2);
    // Floats there are 0.06 apart: finer steps come out on the floats themselves.
    const auto fine = quantise_boxed(values, 3, 1e-3);
    ASSERT_TRUE(fine);
    EXPECT_EQ(worst_of(*fine, values), 0.0);
    const auto coarse = quantise_boxed(values, 3, 0.3);
    ASSERT_TRUE(coarse);
    EXPECT_LE(worst_of(*coarse, values), 0.3);
}

TEST(Quantise, FlatAndSingleAndEmptyBoxes) {
    std::vector<float> flat = numbers(300, -1, 1, 9);
    for (std::size_t at = 1; at < flat.size(); at += 3) flat[at] = 0.7f;
    const auto stream = quantise_boxed(flat, 3, 1e-3);
    ASSERT_TRUE(stream);
    EXPECT_LE(worst_of(*stream, flat), 1e-3);
    for (std::uint32_t e = 0; e < 100; ++e) EXPECT_EQ(stream->view().number(e, 1), 0.7f);
    const std::vector<float> one{1.5f, -2.5f, 3.5f};
    ASSERT_TRUE(quantise_boxed(one, 3, 1e-9));
    EXPECT_EQ(worst_of(*quantise_boxed(one, 3, 1e-9), one), 0.0);
    EXPECT_EQ(worst_of(*quantise_boxed(one, 3, 0.0), one), 0.0);
    EXPECT_FALSE(quantise_boxed(std::vector<float>{}, 3, 1.0));
    EXPECT_FALSE(quantise_boxed(numbers(30, 0, 1, 1), 3, 0.0));
}

TEST(Quantise, ShiftsThatAreZeroStayZero) {
    std::mt19937 random(4);
    std::vector<glm::vec3> shifts(200, glm::vec3(0.0f));
    for (std::size_t k = 0; k < shifts.size(); k += 2) {
        for (int c = 0; c < 3; ++c) shifts[k][c] = static_cast<float>(random() % 2001) / 1000.0f - 1.0f;
    }
    for (const double bound : {0.02, 1e-3}) {
        const auto stream = quantise_shifts(shifts, bound);
        ASSERT_TRUE(stream);
        EXPECT_EQ(stream->type, bound > 0.01 ? ComponentType::i8 : ComponentType::i16);
        for (std::uint32_t k = 0; k < shifts.size(); ++k) {
            const glm::vec3 d = stream->view().vec3(k) - shifts[k];
            EXPECT_LE(std::sqrt(double{d.x} * d.x + double{d.y} * d.y + double{d.z} * d.z), bound);
            if (k % 2 == 0) continue;
            EXPECT_EQ(stream->view().vec3(k), glm::vec3(0.0f));
        }
    }
}

TEST(Quantise, NormalsOfEightBitsAreWithinTwoThirdsOfADegree) {
    std::mt19937 random(8);
    std::normal_distribution<float> spread;
    std::vector<glm::vec3> normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {0, 0, 0}};
    while (normals.size() < 5000) {
        const glm::dvec3 v(spread(random), spread(random), spread(random));
        const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
        normals.emplace_back(glm::vec3(v / length));
    }
    for (const auto& [bits, degrees] : {std::pair{8u, 0.66}, std::pair{10u, 0.17}, std::pair{16u, 0.01}}) {
        const auto stream = quantise_normals(normals, bits);
        ASSERT_TRUE(stream);
        double worst = 0.0;
        for (std::uint32_t k = 0; k < normals.size(); ++k) {
            const glm::dvec3 a(normals[k]);
            const glm::dvec3 b(stream->view().vec3(k));
            if (k == 4) {
                EXPECT_EQ(b, glm::dvec3(0.0));
                continue;
            }
            const glm::dvec3 d = a - b;
            worst = std::max(worst, std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z));
        }
        EXPECT_LE(worst, degrees * 3.14159265 / 180.0) << bits;
    }
    EXPECT_EQ(quantise_normals(normals, 8)->view().vec3(0), normals[0]);
    EXPECT_EQ(quantise_normals(normals, 8)->view().vec3(3), normals[3]);
    normals.emplace_back(0, 2, 0);
    EXPECT_FALSE(quantise_normals(normals, 8)) << "no unit vector";
}

TEST(Quantise, TangentsKeepTheirHandedness) {
    const std::vector<glm::vec4> tangents{{1, 0, 0, 1}, {0, 0, -1, -1}};
    const auto stream = quantise_tangents(tangents, 8);
    ASSERT_TRUE(stream);
    EXPECT_EQ(stream->view().vec4(0), tangents[0]);
    EXPECT_EQ(stream->view().vec4(1), tangents[1]);
    EXPECT_FALSE(quantise_tangents(std::vector<glm::vec4>{{1, 0, 0, 0.5f}}, 8));
}

TEST(Quantise, WeightsSumToOneExactly) {
    std::mt19937 random(6);
    for (const std::uint32_t levels : {255u, 65535u}) {
        for (int round = 0; round < 2000; ++round) {
            std::vector<float> weights(1 + random() % 8);
            double sum = 0.0;
            for (float& weight : weights)
                sum += weight = random() % 3 == 0 ? 0.0f : static_cast<float>(random() % 1000);
            if (sum == 0.0) continue;
            for (float& weight : weights) weight = static_cast<float>(weight / sum);
            std::vector<std::uint32_t> integers(weights.size());
            quantise_weights(weights, levels, integers);
            EXPECT_EQ(std::accumulate(integers.begin(), integers.end(), 0u), levels);
            for (std::size_t k = 0; k < weights.size(); ++k)
                EXPECT_LE(std::abs(weights[k] - static_cast<double>(integers[k]) / levels), 1.0 / levels + 1e-7);
        }
    }
}

}  // namespace
}  // namespace bendy::converter::quantise_test
