#include "scene/stored_numbers.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

namespace bendy::converter::smallest_type_test {
namespace {

/// The stored number as a reader of the format gets it: an integer over its type's largest, or the float.
template <class T>
float number_at(const StoredNumbers& stored, std::size_t place) {
    T value{};
    std::memcpy(&value, stored.bytes.data() + place * sizeof(T), sizeof(T));
    if (std::is_same_v<T, float>) return static_cast<float>(value);
    return static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max());
}

float number_at(const StoredNumbers& stored, std::size_t place) {
    switch (stored.type) {
        case ComponentType::u8:
            return number_at<std::uint8_t>(stored, place);
        case ComponentType::u16:
            return number_at<std::uint16_t>(stored, place);
        default:
            return number_at<float>(stored, place);
    }
}

void expect_same_bits(const StoredNumbers& stored, const std::vector<float>& values) {
    ASSERT_EQ(stored.bytes.size(), values.size() * component_size(stored.type));
    EXPECT_EQ(stored.normalised, stored.type != ComponentType::f32);
    for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(number_at(stored, i)), std::bit_cast<std::uint32_t>(values[i]))
            << "number " << i << ", " << values[i];
    }
}

TEST(SmallestExactFractions, EveryFractionOf255FitsAByte) {
    std::vector<float> values;
    for (int k = 0; k <= 255; ++k) values.push_back(static_cast<float>(k) / 255.0f);
    const StoredNumbers stored = smallest_exact_fractions(values);
    EXPECT_EQ(stored.type, ComponentType::u8);
    expect_same_bits(stored, values);
}

TEST(SmallestExactFractions, EveryFractionOf65535FitsTwoBytes) {
    std::vector<float> values;
    for (int k = 0; k <= 65535; ++k) values.push_back(static_cast<float>(k) / 65535.0f);
    const StoredNumbers stored = smallest_exact_fractions(values);
    EXPECT_EQ(stored.type, ComponentType::u16);
    expect_same_bits(stored, values);
}

TEST(SmallestExactFractions, OneNumberThatDoesNotFitWidensAll) {
    EXPECT_EQ(smallest_exact_fractions(std::vector{0.0f, 1.0f, 51.0f / 255.0f}).type, ComponentType::u8);
    EXPECT_EQ(smallest_exact_fractions(std::vector{0.0f, 1.0f, 12345.0f / 65535.0f}).type, ComponentType::u16);
    const std::vector<float> values{0.0f, 1.0f, 51.0f / 255.0f, 1.0f / 3.0f, 0.1f};
    const StoredNumbers stored = smallest_exact_fractions(values);
    EXPECT_EQ(stored.type, ComponentType::f32);
    expect_same_bits(stored, values);
}

TEST(SmallestExactFractions, ANeighbourOfAFractionIsNone) {
    for (const float fraction : {51.0f / 255.0f, 1.0f, 12345.0f / 65535.0f}) {
        for (const float value : {std::nextafter(fraction, 0.0f), std::nextafter(fraction, 2.0f)}) {
            const std::vector<float> values{value};
            const StoredNumbers stored = smallest_exact_fractions(values);
            EXPECT_EQ(stored.type, ComponentType::f32) << value;
            expect_same_bits(stored, values);
        }
    }
}

TEST(SmallestExactFractions, NumbersOutsideZeroToOneStayFloats) {
    for (const float value : {-0.0f, -1.0f / 255.0f, 1.5f, 2.0f, 256.0f / 255.0f, 1e30f, -1e30f, 1e-30f,
                              std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::max()}) {
        const std::vector<float> values{0.0f, value};
        const StoredNumbers stored = smallest_exact_fractions(values);
        EXPECT_EQ(stored.type, ComponentType::f32) << value;
        expect_same_bits(stored, values);
    }
}

TEST(SmallestExactFractions, NumbersThatAreNotFiniteStayAsTheyAre) {
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity()}) {
        const std::vector<float> values{value};
        const StoredNumbers stored = smallest_exact_fractions(values);
        EXPECT_EQ(stored.type, ComponentType::f32);
        expect_same_bits(stored, values);
    }
}

TEST(SmallestExactFractions, AnythingComesBackToTheBit) {
    std::mt19937 random(1);
    for (int round = 0; round < 200; ++round) {
        const auto largest = static_cast<float>(round % 2 == 0 ? 255 : 65535);
        std::vector<float> values;
        for (int i = 0; i < 20; ++i)
            values.push_back(static_cast<float>(random() % (static_cast<unsigned>(largest) + 1)) / largest);
        if (round % 3 == 0) values.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(random())));
        expect_same_bits(smallest_exact_fractions(values), values);
    }
}

TEST(SmallestExactFractions, NothingIsNothing) {
    EXPECT_TRUE(smallest_exact_fractions({}).bytes.empty());
}

TEST(SmallestExactIndices, TheTypeFollowsFromTheCount) {
    const std::vector<std::uint32_t> values{0, 1};
    struct Case {
        std::uint64_t count;
        bool allow_bytes;
        ComponentType type;
    };
    for (const Case& c :
         {Case{2, true, ComponentType::u8}, Case{256, true, ComponentType::u8}, Case{257, true, ComponentType::u16},
          Case{2, false, ComponentType::u16}, Case{65536, true, ComponentType::u16},
          Case{65536, false, ComponentType::u16}, Case{65537, true, ComponentType::u32},
          Case{65537, false, ComponentType::u32}, Case{0xffff'ffff, false, ComponentType::u32}}) {
        const StoredNumbers stored = smallest_exact_indices(values, c.count, c.allow_bytes);
        EXPECT_EQ(stored.type, c.type) << c.count << ' ' << c.allow_bytes;
        EXPECT_FALSE(stored.normalised);
        EXPECT_EQ(stored.bytes.size(), values.size() * component_size(c.type));
    }
}

TEST(SmallestExactIndices, TheLargestIndexOfEachTypeSurvives) {
    const auto last = [](const StoredNumbers& stored) {
        std::uint32_t value = 0;
        std::memcpy(&value, stored.bytes.data(), stored.bytes.size());
        return value;
    };
    EXPECT_EQ(last(smallest_exact_indices(std::vector<std::uint32_t>{255}, 256, true)), 255u);
    EXPECT_EQ(last(smallest_exact_indices(std::vector<std::uint32_t>{256}, 257, true)), 256u);
    EXPECT_EQ(last(smallest_exact_indices(std::vector<std::uint32_t>{65535}, 65536, false)), 65535u);
    EXPECT_EQ(last(smallest_exact_indices(std::vector<std::uint32_t>{65536}, 65537, false)), 65536u);
    EXPECT_EQ(last(smallest_exact_indices(std::vector<std::uint32_t>{0xffff'fffe}, 0xffff'ffff, false)), 0xffff'fffeu);
}

}  // namespace
}  // namespace bendy::converter::smallest_type_test
