#include <bendy/format/packed_clip.h>

#include <bendy/format/codec.h>

#include "edit_file.h"
#include "packed_samples.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace bendy::packed_clip_test {
namespace {

using namespace test;

constexpr std::uint32_t kJoints = 23;

Buffer payload_of(const PackedSamples& samples) {
    return write_packed(samples).value();
}

std::optional<PackedView> read(Bytes payload, std::uint32_t joints = kJoints) {
    Faults faults;
    auto view = read_packed(payload, joints, 0, faults);
    EXPECT_EQ(view.has_value(), faults.empty());
    return view;
}

/// Does all that can be done with a view; the sum keeps it from being left out.
double use(const PackedView& view) {
    double sum = 0.0;
    const std::vector<RestRecord> rests(kJoints);
    for (const UnpackedTrack& track : unpack_clip(view, rests)) sum += track.values.back();
    for (const float seconds : {-1.0f, 0.0f, 0.51f, 0.7f, 1e30f, std::numeric_limits<float>::quiet_NaN()}) {
        PackedGroupReader reader(view, packed_moment(view, seconds).frame);
        for (PackedGroup group; reader.next(group);) sum += group.left[0][0] + group.right[2][group.count - 1];
    }
    Faults faults;
    check_packed_values(view, 0, faults);
    return sum;
}

TEST(PackedClip, GivesBackWhatWasWritten) {
    for (const std::uint32_t segment : {0u, 1u, 4u, 16u, 39u, 40u, 100u}) {
        const PackedSamples samples = make_samples(kJoints, 40, segment);
        const Buffer payload = payload_of(samples);
        const auto view = read(payload);
        ASSERT_TRUE(view) << segment;
        const PackedSamples again = packed_samples(*view);
        EXPECT_EQ(again.frames, samples.frames);
        EXPECT_EQ(again.start, samples.start);
        EXPECT_EQ(again.frame_rate, samples.frame_rate);
        EXPECT_EQ(again.tracks, samples.tracks);
        EXPECT_EQ(payload_of(again), payload);
    }
}

TEST(PackedClip, WalkMeetsEveryTrackAtEveryFrame) {
    const PackedSamples samples = make_samples(kJoints, 40, 16);
    const Buffer payload = payload_of(samples);
    const auto view = read(payload);
    ASSERT_TRUE(view);
    for (std::uint32_t frame = 0; frame < 40; ++frame) {
        PackedGroupReader reader(*view, frame);
        std::size_t track = 0;
        for (PackedGroup group; reader.next(group);) {
            for (std::uint32_t t = 0; t < group.count; ++t, ++track) {
                const PackedTrack& expected = samples.tracks.at(track);
                ASSERT_EQ(group.joints[t], expected.joint);
                for (std::uint32_t c = 0; c < expected.components; ++c) {
                    const auto at = [&](std::uint32_t f) {
                        const float number = static_cast<float>(expected.numbers[expected.animated ? c * 40 + f : c]);
                        return number * packed_step(expected.steps[c]);
                    };
                    ASSERT_EQ(group.left[c][t], at(frame));
                    ASSERT_EQ(group.right[c][t], at(std::min(frame + 1, 39u)));
                }
            }
        }
        ASSERT_EQ(track, samples.tracks.size());
    }
}

TEST(PackedClip, IsLaidOutAsTheSpecificationSays) {
    // One joint turns about x: -1, 2, 5 steps; another stands 7 steps along y. Written by hand from PACK.md.
    PackedSamples samples;
    samples.frames = 3;
    samples.start = 0.0f;
    samples.frame_rate = 24.0f;
    samples.joints = 2;
    samples.tracks.push_back({TrackPath::rotation, 0, {120, 121, 122}, 3, true, {-1, 2, 5, 0, 0, 0, 9, 9, 9}});
    samples.tracks.push_back({TrackPath::translation, 1, {130, 130, 130}, 3, false, {0, 7, 0}});
    const std::vector<int> expected{3,    0,   0,   0,                          // frames
                                    0,    0,   0,   0,   0,   0,   192, 65,     // start, rate: 24
                                    2,    0,   0,   0,                          // joints, one segment
                                    0x06, 0,   0,   0,                          // lists 1 and 2
                                    1,    2,                                    // joint 0; joint 1
                                    120,  121, 122, 130, 130, 130,              // steps
                                    0,    0,   7,   0,   0,   0,                // list 2's bases
                                    3,    0,   0,   255, 255, 0,   0,   9,  0,  // widths and bases of list 1
                                    0,    3,   6,                               // frames
                                    0,    0,   0,   0};
    std::vector<int> found;
    for (const std::byte byte : payload_of(samples)) found.push_back(std::to_integer<int>(byte));
    EXPECT_EQ(found, expected);
}

TEST(PackedClip, StepsAreQuarterOctaves) {
    EXPECT_EQ(packed_step(160), 1.0f);
    EXPECT_EQ(packed_step(0), std::ldexp(1.0f, -40));
    EXPECT_EQ(packed_step(158), std::sqrt(0.5f));
    for (int code = 4; code < 256; ++code)
        EXPECT_EQ(packed_step(static_cast<std::uint8_t>(code)), 2 * packed_step(static_cast<std::uint8_t>(code - 4)));
}

TEST(PackedClip, WideNumbersFitUpTo24Bits) {
    PackedSamples samples = make_samples(1, 2, 0);
    samples.tracks = {{TrackPath::translation, 0, {100, 100, 100}, 3, true, {0, (1 << 24) - 1, 5, 5, -70000, -70000}}};
    const Buffer payload = payload_of(samples);
    const auto view = read(payload, 1);
    ASSERT_TRUE(view);
    EXPECT_EQ(packed_samples(*view).tracks, samples.tracks);
    samples.tracks[0].numbers[1] = 1 << 24;
    EXPECT_FALSE(write_packed(samples));
}

TEST(PackedClip, FramesThatNothingIsAnimatedInCostNothing) {
    PackedSamples samples = make_samples(1, 0xffff'ffff, 1);
    samples.tracks = {{TrackPath::translation, 0, {100, 100, 100}, 3, false, {1, 2, 3}}};
    const auto payload = write_packed(samples);  // for minutes, if it went through its segments
    ASSERT_TRUE(payload);
    EXPECT_LT(payload->size(), 200u);
}

TEST(PackedClip, FindsTheMoment) {
    const Buffer payload = payload_of(make_samples(kJoints, 40, 0));
    const auto view = read(payload);
    ASSERT_TRUE(view);
    EXPECT_EQ(packed_moment(*view, 0.0f).frame, 0u);
    EXPECT_EQ(packed_moment(*view, 0.5f + 12.25f / 24.0f).frame, 12u);
    EXPECT_NEAR(packed_moment(*view, 0.5f + 12.25f / 24.0f).fraction, 0.25, 1e-5);
    EXPECT_EQ(packed_moment(*view, 100.0f).frame, 39u);
    EXPECT_EQ(packed_moment(*view, 100.0f).fraction, 0.0);
    EXPECT_EQ(packed_moment(*view, std::numeric_limits<float>::quiet_NaN()).frame, 0u);
}

TEST(PackedClip, FramesMayHaveTimesOfTheirOwn) {
    PackedSamples samples = make_samples(kJoints, 4, 0);
    samples.frame_rate = 0.0f;
    samples.times = {0.5f, 0.6f, 1.0f, 3.0f};
    const Buffer payload = payload_of(samples);
    const auto view = read(payload);
    ASSERT_TRUE(view);
    EXPECT_EQ(packed_moment(*view, 0.8f).frame, 1u);
    EXPECT_NEAR(packed_moment(*view, 0.8f).fraction, 0.5, 1e-6);
    EXPECT_EQ(packed_moment(*view, 3.5f).frame, 3u);
    EXPECT_EQ(packed_samples(*view).times, samples.times);
    Faults faults;
    check_packed_values(*view, 0, faults);
    EXPECT_TRUE(faults.empty());
}

TEST(PackedClip, TimesThatNobodyHasCheckedAreHarmless) {
    PackedSamples samples = make_samples(kJoints, 4, 0);
    samples.frame_rate = 0.0f;
    samples.times = {0.5f, std::numeric_limits<float>::quiet_NaN(), 1.0f, 3.0f};
    const Buffer payload = payload_of(samples);
    const auto view = read(payload);
    ASSERT_TRUE(view);
    EXPECT_EQ(packed_moment(*view, 0.8f).frame, 0u);
    EXPECT_EQ(packed_moment(*view, 0.8f).fraction, 0.0);
}

TEST(PackedClip, OneFrameIsOneSegmentOrNone) {
    PackedSamples samples = make_samples(kJoints, 2, 16);
    samples.frames = 1;
    std::erase_if(samples.tracks, [](const PackedTrack& track) { return track.animated; });
    const Buffer payload = payload_of(samples);
    const auto view = read(payload);
    ASSERT_TRUE(view);
    EXPECT_EQ(packed_samples(*view).tracks, samples.tracks);
}

TEST(PackedClip, SaysWhatItAnimates) {
    const Buffer payload = payload_of(make_samples(kJoints, 4, 0));
    const auto view = read(payload);
    ASSERT_TRUE(view);
    EXPECT_TRUE(view->animates(1, TrackPath::rotation));
    EXPECT_TRUE(view->animates(kJoints - 1, TrackPath::rotation));
    EXPECT_FALSE(view->animates(kJoints, TrackPath::rotation));
    EXPECT_FALSE(view->animates(kNone, TrackPath::rotation));
}

TEST(PackedClip, UnpacksToUnitRotationsAndSums) {
    PackedSamples samples = make_samples(1, 2, 0);
    const double turn = 1.5;
    const auto steps = static_cast<std::int32_t>(std::lround(turn / packed_step(120)));
    samples.tracks = {{TrackPath::rotation, 0, {120, 120, 120}, 3, true, {0, steps, 0, 0, 0, 0}},
                      {TrackPath::scale, 0, {120, 160, 160}, 1, false, {100}}};
    const Buffer payload = payload_of(samples);
    const auto view = read(payload, 1);
    ASSERT_TRUE(view);
    RestRecord rest;
    rest.rotation = {0.0f, 0.6f, 0.0f, 0.8f};
    rest.scale = {2.0f, 2.0f, 2.0f};
    const auto tracks = unpack_clip(*view, std::array{rest});
    ASSERT_EQ(tracks.size(), 2u);
    const auto& rotation = tracks[0].values;
    // (0, 0.6, 0, 0.8) * (sin, 0, 0, cos) of half the turn
    EXPECT_NEAR(rotation[4], 0.8 * std::sin(turn / 2), 1e-3);
    EXPECT_NEAR(rotation[5], 0.6 * std::cos(turn / 2), 1e-3);
    EXPECT_NEAR(rotation[6], -0.6 * std::sin(turn / 2), 1e-3);
    EXPECT_NEAR(rotation[7], 0.8 * std::cos(turn / 2), 1e-3);
    EXPECT_NEAR(tracks[1].values[2], 2.0 + 100 * packed_step(120), 1e-6);
}

TEST(PackedClip, DamageIsRefusedOrHarmless) {
    for (const std::uint32_t segment : {0u, 5u}) {
        const Buffer good = payload_of(make_samples(kJoints, 12, segment));
        std::size_t refused = 0;
        double sum = 0.0;
        for (std::size_t at = 0; at < good.size(); ++at) {
            for (const int value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
                Buffer bad = good;
                bad[at] = static_cast<std::byte>(value);
                Faults faults;
                const auto view = read_packed(bad, kJoints, 0, faults);
                if (view) {
                    sum += use(*view);
                } else {
                    ++refused;
                }
            }
        }
        EXPECT_GT(refused, 300u) << sum;
    }
}

TEST(PackedClip, EveryPrefixIsRefused) {
    const Buffer good = payload_of(make_samples(kJoints, 12, 5));
    for (std::size_t size = 0; size < good.size(); ++size) {
        // A buffer of its own, so that a read past its end is one past an allocation.
        const Buffer prefix(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
        Faults faults;
        EXPECT_FALSE(read_packed(prefix, kJoints, 0, faults)) << size;
    }
}

TEST(PackedClip, MoreJointsThanThereAreIsAFault) {
    const Buffer payload = payload_of(make_samples(kJoints, 12, 0));
    Faults faults;
    EXPECT_FALSE(read_packed(payload, kJoints - 1, 0, faults));
    ASSERT_EQ(faults.count(), 1u);
    EXPECT_EQ(faults.list()[0].code, ErrorCode::kJointRange);
}

// --- the codec

Buffer encoded(const Buffer& payload) {
    return encode_payload(Codec::clip, payload, 0, 0).value();
}

bool decodes_to(const Buffer& bytes, Buffer& out) {
    CodecHeader header;
    if (check_encoded(static_cast<unsigned>(Codec::clip), bytes, header)) return false;
    out.assign(header.size, std::byte{});
    return decode_payload(Codec::clip, bytes, out);
}

TEST(ClipCodec, GivesBackThePayload) {
    for (const std::uint32_t frames : {2u, 3u, 40u, 300u}) {
        for (const std::uint32_t segment : {0u, 16u}) {
            PackedSamples samples = make_samples(kJoints, frames, segment);
            for (const bool even : {true, false}) {
                if (!even) {
                    samples.frame_rate = 0.0f;
                    for (std::uint32_t f = 0; f < frames; ++f) samples.times.push_back(0.5f + static_cast<float>(f));
                }
                const Buffer payload = payload_of(samples);
                Buffer out;
                ASSERT_TRUE(decodes_to(encoded(payload), out));
                EXPECT_EQ(out, payload);
            }
        }
    }
}

TEST(ClipCodec, SmoothMotionGetsSmaller) {
    PackedSamples samples = make_samples(1, 200, 0);
    samples.tracks = {{TrackPath::translation, 0, {120, 120, 120}, 3, true, {}}};
    for (int c = 0; c < 3; ++c) {
        for (int f = 0; f < 200; ++f)
            samples.tracks[0].numbers.push_back(static_cast<std::int32_t>(1000 * std::sin(0.05 * f + c)));
    }
    const Buffer payload = payload_of(samples);
    EXPECT_LT(encoded(payload).size() * 2, payload.size());
}

TEST(ClipCodec, DoesNotTakeWhatWritePackedDoesNotMake) {
    Buffer payload = payload_of(make_samples(kJoints, 12, 0));
    EXPECT_TRUE(encode_payload(Codec::clip, payload, 0, 0));
    payload.push_back(std::byte{});
    EXPECT_FALSE(encode_payload(Codec::clip, payload, 0, 0));
    EXPECT_FALSE(encode_payload(Codec::clip, {}, 0, 0));
}

TEST(ClipCodec, DamageIsRefusedOrHarmless) {
    const Buffer good = encoded(payload_of(make_samples(kJoints, 12, 5)));
    for (std::size_t at = 0; at < good.size(); ++at) {
        for (const int value : {0x00, 0x01, 0x55, 0x80, 0xff}) {
            Buffer bad = good;
            bad[at] = static_cast<std::byte>(value);
            Buffer out;
            if (!decodes_to(bad, out)) continue;
            Faults faults;
            if (const auto view = read_packed(out, kJoints, 0, faults)) use(*view);
        }
    }
    for (std::size_t size = 0; size < good.size(); ++size) {
        Buffer out;
        EXPECT_FALSE(decodes_to(Buffer(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)), out));
    }
}

constexpr std::size_t kZstdMagic = 4;

/// What lies under the codec's zstd frame: spec/codecs.md calls it the plain form.
Buffer plain_form(const Buffer& encoded) {
    CodecHeader header;
    std::uint32_t size = 0;
    copy_at(encoded, sizeof header, size);
    header.size = size;
    const Bytes head = bytes_of(header);
    Buffer frame(head.begin(), head.end());
    for (const unsigned magic : {0x28u, 0xb5u, 0x2fu, 0xfdu}) frame.push_back(static_cast<std::byte>(magic));
    frame.insert(frame.end(), encoded.begin() + sizeof header + sizeof size, encoded.end());
    Buffer plain(size);
    EXPECT_TRUE(decode_payload(Codec::zstd, frame, plain));
    return plain;
}

/// The other way round; `size` is what the header says of the payload.
Buffer with_plain_form(const Buffer& plain, std::uint64_t size) {
    const auto frame = encode_payload(Codec::zstd, plain, 0, 0).value();
    const CodecHeader header{size, 0, 0, 0};
    const Bytes head = bytes_of(header);
    Buffer encoded(head.begin(), head.end());
    const auto plain_size = static_cast<std::uint32_t>(plain.size());
    const Bytes stated = bytes_of(plain_size);
    encoded.insert(encoded.end(), stated.begin(), stated.end());
    encoded.insert(encoded.end(), frame.begin() + sizeof header + kZstdMagic, frame.end());
    return encoded;
}

TEST(ClipCodec, RefusesEveryPrefixOfItsPlainForm) {
    PackedSamples samples = make_samples(kJoints, 3, 0);
    samples.frame_rate = 0.0f;
    samples.times = {0.5f, 0.75f, 1.0f};
    const Buffer payload = payload_of(samples);
    const Buffer plain = plain_form(encoded(payload));
    Buffer out;
    ASSERT_TRUE(decodes_to(with_plain_form(plain, payload.size()), out));
    EXPECT_EQ(out, payload);
    for (std::size_t size = 0; size < plain.size(); ++size) {
        const Buffer prefix(plain.begin(), plain.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_FALSE(decodes_to(with_plain_form(prefix, payload.size()), out)) << size;
    }
}

TEST(ClipCodec, RefusesAClipOfNoFrames) {
    PackRecord record;
    record.frame_rate = 0.0f;
    const Bytes bytes = bytes_of(record);
    Buffer out;
    EXPECT_FALSE(decodes_to(with_plain_form({bytes.begin(), bytes.end()}, sizeof record), out));
}

TEST(ClipCodec, RefusesARecordThatItsNumbersDoNotGive) {
    PackedSamples samples = make_samples(1, 3, 0);
    samples.tracks = {{TrackPath::translation, 0, {120, 120, 120}, 3, true, {1, 2, 3, 4, 5, 6, 7, 8, 9}}};
    const Buffer payload = payload_of(samples);
    const Buffer plain = plain_form(encoded(payload));
    Buffer out;
    ASSERT_TRUE(decodes_to(with_plain_form(plain, payload.size()), out));
    const auto refuses = [&](std::size_t at, unsigned bits) {
        Buffer changed = plain;
        changed[at] ^= static_cast<std::byte>(bits);
        return !decodes_to(with_plain_form(changed, payload.size()), out);
    };
    for (unsigned list = 0; list < kPackedLists; ++list)
        EXPECT_TRUE(refuses(offsetof(PackRecord, wide), 1u << list)) << list;
    EXPECT_TRUE(refuses(offsetof(PackRecord, reserved), 1u));
}

// --- in a file

Lines faults_with_pack(const PackedSamples& samples) {
    Node root = sample();
    Node& clip = at(root, "HEAD/OBJE/CYCL");
    const Buffer payload = payload_of(samples);
    clip.children.push_back(make_leaf(FourCC("PACK"), payload));
    return faults_in(root);
}

PackedSamples small_samples() {
    PackedSamples samples;
    samples.frames = 3;
    samples.start = 0.5f;
    samples.frame_rate = 4.0f;
    samples.joints = 4;
    samples.tracks = {{TrackPath::rotation, 3, {130, 130, 130}, 3, true, {1, 2, 3, 4, 5, 6, 7, 8, 9}}};
    return samples;
}

TEST(PackedClipInFile, IsRead) {
    EXPECT_EQ(faults_with_pack(small_samples()), Lines{});
}

TEST(PackedClipInFile, MustNotAnimateWhatATrackAnimates) {
    PackedSamples samples = small_samples();
    samples.tracks[0].joint = 2;
    EXPECT_EQ(faults_with_pack(samples), Lines{"TRACK_REPEATED HEAD/OBJE/CYCL/TRAK"});
}

TEST(PackedClipInFile, MustLieInsideTheClip) {
    PackedSamples samples = small_samples();
    samples.frame_rate = 2.0f;
    EXPECT_EQ(faults_with_pack(samples), Lines{"CLIP_LENGTH HEAD/OBJE/CYCL/CINF"});
}

TEST(PackedClipInFile, TimesMustAscendAndBeFinite) {
    PackedSamples samples = small_samples();
    samples.frame_rate = 0.0f;
    samples.times = {0.5f, 0.5f, 1.0f};
    EXPECT_EQ(faults_with_pack(samples), Lines{"KEY_ORDER HEAD/OBJE/CYCL/PACK"});
    samples.times = {0.5f, std::numeric_limits<float>::quiet_NaN(), 1.0f};
    EXPECT_EQ(faults_with_pack(samples), Lines{"NOT_FINITE HEAD/OBJE/CYCL/PACK"});
}

}  // namespace
}  // namespace bendy::packed_clip_test
