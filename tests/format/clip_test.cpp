#include <bendy/format/clip.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace bendy::clip_test {
namespace {

using namespace test;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
const std::string kClip = "HEAD/OBJE/CYCL";
enum SampleTrack : std::size_t { kTranslation, kCubicRotation, kScale, kWeights, kFixedFrames };

Node& table(Node& root) {
    return at(root, kClip + "/TRAK");
}

/// What is wrong with the sample when one of its tracks is changed.
template <class Change>
Lines faults_with_track(SampleTrack track, Change change) {
    Node root = sample();
    edit<TrackRecord>(table(root), change, track * sizeof(TrackRecord));
    return faults_in(root);
}

template <class Change>
Lines faults_with_clip(Change change) {
    Node root = sample();
    edit<ClipRecord>(at(root, kClip + "/CINF"), change);
    return faults_in(root);
}

Lines faults_with_number(const char* leaf, std::size_t index, float value) {
    Node root = sample();
    set(at(root, kClip + leaf), index * sizeof(float), value);
    return faults_in(root);
}

Lines in_table(const char* code) {
    return {std::string(code) + " " + kClip + "/TRAK"};
}
Lines in_info(const char* code) {
    return {std::string(code) + " " + kClip + "/CINF"};
}

TEST(Clip, GivesItsParts) {
    const Loaded sample(sample_file());
    ASSERT_EQ(sample.lines(), Lines{});
    const ClipView& clip = sample.document.objects.at(0).clips.at(0);
    EXPECT_EQ(clip.name, "run");
    EXPECT_EQ(clip.extras, "[]");
    EXPECT_EQ(clip.start, 0.5f);
    EXPECT_EQ(clip.end, 1.0f);
    EXPECT_EQ(clip.frame_rate, 4.0f);
    EXPECT_TRUE(clip.loop);
    EXPECT_EQ(clip.tracks.size(), 5u);
}

TEST(Clip, GivesEachTrackItsKeysAndValues) {
    const Loaded sample(sample_file());
    const auto& tracks = sample.document.objects.at(0).clips.at(0).tracks;
    ASSERT_EQ(tracks.size(), 5u);
    const TrackView& translation = tracks[kTranslation];
    EXPECT_EQ(translation.path, TrackPath::translation);
    EXPECT_EQ(translation.interpolation, Interpolation::linear);
    EXPECT_EQ(translation.target, 0u);
    EXPECT_EQ(translation.keys, 3u);
    EXPECT_EQ(std::vector<float>(translation.times.begin(), translation.times.end()),
              (std::vector<float>{0.5f, 0.75f, 1.0f}));
    EXPECT_EQ(std::vector<float>(translation.values.begin(), translation.values.end()),
              (std::vector<float>{1, 1, 1, 2, 2, 2, 3, 3, 3}));

    const TrackView& rotation = tracks[kCubicRotation];
    EXPECT_EQ(rotation.path, TrackPath::rotation);
    EXPECT_EQ(rotation.interpolation, Interpolation::cubic);
    ASSERT_EQ(rotation.values.size(), 24u);  // in-tangent, value, out-tangent
    EXPECT_EQ(rotation.values[3], 5.0f);
    EXPECT_EQ(rotation.values[23], 8.0f);
    EXPECT_EQ(std::vector<float>(rotation.times.begin(), rotation.times.end()), (std::vector<float>{0.5f, 1.0f}));

    EXPECT_EQ(tracks[kScale].interpolation, Interpolation::step);
    EXPECT_EQ(tracks[kScale].values.data(), translation.values.data());  // shared

    EXPECT_EQ(tracks[kWeights].path, TrackPath::weights);
    EXPECT_EQ(tracks[kWeights].components, 2u);
    ASSERT_EQ(tracks[kWeights].values.size(), 4u);
    EXPECT_EQ(tracks[kWeights].values[3], 0.25f);

    EXPECT_TRUE(tracks[kFixedFrames].times.empty());
    EXPECT_EQ(tracks[kFixedFrames].keys, 3u);
    ASSERT_EQ(tracks[kFixedFrames].values.size(), 12u);
    EXPECT_EQ(tracks[kFixedFrames].values[8], 1.0f);
}

TEST(Clip, MayBeWithoutTracks) {
    Node root = sample();
    for (const char* leaf : {"TRAK", "TIME", "KEYV"}) remove(at(root, kClip), leaf);
    EXPECT_EQ(faults_in(root), Lines{});
    EXPECT_TRUE(Loaded(root).document.objects.at(0).clips.at(0).tracks.empty());
}

TEST(Clip, RefusesTracksWithoutTimesOrValues) {
    Node root = sample();
    remove(at(root, kClip), "KEYV");
    EXPECT_EQ(Loaded(root).lines(), Lines(5, in_table("KEY_RANGE")[0]));
    root = sample();
    remove(at(root, kClip), "TIME");
    EXPECT_EQ(Loaded(root).lines(), Lines(4, in_table("KEY_RANGE")[0]));  // fixed frames need none
}

TEST(Clip, LeavesOutTheTracksThatAreAtFault) {
    Node root = sample();
    edit<TrackRecord>(
        table(root), [](auto& track) { track.keys = 0; }, kScale * sizeof(TrackRecord));
    const Loaded loaded(root);
    const auto& tracks = loaded.document.objects.at(0).clips.at(0).tracks;
    ASSERT_EQ(tracks.size(), 4u);
    EXPECT_EQ(tracks[2].path, TrackPath::weights);
    ASSERT_EQ(loaded.faults.list().size(), 1u);
    EXPECT_EQ(loaded.faults.list()[0].value, std::uint64_t{kScale});
}

TEST(Clip, RefusesUnknownPathsInterpolationsAndLoops) {
    EXPECT_EQ(faults_with_track(kScale, [](auto& track) { track.path = kTrackPaths; }), in_table("ENUM_RANGE"));
    EXPECT_EQ(faults_with_track(kScale, [](auto& track) { track.interpolation = kInterpolations; }),
              in_table("ENUM_RANGE"));
    EXPECT_EQ(faults_with_clip([](auto& clip) { clip.loop = 2; }), in_info("ENUM_RANGE"));
    EXPECT_EQ(faults_with_clip([](auto& clip) { clip.loop = 0; }), Lines{});
}

TEST(Clip, RefusesReservedBytes) {
    for (std::size_t byte = 0; byte < 3; ++byte) {
        EXPECT_EQ(faults_with_clip([=](auto& clip) { clip.reserved[byte] = 0x80; }), in_info("RESERVED_FIELD")) << byte;
    }
}

TEST(Clip, RefusesTargetsThatAreNotThere) {
    EXPECT_EQ(faults_with_track(kTranslation, [](auto& track) { track.target = 3; }), Lines{});
    for (const std::uint32_t target : {4u, 0x8000'0000u, kNone}) {
        EXPECT_EQ(faults_with_track(kTranslation, [=](auto& track) { track.target = target; }), in_table("JOINT_RANGE"))
            << target;
    }
    for (const std::uint32_t target : {2u, kNone}) {
        EXPECT_EQ(faults_with_track(kWeights, [=](auto& track) { track.target = target; }), in_table("MESH_RANGE"))
            << target;
    }
}

TEST(Clip, WantsTheComponentsThatItsTargetHas) {
    for (const unsigned components : {0u, 1u, 2u, 4u, 5u, 65535u}) {
        EXPECT_EQ(faults_with_track(kTranslation,
                                    [=](auto& track) { track.components = static_cast<std::uint16_t>(components); }),
                  in_table("TRACK_COMPONENTS"));
    }
    EXPECT_EQ(faults_with_track(kCubicRotation, [](auto& track) { track.components = 3; }),
              in_table("TRACK_COMPONENTS"));
    EXPECT_EQ(faults_with_track(kWeights, [](auto& track) { track.components = 1; }), in_table("TRACK_COMPONENTS"));
    // The rigid mesh has no targets.
    EXPECT_EQ(faults_with_track(kWeights, [](auto& track) { track.target = 1; }), in_table("TRACK_COMPONENTS"));
    EXPECT_EQ(faults_with_track(kWeights, [](auto& track) { track.target = 1, track.components = 0; }),
              in_table("TRACK_COMPONENTS"));
}

TEST(Clip, RefusesKeysPastTheTimes) {
    const Lines bad = in_table("KEY_RANGE");
    EXPECT_EQ(faults_with_track(kWeights, [](auto& track) { track.first_time = 4, track.keys = 1; }), Lines{});
    EXPECT_EQ(faults_with_track(kWeights, [](auto& track) { track.first_time = 4; }), bad);
    EXPECT_EQ(faults_with_track(kWeights, [](auto& track) { track.first_time = 5, track.keys = 1; }), bad);
    EXPECT_EQ(faults_with_track(kWeights, [](auto& track) { track.first_time = 6; }), bad);
    EXPECT_EQ(faults_with_track(kWeights, [](auto& track) { track.first_time = kNone - 1; }), bad);
    EXPECT_EQ(faults_with_track(kWeights, [](auto& track) { track.keys = 0; }), bad);
    EXPECT_EQ(faults_with_track(kWeights, [](auto& track) { track.keys = kNone; }), bad);
}

TEST(Clip, RefusesKeysPastTheValues) {
    const Lines bad = in_table("KEY_RANGE");
    // 49 numbers in all, four a key.
    EXPECT_EQ(faults_with_track(kFixedFrames, [](auto& track) { track.first_value = 45, track.keys = 1; }), Lines{});
    for (const std::uint64_t first :
         {std::uint64_t{46}, std::uint64_t{49}, std::uint64_t{50}, std::uint64_t{1} << 32, std::uint64_t{1} << 62,
          std::uint64_t{1} << 63, ~std::uint64_t{0}, ~std::uint64_t{0} - 3}) {
        EXPECT_EQ(faults_with_track(kFixedFrames, [=](auto& track) { track.first_value = first, track.keys = 1; }), bad)
            << first;
    }
    EXPECT_EQ(faults_with_track(kFixedFrames, [](auto& track) { track.keys = 4; }), bad);
    EXPECT_EQ(faults_with_track(kFixedFrames, [](auto& track) { track.keys = 0x4000'0000u; }), bad);
    EXPECT_EQ(faults_with_track(kFixedFrames, [](auto& track) { track.keys = kNone; }), bad);
}

TEST(Clip, CountsThreeValuesForEachCubicKey) {
    // 24 numbers from number 25 on: two cubic keys would fit, from 26 on they do not.
    const auto faults = [](std::uint64_t first) {
        Node root = sample();  // the shares overlap then, which read_document does not mind
        edit<TrackRecord>(
            table(root), [=](auto& track) { track.first_value = first; }, kCubicRotation * sizeof(TrackRecord));
        return Loaded(root).lines();
    };
    EXPECT_EQ(faults(25), Lines{});
    EXPECT_EQ(faults(26), in_table("KEY_RANGE"));
}

TEST(Clip, WantsAFrameRateForFixedFrames) {
    const auto with_rate = [](float rate) { return [rate](auto& clip) { clip.frame_rate = rate; }; };
    EXPECT_EQ(faults_with_clip(with_rate(0.0f)), in_table("KEY_RANGE"));
    EXPECT_EQ(faults_with_clip(with_rate(-4.0f)), (Lines{in_table("KEY_RANGE")[0], in_info("CLIP_LENGTH")[0]}));
    EXPECT_EQ(faults_with_clip(with_rate(kInfinity)), in_info("NOT_FINITE"));
}

TEST(Clip, RefusesTablesOfBrokenRecords) {
    Node root = sample();
    table(root).payload.pop_back();
    EXPECT_EQ(faults_in(root), in_table("RECORD_SIZE"));
    for (const char* leaf : {"/TIME", "/KEYV"}) {
        root = sample();
        at(root, kClip + leaf).payload.push_back({});
        EXPECT_EQ(faults_in(root).at(0), "RECORD_SIZE " + kClip + leaf);
    }
}

TEST(Clip, RefusesEncodedTables) {
    for (const char* leaf : {"/TRAK", "/TIME", "/KEYV", "/CINF"}) {
        Node root = sample();
        at(root, kClip + leaf).flags = 0x0100;
        EXPECT_EQ(Loaded(root).lines().at(0), "UNSUPPORTED_CODEC " + kClip + leaf);
    }
}

TEST(Clip, WantsKeyTimesToAscend) {
    EXPECT_EQ(faults_with_number("/TIME", 4, 0.75f), Lines{});
    EXPECT_EQ(faults_with_number("/TIME", 4, 0.5f),
              Lines(2, in_table("KEY_ORDER")[0]));  // the rotation's and the weights'
    EXPECT_EQ(faults_with_number("/TIME", 1, 0.5f),
              Lines(2, in_table("KEY_ORDER")[0]));  // the translation's and the scale's
}

TEST(Clip, WantsToHoldItsKeys) {
    EXPECT_EQ(faults_with_clip([](auto& clip) { clip.start = 0.25f, clip.end = 2.0f; }), Lines{});
    EXPECT_EQ(faults_with_clip([](auto& clip) { clip.start = 0.6f; }), in_info("CLIP_LENGTH"));
    EXPECT_EQ(faults_with_clip([](auto& clip) { clip.end = 0.9f; }), in_info("CLIP_LENGTH"));
    EXPECT_EQ(faults_with_clip([](auto& clip) { clip.start = 1.5f; }), in_info("CLIP_LENGTH"));
}

TEST(Clip, MayBeginBeforeZeroAndLastNoTime) {
    Node root = sample();
    for (const char* leaf : {"TRAK", "TIME", "KEYV"}) remove(at(root, kClip), leaf);
    edit<ClipRecord>(at(root, kClip + "/CINF"), [](auto& clip) { clip.start = clip.end = -1.0f; });
    EXPECT_EQ(faults_in(root), Lines{});
}

TEST(Clip, RefusesNumbersThatAreNotFinite) {
    for (const float bad : {kNaN, kInfinity, -kInfinity}) {
        EXPECT_EQ(faults_with_clip([=](auto& clip) { clip.start = bad; }).at(0), in_info("NOT_FINITE")[0]);
        EXPECT_EQ(faults_with_clip([=](auto& clip) { clip.end = bad; }).at(0), in_info("NOT_FINITE")[0]);
        EXPECT_EQ(faults_with_number("/TIME", 1, bad).at(0), "NOT_FINITE " + kClip + "/TIME");
        EXPECT_EQ(faults_with_number("/KEYV", 33, bad), Lines{"NOT_FINITE " + kClip + "/KEYV"});  // a weight
        EXPECT_EQ(faults_with_number("/KEYV", 12, bad), Lines{"NOT_FINITE " + kClip + "/KEYV"});  // a tangent
    }
}

TEST(Clip, WantsRotationsOfUnitLength) {
    EXPECT_EQ(faults_with_number("/KEYV", 45, 0.9f), in_table("ROTATION_NOT_UNIT"));  // in fixed frames
}

TEST(Clip, LetsCubicRotationsBeOfAnyLength) {
    EXPECT_EQ(faults_with_number("/KEYV", 16, 0.9f), Lines{});  // a value: it is normalised when it is sampled
    EXPECT_EQ(faults_with_number("/KEYV", 12, 0.9f), Lines{});  // an in-tangent
    EXPECT_EQ(faults_with_number("/KEYV", 20, 0.9f), Lines{});  // an out-tangent
}

TEST(Clip, LetsTracksShareAllTheirValuesOrNone) {
    const auto faults = [](std::uint64_t first, std::uint32_t keys) {
        return faults_with_track(kScale, [=](auto& track) { track.first_value = first, track.keys = keys; });
    };
    EXPECT_EQ(faults(0, 3), Lines{});  // the translation's
    EXPECT_EQ(faults(0, 2), in_table("KEY_OVERLAP"));
    EXPECT_EQ(faults(3, 2), in_table("KEY_OVERLAP"));
    EXPECT_EQ(faults(6, 3), in_table("KEY_OVERLAP"));
    EXPECT_EQ(faults(34, 3), in_table("KEY_OVERLAP"));
}

TEST(Clip, RefusesEvenOneSharedNumber) {
    EXPECT_EQ(faults_with_track(kFixedFrames, [](auto& track) { track.first_value = 36; }), in_table("KEY_OVERLAP"));
}

TEST(Clip, LetsTracksShareTimesAsTheyLike) {
    EXPECT_EQ(
        faults_with_track(kScale, [](auto& track) { track.first_time = 1, track.keys = 2, track.first_value = 0; }),
        in_table("KEY_OVERLAP"));
    EXPECT_EQ(faults_with_track(kWeights, [](auto& track) { track.first_time = 1; }), Lines{});
}

TEST(Clip, HoldsItsFixedFrames) {
    // Three frames at 4 a second take half a second.
    EXPECT_EQ(faults_with_clip([](auto& clip) { clip.frame_rate = 4.001f; }), Lines{});
    EXPECT_EQ(faults_with_clip([](auto& clip) { clip.frame_rate = 3.9f; }), in_info("CLIP_LENGTH"));
    EXPECT_EQ(faults_with_clip([](auto& clip) { clip.frame_rate = 1e-40f; }), in_info("CLIP_LENGTH"));
}

TEST(Clip, WantsUnitLengthOfLinearRotationsThatACubicTrackShares) {
    // Twelve numbers: one cubic key for one joint, three linear ones for another, of which two are the tangents.
    Node root = sample();
    edit<TrackRecord>(
        table(root), [](auto& track) { track.keys = 1; }, kCubicRotation * sizeof(TrackRecord));
    edit<TrackRecord>(
        table(root), [](auto& track) { track.first_value = 9; }, kFixedFrames * sizeof(TrackRecord));
    EXPECT_EQ(faults_in(root), in_table("ROTATION_NOT_UNIT"));
}

TEST(Clip, HoldsRotationsThatTwoJointsShareToUnitLengthOnce) {
    Node root = sample();
    Buffer& tracks = table(root).payload;
    const std::size_t end = tracks.size();
    const Buffer fixed_frames(tracks.end() - sizeof(TrackRecord), tracks.end());
    tracks.insert(tracks.end(), fixed_frames.begin(), fixed_frames.end());
    edit<TrackRecord>(
        table(root), [](auto& track) { track.target = 3; }, end);
    EXPECT_EQ(faults_in(root), Lines{});
    set(at(root, kClip + "/KEYV"), 45 * sizeof(float), 0.9f);
    EXPECT_EQ(faults_in(root), in_table("ROTATION_NOT_UNIT"));
}

TEST(Clip, RefusesTwoTracksForOneProperty) {
    EXPECT_EQ(faults_with_track(kFixedFrames, [](auto& track) { track.target = 1; }), in_table("TRACK_REPEATED"));
    EXPECT_EQ(faults_with_track(kScale, [](auto& track) { track.target = 0; }),
              Lines{});  // another property of joint 0
    EXPECT_EQ(faults_with_track(kScale, [](auto& track) { track.target = 0, track.path = 0; }),
              in_table("TRACK_REPEATED"));
}

}  // namespace
}  // namespace bendy::clip_test
