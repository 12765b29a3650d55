#include <bendy/converter/report.h>

#include "gltf/build_gltf.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

namespace bendy::converter::report_test {
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

TEST(Report, OptionsAreNamedAsTheInterfaceWritesThemButNotInAFilesTexts) {
    constexpr std::string_view kMessage =
        R"(joint "a --merge-clips \" --b": --merge-clips makes (--root x) -- one--two)";
    EXPECT_EQ(with_option_names(kMessage, OptionStyle::program), kMessage);
    EXPECT_EQ(with_option_names(kMessage, OptionStyle::python),
              R"(joint "a --merge-clips \" --b": merge_clips makes (root x) -- one--two)");
    EXPECT_EQ(with_option_names("'x --a-b' is outside the source's folder: --root allows it", OptionStyle::python),
              "'x --a-b' is outside the source's folder: root allows it");
    EXPECT_EQ(with_option_names("--ticks-per-second", OptionStyle::javascript), "ticksPerSecond");
    Report report(OptionStyle::javascript);
    report.warn("no rate; --ticks-per-second sets one");
    report.suggest("--merge-clips");
    EXPECT_EQ(report.warnings()[0].message, "no rate; ticksPerSecond sets one");
    EXPECT_EQ(report.suggestions()[0], "mergeClips");
}

TEST(Report, AFileIsNotedOnceAsItWasBeforeItWasRead) {
    const std::filesystem::path file = test::test_folder() / "file";
    Report report;
    report.add_source(file);
    std::ofstream(file) << "seven b";
    report.add_source(file);
    report.add_source(file.parent_path());
    ASSERT_EQ(report.sources().size(), 2u);
    EXPECT_EQ(report.sources()[0].file, file);
    EXPECT_FALSE(report.sources()[0].stamp.is_there);
    EXPECT_FALSE(report.sources()[1].stamp.is_there);  // a folder is no file
    Report later;
    later.add_source(file);
    EXPECT_EQ(later.sources()[0].stamp, stamp_of(file));
    EXPECT_EQ(later.sources()[0].stamp.size, 7u);
    std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) - std::chrono::hours(1));
    EXPECT_NE(later.sources()[0].stamp, stamp_of(file));
}

TEST(Report, StartsEmpty) {
    EXPECT_TRUE(Report().warnings().empty());
}

}  // namespace
}  // namespace bendy::converter::report_test
