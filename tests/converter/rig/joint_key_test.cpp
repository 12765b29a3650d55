#include "build_scene.h"

#include "rigging/rig/joint_key.h"

#include <gtest/gtest.h>

namespace bendy::converter::joint_key_test {
namespace {

using namespace test;
using Kind = JointKey::Kind;

bool does_fit(std::string_view glob, std::string_view name) {
    WorkBudget budget;
    const JointKey key = parse_joint_key(glob, "key");
    EXPECT_EQ(key.kind, Kind::glob) << glob;
    return fits(key.glob, characters_of(name), budget);
}

TEST(RigJointKey, NamesNumbersAndGlobsAreToldApart) {
    EXPECT_EQ(parse_joint_key("Knee", {}).kind, Kind::name);
    EXPECT_EQ(parse_joint_key("", {}).kind, Kind::name);
    EXPECT_EQ(parse_joint_key("mixamorig:Head", {}).name, "mixamorig:Head");
    EXPECT_EQ(parse_joint_key("#12", {}).kind, Kind::number);
    EXPECT_EQ(parse_joint_key("#12", {}).number, 12u);
    EXPECT_EQ(parse_joint_key("#99999999999999999999999", {}).number, UINT64_MAX);
    EXPECT_EQ(parse_joint_key("#", {}).kind, Kind::name);
    EXPECT_EQ(parse_joint_key("#-1", {}).kind, Kind::name);
    EXPECT_EQ(parse_joint_key("#1x", {}).kind, Kind::name);
    EXPECT_EQ(parse_joint_key("a*", {}).kind, Kind::glob);
    EXPECT_EQ(parse_joint_key("a?", {}).kind, Kind::glob);
    EXPECT_EQ(parse_joint_key("[a]", {}).kind, Kind::glob);
    EXPECT_EQ(parse_joint_key("a]", {}).kind, Kind::name);
}

TEST(RigJointKey, ABackslashTakesTheSpecialMeaning) {
    EXPECT_EQ(parse_joint_key(R"(a\*b\?\[c\\)", {}).name, R"(a*b?[c\)");
    EXPECT_EQ(parse_joint_key(R"(\#12)", {}).name, "#12");
    EXPECT_TRUE(does_fit(R"(\**)", "*x"));
    EXPECT_FALSE(does_fit(R"(\**)", "xx"));
    EXPECT_TRUE(does_fit(R"([\]x])", "]"));
}

TEST(RigJointKey, BrokenKeysAreRefused) {
    const auto error = [](std::string_view key) { return failure_of([&] { parse_joint_key(key, "joints.k"); }); };
    EXPECT_EQ(error(R"(a\)"), "joints.k: it ends in a backslash that escapes nothing");
    EXPECT_EQ(error("[ab"), "joints.k: it has a [ without a ]");
    EXPECT_EQ(error(R"([ab\])"), "joints.k: it has a [ without a ]");
    EXPECT_EQ(error("a[]b"), "joints.k: it has an empty []");
}

TEST(RigJointKey, GlobsFitTheWholeName) {
    EXPECT_TRUE(does_fit("*Knee*", "LeftKnee_01"));
    EXPECT_TRUE(does_fit("*Knee*", "Knee"));
    EXPECT_FALSE(does_fit("*Knee", "Knee_01"));
    EXPECT_FALSE(does_fit("Knee?", "Knee"));
    EXPECT_TRUE(does_fit("*", ""));
    EXPECT_FALSE(does_fit("?", ""));
    EXPECT_TRUE(does_fit("seg_[0123]", "seg_3"));
    EXPECT_FALSE(does_fit("seg_[0-3]", "seg_2"));
    EXPECT_TRUE(does_fit("h?nde", "h\xc3\xa4nde"));  // a character, not a byte
    EXPECT_TRUE(does_fit("h[\xc3\xb6\xc3\xa4]nde", "h\xc3\xa4nde"));
}

/// What a glob means, spelt out.
bool fits_plainly(std::string_view glob, std::string_view name) {
    if (glob.empty()) return name.empty();
    if (glob[0] == '*')
        return fits_plainly(glob.substr(1), name) || (!name.empty() && fits_plainly(glob, name.substr(1)));
    return !name.empty() && (glob[0] == '?' || glob[0] == name[0]) && fits_plainly(glob.substr(1), name.substr(1));
}

TEST(RigJointKey, AllShortGlobsFitWhatTheyMean) {
    const auto texts = [](std::string_view letters, std::size_t longest) {
        std::vector<std::string> all{""};
        for (std::size_t i = 0; i < all.size() && all[i].size() < longest; ++i) {
            for (const char letter : letters) all.push_back(all[i] + letter);
        }
        return all;
    };
    const std::vector<std::string> names = texts("ab", 5);
    for (const std::string& glob : texts("ab*?", 5)) {
        if (glob.find_first_of("*?") == std::string::npos) continue;
        for (const std::string& name : names)
            ASSERT_EQ(does_fit(glob, name), fits_plainly(glob, name)) << glob << ' ' << name;
    }
}

TEST(RigJointKey, AnEscapedNameMeansItself) {
    for (const std::string name :
         {"Knee", "a*b", R"(\)", "[x]", "?", "#7", "#", "#x", "*#7", "=", "=#7", "a=b", "\xc3\xa4"}) {
        const JointKey key = parse_joint_key(escape_joint_name(name), {});
        EXPECT_EQ(key.kind, Kind::name) << name;
        EXPECT_EQ(key.name, name);
    }
}

TEST(RigJointKey, WhatFollowsAnEqualsSignIsAName) {
    for (const std::string name : {"Knee", "a*b", R"(\x)", "[", "#7", "=#7", "7"}) {
        const JointKey key = parse_joint_key('=' + name, {});
        EXPECT_EQ(key.kind, Kind::name) << name;
        EXPECT_EQ(key.name, name);
    }
    EXPECT_TRUE(means_itself("7") && means_itself("#x") && means_itself("a=b"));
    EXPECT_FALSE(means_itself("#7") || means_itself("=7"));
}

TEST(RigJointKey, EndlessWorkIsRefused) {
    const JointKey key = parse_joint_key('*' + std::string(100'000, 'a') + 'b', {});
    const std::u32string name(1'000'000, U'a');
    WorkBudget budget;
    EXPECT_EQ(failure_of([&] { fits(key.glob, name, budget); }),
              "its keys, chains and weights take too long to match with so many joints");
}

}  // namespace
}  // namespace bendy::converter::joint_key_test
