#include <bendy/format/clip.h>
#include <bendy/format/curve.h>
#include <bendy/format/leaf_parts.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace bendy::curve_test {
namespace {

using namespace test;

const std::string kCurve = "HEAD/OBJE/CYCL/CURV";
constexpr std::array kTimes{0.5f, 0.75f, 1.0f};  // the sample's clip lasts from 0.5 s to 1 s
constexpr std::array kValues{0.0f, 1.0f, 0.25f, 0.5f, 1.0f, -2.0f};
constexpr std::array<std::uint16_t, 6> kPacked{0, 65535, 16384, 54613, 65535, 0};
constexpr std::array kBox{0.0f, -2.0f, 1.0f, 1.0f};

/// Two components, three keys, of joint 1.
CurveView plain_curve() {
    CurveView curve;
    curve.name = "glow";
    curve.path = "extras/glow";
    curve.kind = CurveTarget::joint;
    curve.target = 1;
    curve.components = 2;
    curve.keys = 3;
    curve.times = kTimes;
    curve.values = kValues;
    return curve;
}

CurveView packed_curve() {
    CurveView curve = plain_curve();
    curve.values = {};
    curve.packed = kPacked;
    curve.box = kBox;
    curve.max_error = 0.001f;
    return curve;
}

Buffer payload_of(const CurveView& curve) {
    return write_curve(curve);
}

Node with_curves(const std::vector<Buffer>& payloads) {
    Node root = sample();
    for (const Buffer& payload : payloads)
        at(root, "HEAD/OBJE/CYCL").children.push_back(make_leaf(FourCC("CURV"), payload));
    return root;
}

Lines faults_with(const Buffer& payload) {
    return faults_in(with_curves({payload}));
}

Lines faults_with(const std::function<void(CurveRecord&)>& change, const CurveView& curve = plain_curve()) {
    Buffer payload = payload_of(curve);
    CurveRecord record;
    std::memcpy(&record, payload.data(), sizeof record);
    change(record);
    std::memcpy(payload.data(), &record, sizeof record);
    return faults_with(payload);
}

Lines in_curve(std::initializer_list<const char*> codes) {
    Lines lines;
    for (const char* code : codes) lines.push_back(std::string(code) + " " + kCurve);
    return lines;
}

TEST(Curves, ComeBackAsTheyWereWritten) {
    const Node root = with_curves({payload_of(plain_curve()), payload_of(packed_curve())});
    EXPECT_EQ(faults_in(root), Lines{"CURVE_REPEATED " + kCurve + "[1]"});
    const Loaded loaded(to_file(root));
    ASSERT_EQ(loaded.lines(), Lines{});
    const auto& curves = loaded.document.objects.at(0).clips.at(0).curves;
    ASSERT_EQ(curves.size(), 2u);
    for (const CurveView& curve : curves) {
        EXPECT_EQ(curve.name, "glow");
        EXPECT_EQ(curve.path, "extras/glow");
        EXPECT_EQ(curve.kind, CurveTarget::joint);
        EXPECT_EQ(curve.target, 1u);
        EXPECT_EQ(curve.components, 2u);
        EXPECT_EQ(curve.interpolation, Interpolation::linear);
        EXPECT_EQ(curve.keys, 3u);
        EXPECT_TRUE(std::equal(curve.times.begin(), curve.times.end(), kTimes.begin(), kTimes.end()));
        EXPECT_EQ(curve.value_count(), 6u);
    }
    EXPECT_FALSE(curves[0].is_packed());
    for (std::size_t k = 0; k < kValues.size(); ++k) EXPECT_EQ(curves[0].value(k), kValues[k]);
    EXPECT_TRUE(curves[1].is_packed());
    EXPECT_EQ(curves[1].max_error, 0.001f);
    for (std::size_t k = 0; k < kValues.size(); ++k) EXPECT_NEAR(curves[1].value(k), kValues[k], 0.001f);
    EXPECT_EQ(curves[1].value(1), 1.0f);  // the ends of the box are exact
    EXPECT_EQ(curves[1].value(5), -2.0f);
}

TEST(Curves, AreLaidOutAsTheTableSays) {
    const Buffer plain = payload_of(plain_curve());
    const LeafLayout& leaf = *find_leaf(FourCC("CURV"));
    LocatedParts parts = locate_parts(leaf, plain);
    EXPECT_TRUE(parts.is_whole);
    EXPECT_EQ(parts.end, plain.size());
    EXPECT_EQ(parts.find("box"), nullptr);
    EXPECT_EQ(parts.find("times")->offset, 32u);
    EXPECT_EQ(parts.find("key_values")->offset, 44u);
    EXPECT_EQ(parts.find("key_values")->size, 24u);
    EXPECT_EQ(as_text(Bytes(plain).subspan(parts.find("path")->offset, parts.find("path")->size)), "extras/glow");
    const Buffer packed = payload_of(packed_curve());
    parts = locate_parts(leaf, packed);
    EXPECT_EQ(parts.end, packed.size());
    EXPECT_EQ(parts.find("box")->size, 16u);
    EXPECT_EQ(parts.find("key_values")->shape.type, NumberType::u16);
}

TEST(Curves, MayBeCubicWithoutTargetAndName) {
    const std::vector<float> values(3 * 3, 0.5f);
    CurveView curve;
    curve.path = "/cameras/0/perspective/yfov";
    curve.interpolation = Interpolation::cubic;
    curve.keys = 3;
    curve.times = kTimes;
    curve.values = values;
    const Loaded loaded(to_file(with_curves({payload_of(curve)})));
    ASSERT_EQ(loaded.lines(), Lines{});
    const CurveView& read = loaded.document.objects.at(0).clips.at(0).curves.at(0);
    EXPECT_EQ(read.kind, CurveTarget::nothing);
    EXPECT_EQ(read.target, kNone);
    EXPECT_EQ(read.name, "");
    EXPECT_EQ(read.values.size(), 9u);
}

TEST(Curves, WithoutAPathMayBeAlike) {
    CurveView curve = plain_curve();
    curve.path = {};
    EXPECT_EQ(faults_in(with_curves({payload_of(curve), payload_of(curve)})), Lines{});
}

TEST(Curves, RefuseAnotherShape) {
    const Lines shape = in_curve({"CURVE_SHAPE"});
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.keys = 0; }), shape);
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.keys = 2; }), shape);
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.components = 0; }), shape);
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.components = 5; }), shape);
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.values = 5; }), shape);
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.interpolation = 2; }), shape);
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.interpolation = 2, record.values = 18; }, packed_curve()),
              shape);
}

TEST(Curves, CompareTheirCountsWithThePayload) {
    const Lines size = in_curve({"RECORD_SIZE"});
    EXPECT_EQ(faults_with(Buffer{}), in_curve({"RECORD_TOO_SHORT"}));
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.path_size = 0xffff'ffffu; }), size);
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.name_size = 3; }), size);
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.packed = 1; }), size);
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.keys = 0x4000'0000u, record.values = 0x8000'0000u; }), size);
    EXPECT_EQ(faults_with([](CurveRecord& record) {
                  record.components = 4;  // 4 * 2^30 + 4 numbers, of which 32 bits keep 4
                  record.keys = 0x4000'0001u;
                  record.values = 4;
              }),
              in_curve({"CURVE_SHAPE"}));
    Buffer payload = payload_of(plain_curve());
    payload.push_back(std::byte{0});
    EXPECT_EQ(faults_with(payload), size);
}

TEST(Curves, RefuseWhatIsNotThere) {
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.target = 999; }), in_curve({"JOINT_RANGE"}));
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.kind = 2, record.target = 999; }),
              in_curve({"MATERIAL_RANGE"}));
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.kind = 3, record.target = 999; }), in_curve({"MESH_RANGE"}));
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.kind = 4, record.target = kNone; }),
              in_curve({"TEXTURE_RANGE"}));
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.kind = 0; }), in_curve({"INDEX_RANGE"}));
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.kind = 5; }), in_curve({"ENUM_RANGE"}));
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.packed = 2; }), in_curve({"ENUM_RANGE"}));
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.interpolation = 3; }), in_curve({"ENUM_RANGE"}));
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.reserved = 1; }), in_curve({"RESERVED_FIELD"}));
}

TEST(Curves, WantGoodNumbers) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.max_error = kNaN; }), in_curve({"NOT_FINITE"}));
    EXPECT_EQ(faults_with([](CurveRecord& record) { record.max_error = -1.0f; }), in_curve({"BELOW_ZERO"}));
    const auto with = [](auto CurveView::*member, auto numbers) {
        CurveView curve = member == &CurveView::box ? packed_curve() : plain_curve();
        curve.*member = numbers;
        return faults_with(payload_of(curve));
    };
    std::array values = kValues;
    values[3] = kNaN;
    EXPECT_EQ(with(&CurveView::values, std::span<const float>(values)), in_curve({"NOT_FINITE"}));
    std::array box = kBox;
    box[2] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(with(&CurveView::box, std::span<const float>(box)), in_curve({"NOT_FINITE"}));
    std::array times = kTimes;
    times[1] = 0.5f;
    EXPECT_EQ(with(&CurveView::times, std::span<const float>(times)), in_curve({"CURVE_ORDER"}));
    times[0] = 0.25f;
    EXPECT_EQ(with(&CurveView::times, std::span<const float>(times)), Lines{"CLIP_LENGTH HEAD/OBJE/CYCL/CINF"});
    CurveView curve = plain_curve();
    curve.name = "\xff";
    EXPECT_EQ(faults_with(payload_of(curve)), in_curve({"NOT_UTF8"}));
}

}  // namespace
}  // namespace bendy::curve_test
