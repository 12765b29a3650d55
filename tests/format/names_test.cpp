#include "source_folder.h"

#include <bendy/format/names.h>

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::names_test {
namespace {

TEST(Names, TextsReferToNamesAndNumbers) {
    std::ifstream file(source_folder() / "tests" / "format" / "name_keys.txt");
    std::vector<std::string> words;
    std::size_t cases = 0;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("//")) continue;
        std::istringstream text(line);
        std::string first;
        text >> first;
        if (first == "names") {
            for (std::string name; text >> name;) words.push_back(name);
            continue;
        }
        std::string expected;
        text >> expected;
        const std::vector<std::string_view> names(words.begin(), words.end());
        const auto found = find_by_key(names, first, "clip");
        const auto all = find_all_by_key(names, first, "clip");
        if (expected == "ambiguous" || expected == "absent") {
            ASSERT_FALSE(found) << first;
            EXPECT_EQ(found.error().is_ambiguous, expected == "ambiguous") << first;
            ASSERT_FALSE(all) << first;
            EXPECT_EQ(all.error().message, found.error().message);
        } else {
            ASSERT_TRUE(found) << first << ": " << found.error().message;
            EXPECT_EQ(std::to_string(*found), expected) << first;
            ASSERT_TRUE(all) << first;
            EXPECT_EQ(all->front(), *found) << first;
        }
        ++cases;
    }
    EXPECT_GT(cases, 20U);
}

TEST(Names, AllThingsWithTheName) {
    const std::vector<std::string_view> names{"0", "0", "Run"};
    EXPECT_EQ(*find_all_by_key(names, "=0", "clip"), (std::vector<std::size_t>{0, 1}));
    EXPECT_EQ(*find_by_key(names, "0", "clip"), 0U);
    EXPECT_TRUE(find_all_by_key(names, "0", "clip").error().is_ambiguous);  // number 0 is but one of them
}

TEST(Names, FaultsSayHowToWriteIt) {
    const std::vector<std::string_view> names{"1", "0", "#9"};
    EXPECT_EQ(find_by_key(names, "0", "clip").error().message,
              "clip \"0\" is ambiguous: =0 is the clip with this name, #0 the clip with this number");
    EXPECT_EQ(find_by_key(names, "#9", "clip").error().message,
              "there is no clip with the number 9; =#9 is the clip called \"#9\"");
    EXPECT_EQ(find_by_key(names, "=3", "clip").error().message,
              "there is no clip \"3\"; there are \"1\", \"0\" and \"#9\"");
}

TEST(Names, ANameInAnotherCaseIsSuggestedHoweverLong) {
    for (const std::size_t length : {std::size_t{4}, std::size_t{1000}}) {
        const std::string name(length, 'a');
        const std::string similar = name + 'b';
        const std::vector<std::string_view> names{similar, name};
        EXPECT_EQ(nearest_name(names, std::string(length, 'A')), name);
    }
    EXPECT_EQ(nearest_name(std::vector<std::string_view>{std::string_view()}, "A"), "");
}

}  // namespace
}  // namespace bendy::names_test
