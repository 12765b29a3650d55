#include <bendy/format/text.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace bendy::text_test {
namespace {

using namespace test;
using namespace std::string_view_literals;

/// The code point by the general rule of UTF-8, in `length` bytes whether or not that is the shortest.
std::string encode(std::uint32_t point, unsigned length) {
    if (length == 1) return {static_cast<char>(point)};
    std::string text;
    for (unsigned k = 0; k + 1 < length; ++k) {
        text.insert(text.begin(), static_cast<char>(0x80u | (point & 0x3fu)));
        point >>= 6;
    }
    constexpr unsigned kLeads[]{0, 0, 0xc0, 0xe0, 0xf0, 0xf8};
    text.insert(text.begin(), static_cast<char>(kLeads[length] | point));
    return text;
}

unsigned shortest(std::uint32_t point) {
    return point < 0x80 ? 1 : point < 0x800 ? 2 : point < 0x10000 ? 3 : 4;
}

TEST(Utf8, AcceptsExactlyTheShortestFormOfEveryScalarValue) {
    for (std::uint32_t point = 0; point < 0x200000; ++point) {
        const bool is_scalar = point <= 0x10ffff && (point < 0xd800 || point > 0xdfff);
        ASSERT_EQ(is_utf8(encode(point, shortest(point))), is_scalar) << std::hex << point;
    }
}

TEST(Utf8, RefusesOverlongForms) {
    for (const std::uint32_t point : {0x00u, 0x2fu, 0x7fu, 0x80u, 0x7ffu, 0x800u, 0xffffu}) {
        for (unsigned length = shortest(point) + 1; length <= 4; ++length) {
            EXPECT_FALSE(is_utf8(encode(point, length))) << std::hex << point << " in " << length << " bytes";
        }
    }
}

TEST(Utf8, RefusesEveryByteThatCannotStandAlone) {
    for (unsigned byte = 0; byte < 256; ++byte)
        EXPECT_EQ(is_utf8(std::string(1, static_cast<char>(byte))), byte < 0x80) << byte;
}

TEST(Utf8, RefusesACharacterThatIsCutOrInterrupted) {
    for (const std::uint32_t point : {0xe9u, 0x20acu, 0x1f98au}) {
        const std::string whole = encode(point, shortest(point));
        for (std::size_t length = 1; length < whole.size(); ++length) {
            EXPECT_FALSE(is_utf8(std::string_view(whole).substr(0, length)))
                << std::hex << point;  // the rest stands behind it
            EXPECT_FALSE(is_utf8(whole.substr(0, length) + "a")) << std::hex << point;
            EXPECT_FALSE(is_utf8("a" + whole.substr(length))) << std::hex << point;
            EXPECT_FALSE(is_utf8(whole.substr(0, length) + whole)) << std::hex << point;
        }
    }
}

TEST(Utf8, RefusesFiveByteFormsAndSurrogatePairs) {
    EXPECT_FALSE(is_utf8("\xf8\x88\x80\x80\x80"));
    EXPECT_FALSE(is_utf8("\xed\xa0\xbd\xed\xb8\x80"));  // CESU-8
}

TEST(Utf8, AcceptsEmptyTextAndZeros) {
    EXPECT_TRUE(is_utf8(""));
    EXPECT_TRUE(is_utf8("a\0b"sv));
}

TEST(FindControl, FindsTheFirstOne) {
    for (unsigned code = 0; code < 0x20; ++code)
        EXPECT_EQ(find_control(std::string("ab") + static_cast<char>(code) + '\n'), 2u) << code;
    EXPECT_EQ(find_control("\x7f"), 0u);
    EXPECT_EQ(find_control("\xc3\xa9\xc2\x80"), 2u);
    EXPECT_EQ(find_control("a\xc2\x9f"), 1u);
}

TEST(FindControl, FindsNoneAmongOtherCharacters) {
    for (const char* text : {"", " a ", "~", "\xc2\xa0", "\xc3\x80", "\xe2\x80\xa8", "\xf0\x9f\x92\x80", "%09"})
        EXPECT_EQ(find_control(text), std::string_view::npos) << text;
}

TEST(ReadText, GivesTheTextInPlace) {
    const Loaded sample(sample_file());
    Faults faults;
    const std::string_view name =
        read_text(sample.tree, find_path(sample.tree, "HEAD/OBJE/SKIN/SKIN[1]"), FourCC("NAME"), faults);
    EXPECT_EQ(name, "tail \xc3\xa9");
    EXPECT_TRUE(faults.empty());
    const auto* start = reinterpret_cast<const std::byte*>(name.data());
    EXPECT_TRUE(start >= sample.file.data() && start < sample.file.data() + sample.file.size());
}

TEST(ReadText, IsEmptyWithoutAFaultWhereThereIsNone) {
    const Loaded sample(sample_file());
    Faults faults;
    EXPECT_EQ(read_text(sample.tree, find_path(sample.tree, "HEAD/TEXT[1]"), FourCC("NAME"), faults), "");
    EXPECT_TRUE(faults.empty());
}

TEST(ReadText, IsEmptyWithAFaultWhereItIsNotUtf8OrEncoded) {
    Node bad = sample();
    at(bad, "HEAD/OBJE/NAME").payload = {std::byte{0xff}};
    at(bad, "HEAD/OBJE/EXTR").flags = 0x0100;
    const Loaded loaded(bad);
    EXPECT_EQ(loaded.lines(), (Lines{"NOT_UTF8 HEAD/OBJE/NAME", "UNSUPPORTED_CODEC HEAD/OBJE/EXTR"}));
    EXPECT_EQ(loaded.document.objects.at(0).name, "");
    EXPECT_EQ(loaded.document.objects.at(0).extras, "");
}

TEST(Utf8, AWrongByteIsFoundAtEveryPlaceOfALongText) {
    for (std::size_t length = 1; length <= 40; ++length) {
        for (std::size_t at = 0; at < length; ++at) {
            std::string text(length, 'a');
            EXPECT_TRUE(is_utf8(text));
            text[at] = '\x80';
            EXPECT_FALSE(is_utf8(text)) << at << " of " << length;
        }
    }
}

}  // namespace
}  // namespace bendy::text_test
