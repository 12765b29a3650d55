#include <bendy/converter/report.h>

#include <gtest/gtest.h>

namespace bendy::converter {
namespace {

TEST(Report, EqualMessagesAreCountedTogetherInTheOrderInWhichTheyFirstCame) {
    Report report;
    report.warn("lights are left out", "nodes[3]");
    report.warn("cameras are left out", "nodes[1]", 5);
    report.warn("lights are left out", "nodes[4]");
    report.warn("lights are left out", {}, 10);
    ASSERT_EQ(report.warnings().size(), 2u);
    EXPECT_EQ(report.warnings()[0].message, "lights are left out");
    EXPECT_EQ(report.warnings()[0].first_place, "nodes[3]");
    EXPECT_EQ(report.warnings()[0].count, 12u);
    EXPECT_EQ(report.warnings()[1].message, "cameras are left out");
    EXPECT_EQ(report.warnings()[1].first_place, "nodes[1]");
    EXPECT_EQ(report.warnings()[1].count, 5u);
}

TEST(Report, StartsEmpty) {
    EXPECT_TRUE(Report().warnings().empty());
}

}  // namespace
}  // namespace bendy::converter
