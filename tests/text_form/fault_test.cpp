#include "round_trip.h"

#include "format/sample_file.h"

#include <random>

namespace bendy::test::fault_test {
namespace {

/// The text with `chunks` inside HEAD; they begin in column 1 of line 2.
std::string head(std::string_view chunks) {
    return std::string("{\"bendy_text\": 1, \"HEAD\": [\n").append(chunks).append("\n]}\n");
}

struct Case {
    std::string_view chunks, fault;
};

TEST(TextFaults, NameTheirPlace) {
    const Case cases[] = {
        // Its grammar.
        {"{\"NAME\": \"a\"", "3:1: missing a comma or '}' after an object member"},
        {"{\"NAME\": \"a}",
         "2:13: a line break or control character in a string: is its closing quotation mark missing?"},
        {"{NAME: 1}", "2:2: missing a name for object member"},
        {"{\"NAME\": \"\\q\"}", "2:11: invalid escape character in string"},
        {"{\"NAME\": \"\xff\"}", "2:11: invalid encoding in string"},
        {"{\"NAME\": \"h\xc3\xbc\xff\"}", "2:13: invalid encoding in string"},
        {"{\"NAME\": \"\\udc00\"}", "2:10: the string has half of a surrogate pair"},
        {"{\"NAME\": \"\\ud800\"}", "2:11: the surrogate pair in string is invalid"},
        // Chunks.
        {"5", "2:1: there should be a chunk's object, not a number"},
        {"[]", "2:1: there should be a chunk's object, not an array"},
        {"{}", "2:1: the object holds no chunk"},
        {"{\"name\": \"a\"}",
         "2:2: a chunk's name is four capital letters or digits; beside it there may be \"required\", \"codec\" and "
         "\"encoded\""},
        {"{\"NAME\": \"a\", \"NAME\": \"b\"}",
         "2:15: one object is one chunk: a second chunk needs an object of its own"},
        {"{\"NAME\": \"a\", \"required\": 1}", "2:27: \"required\" is true or false"},
        {"{\"required\": true, \"required\": true, \"NAME\": \"a\"}", "2:20: \"required\" appears here twice"},
        {"{\"SKIN\": [], \"codec\": 1}", "2:14: a chunk that holds chunks cannot be encoded"},
        {"{\"codec\": 1, \"SKIN\": []}", "2:22: a chunk that holds chunks cannot be encoded"},
        {"{\"NAME\": \"a\", \"codec\": 1}",
         "2:24: \"codec\" needs \"encoded\" beside it; without both the chunk is stored plainly"},
        {"{\"NAME\": \"a\", \"encoded\": \"00\"}", "2:26: \"encoded\" needs a \"codec\" beside it"},
        {"{\"NAME\": \"a\", \"codec\": 256, \"encoded\": \"00\"}", "2:24: \"codec\" is a whole number from 1 to 255"},
        {"{\"NAME\": \"a\", \"codec\": 0, \"encoded\": \"00\"}", "2:24: \"codec\" is a whole number from 1 to 255"},
        {"{\"NAME\": null}", "2:10: null is for a chunk that has only \"encoded\""},
        {"{\"NAME\": true}", "2:10: a chunk holds an array of chunks, or an object or text, not true or false"},
        // Leaves.
        {"{\"PULL\": \"a\"}", "2:10: there should be an object with fields, not text"},
        {"{\"XTRA\": \"a\"}", "2:10: there should be an object with fields, not text"},
        {"{\"XTRA\": {}}", "2:10: there are no fields: a payload without a form is given as \"hex\""},
        {"{\"XTRA\": {\"hex\": \"abc\"}}", "2:18: the string is not an even number of hexadecimal digits"},
        {"{\"XTRA\": {\"hex\": [\"ab\", \"0g\"]}}", "2:25: the string is not an even number of hexadecimal digits"},
        {"{\"XTRA\": {\"hex\": [\"ab\", 0]}}", "2:25: there should be a string of hexadecimal digits, not a number"},
        {"{\"XTRA\": {\"hex\": \"\", \"a\": 1}}", "2:22: there is no field \"a\" here"},
        {"{\"PULL\": {\"chain\": 0}}", "2:10: \"weight\" is missing"},
        {"{\"MARK\": {\"seconds\": 0}}", "2:10: \"markers\" is missing"},
        {"{\"MARK\": {\"markers\": [{\"seconds\": 1}]}}", "2:23: \"name\" is missing"},
        {"{\"MARK\": {\"markers\": [{\"seconds\": 1, \"name\": 2}]}}",
         "2:46: \"name\": there should be a string, not a number"},
        {"{\"MARK\": {\"markers\": [{\"seconds\": \"1\", \"name\": \"\"}]}}",
         "2:35: \"seconds\": a float is a number, \"inf\", \"-inf\" or \"nan:0x7fc00000\" with the bits of a NaN"},
        {"{\"MARK\": {\"markers\": [{\"seconds\": 1, \"name\": \"\", \"name_end\": 0}]}}",
         "2:50: there is no field \"name_end\" here"},
        {"{\"PULL\": {\"chain\": 0, \"weight\": 1, \"wait\": 2}}", "2:36: there is no field \"wait\" here"},
        {"{\"PULL\": {\"chain\": 0, \"weight\": 1, \"chain\": 2}}", "2:36: \"chain\" appears here twice"},
        {"{\"PULL\": {\"chain\": -1, \"weight\": 1}}", "2:20: \"chain\": the number is out of the range of u32"},
        {"{\"PULL\": {\"chain\": 4294967296, \"weight\": 1}}",
         "2:20: \"chain\": the number is out of the range of u32"},
        {"{\"PULL\": {\"chain\": 1.0, \"weight\": 1}}",
         "2:20: \"chain\": the number must be whole, without a point or exponent"},
        {"{\"PULL\": {\"chain\": 1e3, \"weight\": 1}}",
         "2:20: \"chain\": the number must be whole, without a point or exponent"},
        {"{\"PULL\": {\"chain\": \"inf\", \"weight\": 1}}",
         "2:20: \"chain\": there should be a whole number, not a string"},
        {"{\"PULL\": {\"chain\": 0, \"weight\": 1e39}}", "2:33: \"weight\": the number is out of the range of f32"},
        {"{\"PULL\": {\"chain\": 0, \"weight\": [1]}}", "2:33: \"weight\": there should be a number, not an array"},
        {"{\"PULL\": {\"chain\": 0, \"weight\": \"one\"}}",
         "2:33: \"weight\": a float is a number, \"inf\", \"-inf\" or \"nan:0x7fc00000\" with the bits of a NaN"},
        {"{\"PULL\": {\"chain\": 0, \"weight\": \"nan:0x7f800000\"}}",
         "2:33: \"weight\": a float is a number, \"inf\", \"-inf\" or \"nan:0x7fc00000\" with the bits of a NaN"},
        {"{\"VINF\": {\"vertices\": 1,\n \"joint\": 2, \"more\": \"zz\"}}",
         "3:22: the string is not an even number of hexadecimal digits"},
        {"{\"POSI\": {\"component_type\": 5, \"normalised\": 0, \"components\": 3, \"elements\": 2, \"set\": 0,\n"
         " \"values\": [0, 1, 2, 3, 4]}}",
         "3:12: \"values\" has 5 numbers; the counts beside it ask for 6"},
        {"{\"POSI\": {\"component_type\": 0, \"normalised\": 0, \"components\": 1, \"elements\": 2, \"set\": 0,\n"
         " \"values\": [0, 256]}}",
         "3:16: \"values\": the number is out of the range of u8"},
        {"{\"POSI\": {\"component_type\": 0, \"normalised\": 0, \"components\": 1, \"elements\": 2, \"set\": 0}}",
         "2:10: \"values\" is missing"},
        {"{\"TRAK\": {\"tracks\": [5]}}", "2:22: there should be an object, not a number"},
        {"{\"JNAM\": {\"names\": [\"a\", \"b\\u0000\"]}}",
         "2:26: \"names\": a name in this list cannot hold a zero character"},
        {"{\"REST\": {\"rotation\": [0, 0, 1], \"translation\": [0, 0, 0], \"scale\": [1, 1, 1]}}",
         "2:23: \"rotation\" takes 4 numbers, not 3"},
        {"{\"REST\": {\"rotation\": 1, \"translation\": [0, 0, 0], \"scale\": [1, 1, 1]}}",
         "2:23: \"rotation\": there should be an array of 4 numbers, not a number"},
    };
    for (const Case& each : cases) EXPECT_EQ(fault_of(head(each.chunks)), each.fault) << each.chunks;
}

TEST(TextFaults, OfTheOutermostObject) {
    EXPECT_EQ(fault_of(""), "1:1: the document is empty");
    EXPECT_EQ(fault_of("\n\n  7"), "3:3: the text should be an object that holds HEAD");
    EXPECT_EQ(fault_of("[]"), "1:1: the text should be an object that holds HEAD");
    EXPECT_EQ(fault_of("{\"HEAD\": []}"), "1:1: \"bendy_text\": 1 is missing");
    EXPECT_EQ(fault_of("{\"bendy_text\": 2, \"HEAD\": []}"),
              "1:16: \"bendy_text\" is the version of the text's form, and must be 1");
    EXPECT_EQ(fault_of("{\"bendy_text\": 1, \"SKIN\": []}"), "1:19: the outermost chunk must be HEAD");
    EXPECT_EQ(fault_of("{\"bendy_text\": 1, \"HEAD\": \"a\"}"), "1:1: HEAD must hold an array of chunks");
    EXPECT_EQ(fault_of("{\"bendy_text\": 1, \"HEAD\": []} x"),
              "1:31: the document root must not be followed by other values");
    EXPECT_NE(fault_of(std::string("{\"bendy_text\": 1, \"HEAD\": []}") + '\0'), "");
    EXPECT_EQ(fault_of("\xef\xbb\xbf{\r\n  \"bendy_text\": 1,\r\n \"HEAD\": []\r\n}\r\n"), "");
    EXPECT_EQ(fault_of(head("{\"NAME\": \"h\xc3\xbcgel\", \"x\": 1}")).substr(0, 5), "2:19:")
        << "columns are characters";
}

TEST(TextFaults, TooDeep) {
    const auto nested = [](int levels) {
        std::string text = "{\"bendy_text\": 1, \"HEAD\": [";
        for (int k = 1; k < levels; ++k) text += "{\"SKIN\": [";
        for (int k = 1; k < levels; ++k) text += "]}";
        return text + "]}";
    };
    const auto deepest = assembled(nested(65536));
    EXPECT_TRUE(read_chunk_tree(deepest));
    EXPECT_EQ(fault_of(nested(65537)), "1:655387: chunks are nested deeper than 65536 levels");
}

/// Millions of brackets, in places where the form has none.
TEST(TextFaults, DeepNonsense) {
    constexpr std::size_t kMany = 300'000;
    const std::string arrays(kMany, '[');
    std::string objects;
    for (std::size_t k = 0; k < kMany / 5; ++k) objects += "{\"a\":";
    for (const std::string& nonsense : {arrays, objects}) {
        EXPECT_NE(fault_of(nonsense), "");
        EXPECT_NE(fault_of(head(nonsense)), "");
        EXPECT_NE(fault_of(head("{\"PULL\": {\"chain\": " + nonsense)), "");
        EXPECT_NE(fault_of(head("{\"required\": " + nonsense)), "");
    }
}

TEST(TextFaults, ManyMembersAreNotLookedAtOneByOne) {
    std::string members;
    for (int k = 50'000; k-- > 0;) members += "\"k" + std::to_string(k) + "\": 0, ";
    EXPECT_NE(
        fault_of(head("{\"LODD\": {" + members + "\"meshes\": 0, \"levels\": 0, \"collapses\": [], \"table\": []}}")),
        "");
}

/// No prefix of a text is a text, and none is read past its end: what tells is a sanitizer.
TEST(TextFaults, EveryPrefix) {
    std::string text = dumped(sample_file());
    text.pop_back();  // the line's end
    for (std::size_t size = 0; size < text.size(); size += 1 + size / 100) {
        const std::vector<char> prefix(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_NE(fault_of({prefix.data(), prefix.size()}), "") << size;
    }
}

TEST(TextFaults, RandomChangesNeverGiveAMalformedFile) {
    const std::string text = dumped(sample_file());
    std::mt19937 random(3);  // NOLINT(cert-msc51-cpp): the same changes every time
    constexpr std::string_view kBytes = "{}[]\",:0123456789-.e\\u truefalsn\xff";
    int files = 0;
    for (int k = 0; k < 500; ++k) {
        std::string changed = text;
        for (int times = 1 + static_cast<int>(random() % 2); times-- > 0;)
            changed[random() % changed.size()] = kBytes[random() % kBytes.size()];
        const auto file = text_form::assemble(changed);
        if (!file) continue;
        ++files;
        EXPECT_TRUE(read_chunk_tree(*file));
    }
    EXPECT_GT(files, 15);
}

}  // namespace
}  // namespace bendy::test::fault_test
