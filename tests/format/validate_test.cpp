#include <bendy/format/document.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace bendy::validate_test {
namespace {

using namespace test;

/// A way to make one thing, and nothing else, wrong with the sample.
struct Provocation {
    ErrorCode code;
    std::string path;  ///< of the chunk that is blamed
    std::function<Buffer()> make;
};

/// A change of the sample's chunks; sizes and sums are right afterwards.
Provocation edited(ErrorCode code, std::string path, std::function<void(Node&)> change) {
    return {code, std::move(path), [change] {
                Node root = sample();
                change(root);
                return to_file(root);
            }};
}

/// A change of one record.
template <class R, class Change>
Provocation record(ErrorCode code, const std::string& path, Change change) {
    return edited(code, path, [=](Node& root) { edit<R>(at(root, path), change); });
}

/// A change of one number.
template <class T>
Provocation number(ErrorCode code, const std::string& path, std::size_t offset, T value) {
    return edited(code, path, [=](Node& root) { set(at(root, path), offset, value); });
}

/// A change of bare bytes, sums and sizes left as they are. `offset` counts from the header of the chunk at `chunk`.
template <class T>
Provocation patched(ErrorCode code, std::string path, const std::string& chunk, std::uint64_t offset, T value) {
    return {code, std::move(path), [=] {
                Buffer file = sample_file();
                patch(file, place_of(file, chunk) + offset, value);
                return file;
            }};
}

constexpr std::uint64_t kSizeField = 8;
constexpr std::uint64_t kFlagsField = 14;
constexpr std::size_t kNumbers = sizeof(StreamRecord);
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Markers in the sample's clip, which lasts from 0.5 s to 1 s; their names are "stop".
Provocation marked(ErrorCode code, const std::vector<MarkerRecord>& markers) {
    return edited(code, "HEAD/OBJE/CYCL/MARK", [markers](Node& root) {
        at(root, "HEAD/OBJE/CYCL").children.push_back(make_leaf(FourCC("MARK"), markers_payload(markers, "stop")));
    });
}

/// A curve of two keys in the sample's clip.
Provocation curved(ErrorCode code, std::array<float, 2> times, std::uint8_t components, int copies = 1) {
    const std::string path = "HEAD/OBJE/CYCL/CURV";
    return edited(code, copies == 1 ? path : path + "[1]", [=](Node& root) {
        constexpr std::array kValues{0.0f, 1.0f};
        CurveView curve;
        curve.path = "a";
        curve.keys = 2;
        curve.times = times;
        curve.values = kValues;
        Buffer payload = write_curve(curve);
        payload[offsetof(CurveRecord, components)] = static_cast<std::byte>(components);
        for (int copy = 0; copy < copies; ++copy)
            at(root, "HEAD/OBJE/CYCL").children.push_back(make_leaf(FourCC("CURV"), payload));
    });
}

/// Roles in the sample, which has four joints.
Provocation with_roles(ErrorCode code, const std::vector<RoleRecord>& roles) {
    return edited(code, "HEAD/OBJE/ROLE", [roles](Node& root) {
        at(root, "HEAD/OBJE").children.push_back(make_leaf(FourCC("ROLE"), bytes_of_all(roles)));
    });
}

/// A leaf under zstd with nothing after its header.
void put_encoded(Node& leaf, const CodecHeader& header) {
    leaf.flags = 0x0100;
    const Bytes bytes = bytes_of(header);
    leaf.payload.assign(bytes.begin(), bytes.end());
}

const std::vector<Provocation> kProvocations{
    patched(ErrorCode::kNotABendyFile, "HEAX", "HEAD", 3, 'X'),
    {ErrorCode::kTruncated, "HEAD",
     [] {
         Buffer file = sample_file();
         file.pop_back();
         return file;
     }},
    {ErrorCode::kTrailingBytes, "",
     [] {
         Buffer file = sample_file();
         file.push_back(std::byte{0});
         return file;
     }},
    patched(ErrorCode::kChunkTooLong, "HEAD/EXTR", "HEAD/EXTR", kSizeField,
            std::uint8_t{17}),  // the last one, with 16 left
    patched(ErrorCode::kChunkIdNotLetters, "HEAD/OBJE/VECT/nORM", "HEAD/OBJE/VECT/NORM", 0, 'n'),
    patched(ErrorCode::kReservedFlags, "HEAD/VERS", "HEAD/VERS", kFlagsField, std::uint8_t{0x04}),
    {ErrorCode::kContainerSize, "HEAD/OBJE/VECT[1]",
     [] {
         Buffer file = sample_file();
         const std::uint64_t size = place_of(file, "HEAD/OBJE/VECT[1]") + kSizeField;
         std::uint8_t low = 0;
         copy_at(file, size, low);
         patch(file, size, static_cast<std::uint8_t>(low + 1));
         return file;
     }},
    patched(ErrorCode::kContainerCodec, "HEAD/MATE", "HEAD/MATE", kFlagsField + 1, std::uint8_t{1}),
    patched(ErrorCode::kPaddingNotZero, "HEAD/OBJE/NAME", "HEAD/OBJE/NAME", kChunkHeaderSize + 3, std::uint8_t{1}),
    {ErrorCode::kTooDeep, "HEAD/AAAA/AAAA/AAAA/AAAA/AAAA/... 65525 more .../AAAA/AAAA/AAAA/AAAA/AAAA/AAAA",
     [] {
         ChunkWriter writer;
         writer.begin(FourCC("HEAD"));
         for (std::uint32_t level = 0; level < kMaxDepth; ++level) writer.begin(FourCC("AAAA"));
         for (std::uint32_t level = 0; level < kMaxDepth; ++level) writer.end();
         writer.end();
         return std::move(writer).finish();
     }},
    patched(ErrorCode::kSumMismatch, "HEAD/OBJE/VECT/POSI", "HEAD/OBJE/VECT/POSI", kChunkHeaderSize + kNumbers, 0.5f),

    record<VersionRecord>(ErrorCode::kUnsupportedVersion, "HEAD/VERS",
                          [](auto& version) { version.major = kVersionMajor + 1; }),
    edited(ErrorCode::kRequiredChunkUnknown, "HEAD/OBJE/ZZZZ",
           [](Node& root) { at(root, "HEAD/OBJE").children.push_back(make_leaf(FourCC("ZZZZ"), {}, kRequiredFlag)); }),
    edited(ErrorCode::kUnsupportedCodec, "HEAD/OBJE/VECT/NORM",
           [](Node& root) { at(root, "HEAD/OBJE/VECT/NORM").flags = 0xff00; }),

    edited(ErrorCode::kCodecData, "HEAD/OBJE/VECT/NORM",
           [](Node& root) {
               put_encoded(at(root, "HEAD/OBJE/VECT/NORM"), CodecHeader{36 + 16, 0, 0, 0});
           }),
    edited(ErrorCode::kCodecRatio, "HEAD/OBJE/VECT/NORM",
           [](Node& root) {
               put_encoded(at(root, "HEAD/OBJE/VECT/NORM"), CodecHeader{1'000'000, 0, 0, 0});
           }),
    edited(ErrorCode::kChunkMissing, "HEAD/OBJE/SKIN/SKIN[1]",
           [](Node& root) { remove(at(root, "HEAD/OBJE/SKIN/SKIN[1]"), "PIVO"); }),
    edited(ErrorCode::kChunkRepeated, "HEAD/OBJE/NAME[1]",
           [](Node& root) { at(root, "HEAD/OBJE").children.push_back(at(root, "HEAD/OBJE/NAME")); }),
    edited(ErrorCode::kChunkMisplaced, "HEAD/NAME",
           [](Node& root) { root.children.push_back(at(root, "HEAD/OBJE/NAME")); }),
    edited(ErrorCode::kNotAContainer, "HEAD/OBJE/VECT/USER",
           [](Node& root) { at(root, "HEAD/OBJE/VECT/USER") = make_leaf(FourCC("USER")); }),
    edited(ErrorCode::kNotALeaf, "HEAD/OBJE/VECT/NORM",
           [](Node& root) { at(root, "HEAD/OBJE/VECT/NORM") = make_container(FourCC("NORM")); }),
    edited(ErrorCode::kRecordTooShort, "HEAD/MATE/SURF",
           [](Node& root) { at(root, "HEAD/MATE/SURF").payload.pop_back(); }),
    edited(ErrorCode::kRecordSize, "HEAD/OBJE/VECT/NORM",
           [](Node& root) { at(root, "HEAD/OBJE/VECT/NORM").payload.push_back({}); }),
    record<PaletteRecord>(ErrorCode::kReservedField, "HEAD/OBJE/VECT/PALT",
                          [](auto& palette) { palette.reserved[1] = 1; }),
    record<VersionRecord>(ErrorCode::kSignature, "HEAD/VERS", [](auto& version) { version.signature[5] = '\n'; }),
    record<VersionRecord>(ErrorCode::kCountMismatch, "HEAD/VERS", [](auto& version) { version.joints = 5; }),
    edited(ErrorCode::kNotUtf8, "HEAD/OBJE/SKIN/NAME",
           [](Node& root) { set(at(root, "HEAD/OBJE/SKIN/NAME"), 0, std::uint8_t{0xff}); }),
    edited(ErrorCode::kLinkControl, "HEAD/TEXT/LINK",
           [](Node& root) { set(at(root, "HEAD/TEXT/LINK"), 0, std::uint8_t{'\n'}); }),
    record<SamplerRecord>(ErrorCode::kEnumRange, "HEAD/TEXT/SAMP", [](auto& sampler) { sampler.wrap_s = kWraps; }),
    number(ErrorCode::kNotFinite, "HEAD/OBJE/VECT/POSI", kNumbers, kNaN),
    record<MeshRecord>(ErrorCode::kJointRange, "HEAD/OBJE/VECT[1]/VINF", [](auto& mesh) { mesh.joint = 4; }),
    record<SubmeshRecord>(ErrorCode::kMeshRange, "HEAD/OBJE/SKIN/POLY", [](auto& submesh) { submesh.mesh = 2; }),
    record<SubmeshRecord>(ErrorCode::kMaterialRange, "HEAD/OBJE/SKIN/POLY",
                          [](auto& submesh) { submesh.material = 1; }),
    record<SurfaceRecord>(ErrorCode::kTextureRange, "HEAD/MATE/SURF",
                          [](auto& surface) { surface.normal_texture.texture = 3; }),
    number(ErrorCode::kIndexRange, "HEAD/OBJE/VECT/INDX", kNumbers, std::uint16_t{4}),
    {ErrorCode::kTooManyJoints, "HEAD/OBJE", [] { return rope_file(kMaxJoints + 1); }},
    record<StreamRecord>(ErrorCode::kStreamType, "HEAD/OBJE/VECT/NORM", [](auto& stream) { stream.components = 4; }),
    record<StreamRecord>(ErrorCode::kStreamCount, "HEAD/OBJE/VECT/NORM", [](auto& stream) { stream.elements = 5; }),
    record<StreamRecord>(ErrorCode::kStreamSet, "HEAD/OBJE/VECT/TEXC[1]", [](auto& stream) { stream.set = 0; }),
    edited(ErrorCode::kStreamIncomplete, "HEAD/OBJE/VECT",
           [](Node& root) { remove(at(root, "HEAD/OBJE/VECT"), "WGHT"); }),
    number(ErrorCode::kBoneRange, "HEAD/OBJE/VECT/BONE", kNumbers, std::uint8_t{2}),
    edited(ErrorCode::kWeightRange, "HEAD/OBJE/VECT/WGHT",
           [](Node& root) {
               Node& weights = at(root, "HEAD/OBJE/VECT/WGHT");
               set(weights, kNumbers, 1.5f);
               set(weights, kNumbers + 4, -0.5f);
           }),
    number(ErrorCode::kWeightSum, "HEAD/OBJE/VECT/WGHT", kNumbers, 0.5f),
    number(ErrorCode::kTargetOrder, "HEAD/OBJE/VECT/TARG[1]/INDX", kNumbers, std::uint16_t{3}),
    record<ChainWeightRecord>(ErrorCode::kChainRange, "HEAD/OBJE/SKIN/PIVO/PULL",
                              [](auto& chain_weight) { chain_weight.chain = 2; }),
    record<ChainRecord>(ErrorCode::kChainPath, "HEAD/OBJE/IKCH/KINF", [](auto& chain) { chain.start = 3; }),
    record<ChainWeightRecord>(ErrorCode::kChainWeightPath, "HEAD/OBJE/SKIN/SKIN[1]/PIVO/PULL",
                              [](auto& chain_weight) { chain_weight.chain = 0; }),
    edited(
        ErrorCode::kChainWeightRepeated, "HEAD/OBJE/SKIN/PIVO/PULL[1]",
        [](Node& root) { at(root, "HEAD/OBJE/SKIN/PIVO").children.push_back(at(root, "HEAD/OBJE/SKIN/PIVO/PULL")); }),
    with_roles(ErrorCode::kJointOrder, {{1, 1, 0}, {0, 2, 0}}),
    with_roles(ErrorCode::kRolePlace, {{0, 1, 1}}),
    with_roles(ErrorCode::kRoleRepeated, {{0, 1, 0}, {1, 1, 0}}),
    record<ChainWeightRecord>(ErrorCode::kFractionRange, "HEAD/OBJE/SKIN/PIVO/PULL",
                              [](auto& chain_weight) { chain_weight.weight = 1.5f; }),
    record<ChainRecord>(ErrorCode::kBelowZero, "HEAD/OBJE/IKCH[1]/KINF", [](auto& chain) { chain.stretch = -1.0f; }),
    record<ConstraintRecord>(ErrorCode::kLimitOrder, "HEAD/OBJE/SKIN/SKIN/PIVO/LIMT",
                             [](auto& constraint) { constraint.rotation_min[0] = 2.5f; }),
    record<ConstraintRecord>(ErrorCode::kLimitRange, "HEAD/OBJE/SKIN/SKIN/PIVO/LIMT[1]",
                             [](auto& constraint) { constraint.rotation_min[1] = 0.25f; }),
    record<ConstraintRecord>(ErrorCode::kConstraintRepeated, "HEAD/OBJE/SKIN/SKIN/PIVO/LIMT[1]",
                             [](auto& constraint) { constraint.scope = 0; }),
    record<ConstraintRecord>(ErrorCode::kRestOutside, "HEAD/OBJE/SKIN/SKIN/PIVO/LIMT",
                             [](auto& constraint) { constraint.rotation_min[0] = 0.5f; }),
    record<SubmeshRecord>(ErrorCode::kPolygonCut, "HEAD/OBJE/SKIN/POLY", [](auto& submesh) { submesh.count = 2; }),
    record<SubmeshRecord>(ErrorCode::kSubmeshOverlap, "HEAD/OBJE/SKIN/SKIN/POLY",
                          [](auto& submesh) { submesh.first = 2; }),
    edited(ErrorCode::kRigidShared, "HEAD/OBJE/SKIN/SKIN/POLY[1]",
           [](Node& root) { set(at(root, "HEAD/OBJE/VECT[1]/INDX"), kNumbers + 20, 0u); }),
    record<TrackRecord>(ErrorCode::kKeyRange, "HEAD/OBJE/CYCL/TRAK", [](auto& track) { track.keys = 0; }),
    edited(ErrorCode::kKeyOrder, "HEAD/OBJE/CYCL/TRAK",
           [](Node& root) {
               set(at(root, "HEAD/OBJE/CYCL/TIME"), 16, 0.5f);
               // Of the two tracks with these times one is left.
               edit<TrackRecord>(
                   at(root, "HEAD/OBJE/CYCL/TRAK"), [](auto& track) { track.keys = 1; }, 3 * sizeof(TrackRecord));
           }),
    record<TrackRecord>(ErrorCode::kKeyOverlap, "HEAD/OBJE/CYCL/TRAK",
                        [](auto& track) { track.first_value = 3, track.keys = 2; }),
    record<TrackRecord>(
        ErrorCode::kTrackRepeated, "HEAD/OBJE/CYCL/TRAK",
        [](auto& track) { track.target = 2, track.path = static_cast<std::uint8_t>(TrackPath::scale); }),
    record<TrackRecord>(ErrorCode::kTrackComponents, "HEAD/OBJE/CYCL/TRAK", [](auto& track) { track.components = 4; }),
    edited(ErrorCode::kRotationNotUnit, "HEAD/OBJE/SKIN/PIVO/REST",
           [](Node& root) {
               edit<RestRecord>(at(root, "HEAD/OBJE/SKIN/PIVO/REST"), [](auto& rest) { rest.rotation = {}; });
           }),
    marked(ErrorCode::kMarkerName, {{0.5f, 4}, {0.75f, 3}}),
    marked(ErrorCode::kMarkerOrder, {{0.75f, 2}, {0.5f, 4}}),
    marked(ErrorCode::kMarkerOutside, {{0.5f, 2}, {1.25f, 4}}),
    curved(ErrorCode::kCurveShape, {0.5f, 1.0f}, 2),
    curved(ErrorCode::kCurveOrder, {0.75f, 0.75f}, 1),
    curved(ErrorCode::kCurveRepeated, {0.5f, 1.0f}, 1, 2),
    // LODD: its record, the mesh's, two levels of 8 bytes, targets.
    edited(ErrorCode::kCollapseMesh, "HEAD/OBJE/LODD",
           [](Node& root) {
               const CollapseRecord record{2, 0, {}};
               MeshCollapseRecord mesh;
               mesh.base = 4;  // all of its vertices
               mesh.target_type = static_cast<std::uint8_t>(ComponentType::u16);
               Buffer& payload = at(root, "HEAD/OBJE/LODD").payload;
               payload.clear();
               for (const Bytes bytes : {bytes_of(record), bytes_of(mesh), bytes_of(mesh)})
                   payload.insert(payload.end(), bytes.begin(), bytes.end());
           }),
    number(ErrorCode::kCollapseTarget, "HEAD/OBJE/LODD", 48, std::uint16_t{3}),
    number(ErrorCode::kCollapseLevel, "HEAD/OBJE/LODD", 36, std::uint32_t{5}),
    record<ClipRecord>(ErrorCode::kClipLength, "HEAD/OBJE/CYCL/CINF", [](auto& clip) { clip.end = 0.75f; }),
};

/// Codes that no change of a file's bytes can provoke here, and why.
struct Exempt {
    ErrorCode code;
    const char* reason;
};
const std::vector<Exempt> kExempt{
    {ErrorCode::kCannotOpen, "the system's, in file_test.cpp"},
    {ErrorCode::kCannotRead, "the system's, in file_test.cpp"},
    {ErrorCode::kCannotWrite, "the system's, in file_test.cpp"},
    {ErrorCode::kUnalignedBuffer, "the caller's buffer, in chunk_reader_test.cpp"},
    {ErrorCode::kFrameRange, "the sample has no frames: tests/conformance/frames.json provokes it in seven ways"},
    {ErrorCode::kTooManyChunks, "the smallest file with so many takes 32 GiB"},
};

class ErrorCodeTest : public testing::TestWithParam<Provocation> {};

TEST_P(ErrorCodeTest, IsTheOnlyFaultFound) {
    const Buffer file = GetParam().make();
    EXPECT_EQ(faults_in(file), Lines{std::string(code_name(GetParam().code)) + " " + GetParam().path});
}

INSTANTIATE_TEST_SUITE_P(Validate, ErrorCodeTest, testing::ValuesIn(kProvocations),
                         [](const auto& provocation) { return std::string(code_name(provocation.param.code)); });

TEST(Validate, HasATestForEveryErrorCode) {
    std::multiset<ErrorCode> provoked;
    for (const Provocation& provocation : kProvocations) provoked.insert(provocation.code);
    for (const Exempt& exempt : kExempt) provoked.insert(exempt.code);
#define BENDY_ERROR(enumerator, kind, code, text) EXPECT_EQ(provoked.count(ErrorCode::enumerator), 1u) << code;
#include <bendy/format/error_codes.def>
#undef BENDY_ERROR
}

TEST(Validate, FindsNothingInTheSample) {
    EXPECT_EQ(faults_in(sample_file()), Lines{});
}

TEST(Validate, EndsAtTheFirstFaultOfStructure) {
    Buffer file = sample_file();
    patch(file, place_of(file, "HEAD/OBJE/SKIN/NAME") + kFlagsField, std::uint8_t{0x04});
    patch(file, place_of(sample_file(), "HEAD/VERS") + 4, 0u);
    EXPECT_EQ(faults_in(file), Lines{"RESERVED_FLAGS HEAD/OBJE/SKIN/NAME"});
}

TEST(Validate, ReportsEveryFaultOfSumsRecordsAndValues) {
    Node root = sample();
    edit<StreamRecord>(at(root, "HEAD/OBJE/VECT/NORM"), [](auto& stream) { stream.elements = 3; });
    set(at(root, "HEAD/OBJE/VECT/POSI"), kNumbers, kNaN);
    Buffer file = to_file(root);
    patch(file, place_of(file, "HEAD/OBJE/NAME") + kChunkHeaderSize, 'F');
    EXPECT_EQ(faults_in(file), (Lines{"SUM_MISMATCH HEAD/OBJE/NAME", "STREAM_COUNT HEAD/OBJE/VECT/NORM",
                                      "NOT_FINITE HEAD/OBJE/VECT/POSI"}));
}

TEST(Validate, KeepsABoundedListOfFaultsAndCountsTheRest) {
    Node root = make_container(FourCC("HEAD"), {make_leaf(FourCC("VERS"), bytes_of(VersionRecord{}))});
    root.children.insert(root.children.end(), Faults::kMost + 5, make_leaf(FourCC("NAME")));
    const Faults faults = validate(to_file(root));
    EXPECT_EQ(faults.list().size(), Faults::kMost);
    EXPECT_GT(faults.left_out(), 0u);
}

}  // namespace
}  // namespace bendy::validate_test
