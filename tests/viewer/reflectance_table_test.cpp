#include "shading.h"

#include <gtest/gtest.h>

namespace bendy::viewer::reflectance_table_test {
namespace {

TEST(ReflectanceTable, IsThatOfOthers) {
    // Some of what three.js 0.187 has in src/renderers/shaders/DFGLUTData.js, from other samples: row, column, both
    // numbers.
    struct Known {
        unsigned row;
        unsigned column;
        float scale;
        float bias;
    };
    const std::vector<float> table = reflectance_table(16);
    ASSERT_EQ(table.size(), 512u);
    for (const Known& known :
         {Known{0, 0, 0.14709f, 0.85205f}, Known{0, 5, 0.60205f, 0.32642f}, Known{3, 2, 0.70996f, 0.28125f},
          Known{8, 8, 0.82178f, 0.01651f}, Known{15, 15, 0.34521f, 0.00007f}, Known{4, 15, 0.58398f, 0.01041f}}) {
        const std::size_t at = 2 * (16 * known.row + known.column);
        EXPECT_NEAR(table[at], known.scale, 0.006f) << known.row << ' ' << known.column;
        EXPECT_NEAR(table[at + 1], known.bias, 0.006f) << known.row << ' ' << known.column;
    }
}

TEST(ReflectanceTable, NothingIsMirroredMoreThanOnce) {
    const std::vector<float> table = reflectance_table(8);
    for (std::size_t at = 0; at < table.size(); at += 2) {
        EXPECT_GE(table[at], 0.0f);
        EXPECT_GE(table[at + 1], 0.0f);
        EXPECT_LE(table[at] + table[at + 1], 1.005f);
    }
}

}  // namespace
}  // namespace bendy::viewer::reflectance_table_test
