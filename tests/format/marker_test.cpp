#include <bendy/format/clip.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace bendy::marker_test {
namespace {

using namespace test;

const std::string kMark = "HEAD/OBJE/CYCL/MARK";

/// The sample, whose clip lasts from 0.5 s to 1 s, with this payload.
Node marked(const Buffer& payload, std::uint16_t flags = 0) {
    Node root = sample();
    at(root, "HEAD/OBJE/CYCL").children.push_back(make_leaf(FourCC("MARK"), payload, flags));
    return root;
}

Lines faults_with(const Buffer& payload) {
    return faults_in(marked(payload));
}

Lines in_mark(std::initializer_list<const char*> codes) {
    Lines lines;
    for (const char* code : codes) lines.push_back(std::string(code) + " " + kMark);
    return lines;
}

std::vector<Marker> markers_of(const Loaded& loaded) {
    return loaded.document.objects.at(0).clips.at(0).markers;
}

TEST(Markers, GiveTimesAndNames) {
    const Loaded loaded(
        to_file(marked(markers_payload({{0.5f, 4}, {0.75f, 4}, {0.75f, 7}, {1.0f, 11}}, "step\xc3\xa9!stop"))));
    ASSERT_EQ(loaded.lines(), Lines{});
    const std::vector<Marker> markers = markers_of(loaded);
    ASSERT_EQ(markers.size(), 4u);
    EXPECT_EQ(markers[0].seconds, 0.5f);
    EXPECT_EQ(markers[0].name, "step");
    EXPECT_EQ(markers[1].seconds, 0.75f);
    EXPECT_EQ(markers[1].name, "");
    EXPECT_EQ(markers[2].seconds, 0.75f);
    EXPECT_EQ(markers[2].name, "\xc3\xa9!");
    EXPECT_EQ(markers[3].seconds, 1.0f);
    EXPECT_EQ(markers[3].name, "stop");
}

TEST(Markers, AreWrittenAsThePageSays) {
    const std::vector<Marker> markers{{0.5f, "ab"}, {1.0f, ""}, {1.0f, "\xc3\xa9"}};
    EXPECT_EQ(write_markers(markers), markers_payload({{0.5f, 2}, {1.0f, 2}, {1.0f, 4}}, "ab\xc3\xa9"));
    EXPECT_EQ(write_markers({}), markers_payload({}, ""));
}

TEST(Markers, MayBeNone) {
    const Loaded loaded(sample_file());
    EXPECT_TRUE(markers_of(loaded).empty());
    EXPECT_EQ(faults_with(markers_payload({}, "")), Lines{});
}

TEST(Markers, RefuseAPayloadOfAnotherSize) {
    EXPECT_EQ(faults_with({}), in_mark({"RECORD_TOO_SHORT"}));
    Buffer payload = markers_payload({{0.5f, 2}}, "ab");
    payload.push_back(std::byte{0});
    EXPECT_EQ(faults_with(payload), in_mark({"RECORD_SIZE"}));
    payload.resize(payload.size() - 2);
    EXPECT_EQ(faults_with(payload), in_mark({"MARKER_NAME"}));
    payload.resize(15);  // half a marker
    EXPECT_EQ(faults_with(payload), in_mark({"RECORD_SIZE"}));
    EXPECT_EQ(faults_with(markers_payload({}, "a")), in_mark({"RECORD_SIZE"}));
}

TEST(Markers, HoldTheirCountAgainstThePayload) {
    for (const std::uint32_t count : {2u, 3u, 0x2000'0001u, 0xffff'ffffu}) {
        Buffer payload = markers_payload({{0.5f, 1}}, "a");
        std::memcpy(payload.data(), &count, sizeof count);
        EXPECT_EQ(faults_with(payload), in_mark({"RECORD_SIZE"})) << count;
    }
}

TEST(Markers, RefuseNamesThatGoBackOrPastTheEnd) {
    EXPECT_EQ(faults_with(markers_payload({{0.5f, 2}, {0.5f, 1}}, "ab")), in_mark({"MARKER_NAME"}));
    EXPECT_EQ(faults_with(markers_payload({{0.5f, 3}}, "ab")), in_mark({"MARKER_NAME"}));
    EXPECT_EQ(faults_with(markers_payload({{0.5f, 0xffff'ffffu}}, "ab")), in_mark({"MARKER_NAME"}));
}

TEST(Markers, WantEveryNameToBeUtf8) {
    EXPECT_EQ(faults_with(markers_payload({{0.5f, 1}}, "\xff")), in_mark({"NOT_UTF8"}));
    // Together they are.
    EXPECT_EQ(faults_with(markers_payload({{0.5f, 1}, {0.5f, 2}}, "\xc3\xa9")), in_mark({"NOT_UTF8"}));
}

TEST(Markers, RefuseReservedBytes) {
    Buffer payload = markers_payload({{0.5f, 1}}, "a");
    payload[4] = std::byte{1};
    EXPECT_EQ(faults_with(payload), in_mark({"RESERVED_FIELD"}));
}

TEST(Markers, WantTimesToAscendInsideTheClip) {
    EXPECT_EQ(faults_with(markers_payload({{0.75f, 0}, {0.7499f, 0}}, "")), in_mark({"MARKER_ORDER"}));
    EXPECT_EQ(faults_with(markers_payload({{0.4999f, 0}}, "")), in_mark({"MARKER_OUTSIDE"}));
    EXPECT_EQ(faults_with(markers_payload({{1.0001f, 0}}, "")), in_mark({"MARKER_OUTSIDE"}));
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(faults_with(markers_payload({{kNaN, 0}, {0.5f, 0}}, "")),
              in_mark({"NOT_FINITE", "MARKER_ORDER", "MARKER_OUTSIDE"}));
    EXPECT_EQ(faults_with(markers_payload({{0.5f, 0}, {kInfinity, 0}}, "")), in_mark({"NOT_FINITE", "MARKER_OUTSIDE"}));
}

TEST(Markers, AreNotReadFromALeafThatIsStillEncoded) {
    EXPECT_EQ(faults_in(marked(markers_payload({{0.5f, 1}}, "a"), 0xff00)), in_mark({"UNSUPPORTED_CODEC"}));
}

}  // namespace
}  // namespace bendy::marker_test
