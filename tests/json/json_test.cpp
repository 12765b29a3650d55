#include <bendy/json/json.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::json_test {
namespace {

using std::string_view_literals::operator""sv;

/// nlohmann/json is the witness: both must read and write each text alike.
template <class Ours, class Theirs>
void expect_same(const std::string& text) {
    const auto theirs = Theirs::parse(text, nullptr, false);
    const auto ours = Ours::parse(text);
    ASSERT_EQ(ours.has_value(), !theirs.is_discarded()) << text;
    EXPECT_EQ(is_json(text), ours.has_value()) << text;
    if (!ours) return;
    for (const int indentation : {-1, 0, 2}) EXPECT_EQ(ours->dump(indentation), theirs.dump(indentation)) << text;
    EXPECT_EQ(ours->dump(-1, true), theirs.dump(-1, ' ', true)) << text;
    EXPECT_EQ(Ours::parse(ours->dump(2)), *ours) << text;
}

void expect_same_in_both_orders(const std::string& text) {
    expect_same<Json, nlohmann::json>(text);
    expect_same<OrderedJson, nlohmann::ordered_json>(text);
}

TEST(Json, ScalarsAreReadAndWrittenAsByNlohmann) {
    for (const char* text : {"null",
                             "true",
                             "false",
                             "0",
                             "-0",
                             "-0.0",
                             "1",
                             "-1",
                             "18446744073709551615",
                             "18446744073709551616",
                             "-9223372036854775808",
                             "-9223372036854775809",
                             "0.1",
                             "1e300",
                             "1e-320",
                             "1E5",
                             "1.0",
                             "123456789.125",
                             R"("")",
                             R"("a\"b\\c\/d\b\f\n\r\t")",
                             R"("\u00e9\u20ac\ud83d\ude00")",
                             "\"\xc3\xa9\xf0\x9f\x98\x80\"",
                             "\"\x7f\"",
                             "[]",
                             "{}",
                             "[[],{}]",
                             R"("\u0000")"})
        expect_same_in_both_orders(text);
}

TEST(Json, WhatIsNotJsonIsRefused) {
    for (const std::string_view text :
         {""sv,        " "sv,   "nul"sv,     "01"sv,         "1."sv,      ".5"sv,       "+1"sv,          "1e"sv,
          "1e999"sv,   "-"sv,   "\"a"sv,     "\"\t\""sv,     "\"\\x\""sv, "\"\xff\""sv, "\"\\ud800\""sv, "[1,]"sv,
          "[1"sv,      "]"sv,   "{\"a\"}"sv, "{\"a\":1,}"sv, "{a:1}"sv,   "{1:1}"sv,    "1 2"sv,         "[] x"sv,
          "// c\n1"sv, "NaN"sv, "[1\0]"sv})
        expect_same_in_both_orders(std::string(text));
}

TEST(Json, FaultsSayWhere) {
    JsonFault fault;
    EXPECT_FALSE(Json::parse("[1, x]", &fault));
    EXPECT_EQ(fault.byte, 5u);
    EXPECT_FALSE(fault.is_out_of_range);
    EXPECT_FALSE(Json::parse("[1e999]", &fault));
    EXPECT_TRUE(fault.is_out_of_range);
    EXPECT_NE(fault.reason.find("1e999"), std::string::npos);
}

/// A random text, with names that are few, so that some are there twice.
class Texts {
public:
    std::string value(int depth) {  // NOLINT(misc-no-recursion): a few levels
        switch (number(depth > 0 ? 7 : 5)) {
            case 0:
                return "null";
            case 1:
                return number(2) == 0 ? "true" : "false";
            case 2:
                return std::to_string(static_cast<std::int64_t>(random_()));
            case 3:
                return nlohmann::json(std::ldexp(static_cast<double>(random_()), number(200) - 164)).dump();
            case 4:
                return '"' + name() + '"';
            case 5: {
                std::string text = "[" + value(depth - 1);
                for (int k = number(4); k > 0; --k) text += " ,\n" + value(depth - 1);
                return text + ']';
            }
            default: {
                std::string text = "{\"" + name() + "\":" + value(depth - 1);
                for (int k = number(6); k > 0; --k) text += ", \"" + name() + "\" : " + value(depth - 1);
                return text + '}';
            }
        }
    }

private:
    int number(int end) { return static_cast<int>(random_() % static_cast<std::uint64_t>(end)); }
    std::string name() {
        return std::vector<std::string>{
            "", "a", "b", "\\u00e9", "z\\n", "\xc3\xa9"}[static_cast<std::size_t>(number(6))];
    }

    std::mt19937_64 random_{5};
};

TEST(Json, RandomTextsAreReadAndWrittenAsByNlohmann) {
    Texts texts;
    for (int round = 0; round < 3000; ++round) expect_same<Json, nlohmann::json>(texts.value(5));
}

TEST(Json, OrderOfMembers) {
    const std::string text = R"({"b":1,"a":2,"b":3})";
    EXPECT_EQ(Json::parse(text).value().dump(), R"({"a":2,"b":3})");
    EXPECT_EQ(OrderedJson::parse(text).value().dump(), text);
    EXPECT_EQ(OrderedJson::parse(text).value()["b"], 1);
    OrderedJson made{{"z", 1}, {"a", 2}};
    made["m"] = 3;
    made.emplace("z", 4);
    EXPECT_EQ(made.dump(), R"({"z":1,"a":2,"m":3})");
}

TEST(Json, ListsInBracesAreObjectsIfAllArePairs) {
    EXPECT_EQ((Json{{"a", 1}, {"b", {1, 2}}}).dump(), R"({"a":1,"b":[1,2]})");
    EXPECT_EQ((Json{{"a", 1}, 2}).dump(), R"([["a",1],2])");
    EXPECT_EQ(Json::array({{"a", 1}}).dump(), R"([["a",1]])");
    EXPECT_EQ(Json(std::vector<float>{0.5f, 1.0f}).dump(), "[0.5,1.0]");
    EXPECT_EQ(Json(std::numeric_limits<double>::infinity()).dump(), "null");
}

TEST(Json, ReferencesToMembersStayWhileOthersAreAdded) {
    Json json;
    Json& first = json["m"];
    for (int k = 0; k < 1000; ++k) json[std::to_string(k)] = k;
    first = "here";
    EXPECT_EQ(json["m"].text(), "here");
    EXPECT_EQ(json.size(), 1001u);
}

TEST(Json, MembersAreTakenOut) {
    Json json{{"a", 1}, {"b", 2}, {"c", 3}, {"d", 4}};
    json.erase_members({"d", "a", "x"});
    EXPECT_EQ(json.dump(), R"({"b":2,"c":3})");
    EXPECT_EQ(json.erase("b"), 1u);
    EXPECT_EQ(json.erase("b"), 0u);
    json.erase(json.find("c"));
    EXPECT_TRUE(json.empty());
}

TEST(Json, ValuesOfOtherTypesThrow) {
    const Json json{{"text", "a"}, {"list", {1, 2}}};
    EXPECT_THROW(static_cast<void>(json.at("none")), JsonError);
    EXPECT_THROW(static_cast<void>(json.at("text").get<int>()), JsonError);
    EXPECT_THROW(static_cast<void>(json.at("list").text()), JsonError);
    EXPECT_THROW(static_cast<void>(json.at("list").at(std::size_t{2})), JsonError);
    EXPECT_THROW(static_cast<void>(json.at("list").at("a")), JsonError);
    EXPECT_THROW(Json(1).push_back(2), JsonError);
    EXPECT_TRUE(json["none"].is_null());
    EXPECT_EQ(json.value("none", "usual"), "usual");
    EXPECT_EQ(json.at("list").get<std::vector<int>>(), (std::vector<int>{1, 2}));
}

TEST(Json, NumbersAreEqualByValue) {
    EXPECT_EQ(Json(1), Json(1.0));
    EXPECT_EQ(Json(1), Json(1u));
    EXPECT_NE(Json(-1), Json(std::numeric_limits<std::uint64_t>::max()));
    EXPECT_NE(Json(1), Json("1"));
    EXPECT_EQ(Json(-3).get<double>(), -3.0);
    EXPECT_EQ(Json(2.75).get<int>(), 2);
}

TEST(Json, TextThatIsNotUtf8IsRefusedOrReplaced) {
    const Json json("a\xff");
    EXPECT_THROW(static_cast<void>(json.dump()), JsonError);
    EXPECT_EQ(json.dump(-1, false, Json::InvalidText::replaced), "\"a\xef\xbf\xbd\"");
    EXPECT_EQ(json.dump(-1, true, Json::InvalidText::replaced), "\"a\\ufffd\"");
}

std::string nested(std::size_t levels) {
    return std::string(levels, '[') + std::string(levels, ']');
}

TEST(Json, NestingIsBounded) {
    EXPECT_TRUE(Json::parse(nested(Json::kMostLevels)));
    JsonFault fault;
    EXPECT_FALSE(Json::parse(nested(Json::kMostLevels + 1), &fault));
    EXPECT_EQ(fault.reason, "it is nested deeper than 1000 levels");
    EXPECT_TRUE(is_json(nested(1'000'000)));
}

TEST(Json, StreamsWriteIt) {
    std::ostringstream out;
    out << Json{{"a", 1}};
    EXPECT_EQ(out.str(), R"({"a":1})");
}

}  // namespace
}  // namespace bendy::json_test
