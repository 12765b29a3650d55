#include "round_trip.h"

#include "format/edit_file.h"
#include "format/sample_file.h"

#include <bendy/format/codec.h>

#include <cmath>

namespace bendy::test::edit_test {
namespace {

std::string sample_text() {
    return dumped(sample_file());
}

TEST(EditedText, ALimit) {
    Node root = sample();
    edit<ConstraintRecord>(at(root, "HEAD/OBJE/SKIN/SKIN/PIVO/LIMT[1]"),
                           [](ConstraintRecord& constraint) { constraint.rotation_max[0] = 0.123f; });
    const std::string text = sample_text();
    const std::size_t constraint = text.find("{\"LIMT\"", text.find("{\"LIMT\"") + 1);
    const std::size_t most = text.find("\"rotation_max\": [", constraint);
    ASSERT_NE(most, std::string::npos) << text;
    const std::size_t number = most + std::string_view("\"rotation_max\": [").size();
    const std::string changed = text.substr(0, number) + "0.123" + text.substr(text.find(',', number));
    EXPECT_EQ(assembled(changed), to_file(root));
}

TEST(EditedText, AJointsName) {
    Node root = sample();
    at(root, "HEAD/OBJE/SKIN/SKIN/NAME") = make_leaf(FourCC("NAME"), as_byte_span("R\xc3\xbc"
                                                                                  "cken, the longest of them"));
    EXPECT_EQ(assembled(edited(sample_text(), "\"spine\"", "\"R\\u00fccken, the longest of them\"")), to_file(root));
}

TEST(EditedText, ChunksAddedAndRemoved) {
    Node root = sample();
    Node& clip = child(child(root, "OBJE"), "CYCL");
    const std::vector<std::byte> bytes{std::byte{1}, std::byte{0xab}, std::byte{0xff}};
    clip.children.insert(clip.children.begin(), make_leaf(FourCC("MARK"), bytes));
    clip.children.insert(clip.children.begin(),
                         make_container(FourCC("XTR1"), {make_leaf(FourCC("XTR2"), {}, kRequiredFlag)}));
    remove(root, "EXTN");
    std::string text =
        edited(sample_text(), "{\"CYCL\": [",
               R"({"CYCL": [ {"XTR1": [{"required": true, "XTR2": {"hex": ""}}]}, {"MARK": {"hex": ["01", "AbfF"]}},)");
    const std::size_t extension = text.rfind("\n {\"EXTN\"");
    ASSERT_NE(extension, std::string::npos);
    const std::size_t next = text.find('\n', extension + 1);
    text.erase(extension, next - extension);
    EXPECT_EQ(assembled(text), to_file(root));
}

/// The sample with markers, as a file.
Buffer marked(const std::vector<MarkerRecord>& markers, std::string_view names) {
    Node root = sample();
    at(root, "HEAD/OBJE/CYCL").children.push_back(make_leaf(FourCC("MARK"), markers_payload(markers, names)));
    return to_file(root);
}

/// A marker is renamed, moved, added: where names end need not be told.
TEST(EditedText, Markers) {
    const std::string text = dumped(marked({{0.5f, 4}, {0.75f, 4}}, "step"));
    const std::string as_it_is = R"({"seconds": 0.75, "name": ""})";
    ASSERT_NE(text.find(R"({"seconds": 0.5, "name": "step"})"), std::string::npos) << text;
    EXPECT_EQ(assembled(edited(text, as_it_is, R"({"name": "h\u00e9 \"hit\"", "seconds": 0.8})")),
              marked({{0.5f, 4}, {0.8f, 13}}, "steph\xc3\xa9 \"hit\""));
    EXPECT_EQ(assembled(edited(text, as_it_is, as_it_is + R"(, {"seconds": 1, "name": "\u0000"})")),
              marked({{0.5f, 4}, {0.75f, 4}, {1.0f, 5}}, std::string_view("step\0", 5)));
}

/// Members may be given in another order, by a program that sorts them.
TEST(EditedText, MembersInAnyOrder) {
    const auto file = assembled(R"({"HEAD": [
        {"required": true, "POSI": {"values": [1, 2, 3], "set": 0, "elements": 1, "components": 3, "normalised": 0,
                                    "component_type": 5}},
        {"OBJE": [], "required": true}], "$schema": "text.schema.json", "bendy_text": 1})");
    const std::vector<float> values{1.0f, 2.0f, 3.0f};
    const StreamRecord record{5, 0, 3, 1, 0, 0};
    const Bytes pieces[] = {bytes_of(record), bytes_of_all(values)};
    ChunkWriter writer;
    writer.begin(FourCC("HEAD"));
    writer.leaf(FourCC("POSI"), pieces, kRequiredFlag);
    writer.begin(FourCC("OBJE"), kRequiredFlag);
    writer.end();
    writer.end();
    EXPECT_EQ(file, std::move(writer).finish());
}

TEST(EditedText, WhatIsPastAShorterRecordMayBeLeftOut) {
    const std::string text = R"({"bendy_text": 1, "HEAD": [{"REST": {"rotation": [0, 0, 0, 1], "translation": [0, 0, 0],
        "scale": [1, 1, 1]}}]})";
    EXPECT_EQ(assembled(text).size(), 16u + 16 + 48);
    EXPECT_EQ(assembled(edited(text, "[1, 1, 1]", "[1, 1, 1], \"shear\": [0, 0, 0]")).size(), 16u + 16 + 64);
}

class EncodedText : public testing::Test {
protected:
    EncodedText() {
        for (int k = 0; k < 3000; ++k) values_.push_back(std::round(100.0f * std::sin(static_cast<float>(k))) / 8.0f);
        values_[7] = 1234.5f;
        const auto encoded = encode_payload(Codec::vertices_zstd, bytes_of_all(values_), 0, 12);
        EXPECT_TRUE(encoded);
        root_ = make_container(FourCC("HEAD"), {make_leaf(FourCC("KEYV"), *encoded, 0x0300)});
    }
    std::vector<float> values_;
    Node root_;
};

TEST_F(EncodedText, AChangedNumberIsEncodedAnew) {
    const auto file = assembled(edited(dumped(to_file(root_)), "1234.5", "4321.5"));
    values_[7] = 4321.5f;
    const auto encoded = encode_payload(Codec::vertices_zstd, bytes_of_all(values_), 0, 12);
    ASSERT_TRUE(encoded);
    EXPECT_EQ(file, to_file(make_container(FourCC("HEAD"), {make_leaf(FourCC("KEYV"), *encoded, 0x0300)})));
}

/// 3001 numbers are no rows of three.
TEST_F(EncodedText, WhatTheCodecCannotTakeIsStoredPlainly) {
    const auto file = assembled(edited(dumped(to_file(root_)), "1234.5", "1234.5, 1"));
    values_.insert(values_.begin() + 8, 1.0f);
    EXPECT_EQ(file, to_file(make_container(FourCC("HEAD"), {make_leaf(FourCC("KEYV"), bytes_of_all(values_))})));
}

/// Corners of triangles, which the index codecs may turn round.
TEST(EncodedIndices, AChangedOneKeepsItsValue) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t k = 0; k < 300; ++k) indices.insert(indices.end(), {k, k + 1, k + 2});
    const auto canonical = canonical_triangles(indices);
    ASSERT_TRUE(canonical);
    const StreamRecord record{4, 0, 1, 900, 0, 0};
    std::vector<std::byte> payload(sizeof record);
    std::memcpy(payload.data(), &record, sizeof record);
    const Bytes numbers = bytes_of_all(*canonical);
    payload.insert(payload.end(), numbers.begin(), numbers.end());
    const auto encoded = encode_payload(Codec::indices, payload, sizeof record, 4);
    ASSERT_TRUE(encoded);
    const Buffer file = to_file(make_container(FourCC("HEAD"), {make_leaf(FourCC("INDX"), *encoded, 0x0400)}));
    expect_same_bytes(file);
    std::string text = dumped(file);
    const std::size_t last = text.find("\n", text.find("\"values\": [") + 12);
    text.insert(last, "2, 0, 1,").replace(text.find("\"elements\": 900"), 15, "\"elements\": 903");
    const auto changed = assembled(text);
    auto tree = read_chunk_tree(changed);
    ASSERT_TRUE(tree);
    decode_leaves(*tree);
    const Bytes now = tree->payload(1);
    ASSERT_EQ(now.size(), 16u + 903 * 4);
    const auto found = view_at<std::uint32_t>(now, 16, 903);
    std::vector<std::uint32_t> wanted = *canonical;
    wanted.insert(wanted.begin() + 3, {2, 0, 1});
    EXPECT_TRUE(std::equal(found.begin(), found.end(), wanted.begin(), wanted.end()));
}

}  // namespace
}  // namespace bendy::test::edit_test
