#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/error.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// PACK: tracks of a clip as quantised samples on one grid of frames, decoded in place. spec/chunks/PACK.md describes
// the layout.
namespace BENDY_PUBLIC bendy {

/// The content of one of PACK's lists of tracks. Numbers are relative to the joint's rest transform: rotations are
/// rotation vectors (radians, along the joint's axes at rest: q = rest * exp(v)), translations and scales are added.
struct PackedKind {
    TrackPath path = TrackPath::rotation;
    bool animated = false;         ///< true: one value per frame; false: one value
    std::uint32_t components = 3;  ///< 1: a uniform scale
};
inline constexpr std::size_t kPackedLists = 8;
inline constexpr std::array<PackedKind, kPackedLists> kPackedKinds{{{TrackPath::rotation, false, 3},
                                                                    {TrackPath::rotation, true, 3},
                                                                    {TrackPath::translation, false, 3},
                                                                    {TrackPath::translation, true, 3},
                                                                    {TrackPath::scale, false, 1},
                                                                    {TrackPath::scale, true, 1},
                                                                    {TrackPath::scale, false, 3},
                                                                    {TrackPath::scale, true, 3}}};

inline constexpr unsigned kMaxPackedBits = 24;    ///< per number: exact in a float, and covered by a 32-bit read at its
                                                  ///< first byte
inline constexpr std::uint32_t kPackedGroup = 8;  ///< number of tracks whose numbers are stored together, component by
                                                  ///< component
inline constexpr std::uint32_t kPackedTail = 4;  ///< zero bytes at the end, so that 32 bits can be read at every number
/// The square of half the maximum length of a rotation vector in radians, slightly more than a full turn. Longer ones
/// are decoded as if they were 2 sqrt(kMaxHalfTurnSquare) long, and the result is normalised.
inline constexpr double kMaxHalfTurnSquare = 10.89;

/// Returns the step for a code: 2^((code - 160) / 4), from 2^-40.
float packed_step(std::uint8_t code);

/// One list of tracks: the location of its parts in the payload.
struct PackedList {
    Bytes joints;                  ///< one bit per joint, ascending
    std::uint32_t count = 0;       ///< number of tracks
    Bytes steps;                   ///< components * count codes
    Bytes constants;               ///< for a list that is not animated: components * count bases
    std::uint32_t base_bytes = 2;  ///< size of a base: 2 or 4
};

/// A PACK payload that has been read and checked: decoding it stays in bounds, whatever it contains.
struct PackedView {
    PackRecord record;
    Bytes payload;
    std::array<PackedList, kPackedLists> lists;
    std::uint64_t times_at = 0;          ///< offset of the times, f32 per frame, unless is_even()
    std::uint32_t segments = 0;          ///< 0 if no track is animated
    std::uint32_t animated_numbers = 0;  ///< total number of components of all animated tracks
    std::uint64_t offsets_at = 0;        ///< offset of u32 per segment, if there are several; the end of the times
    std::uint64_t first_segment = 0;     ///< offset of segment 0
    std::uint64_t table_bytes = 0;       ///< size of a segment's widths and bases

    /// Returns true if the property of the joint is animated.
    [[nodiscard]] bool animates(std::uint32_t joint, TrackPath path) const;
    /// Returns the time of a frame in seconds on the clip's time line.
    [[nodiscard]] double time_of(std::uint32_t frame) const;
    /// True if the frames are evenly spaced: no times are stored. read_packed has decided it once, because a denormal
    /// rate compares equal to 0 in a thread that takes denormal numbers for zero.
    [[nodiscard]] bool is_even() const { return times_at == offsets_at; }
};

/// A position between two frames: `frame` and, if fraction is not 0, the one after it.
struct PackedMoment {
    std::uint32_t frame = 0;
    double fraction = 0.0;  ///< [0, 1)
};
PackedMoment packed_moment(const PackedView& view, float seconds);

/// The location of one segment's tables and frames: for each animated list in order its widths (a byte per component
/// and track), then its bases; then the frames.
struct PackedSegment {
    std::uint64_t tables = 0;
    std::uint64_t frames = 0;
    std::uint64_t stride = 0;  ///< size of a frame in bytes
    std::uint32_t first = 0;   ///< number of the first frame
    std::uint32_t count = 0;   ///< number of frames, including the next segment's first one
};
/// Returns the segment that contains a frame and, unless it is the last one, the frame after it.
PackedSegment packed_segment(const PackedView& view, std::uint32_t frame);

/// Reads a PACK payload and makes all checks that memory safety depends on: sizes, counts, widths, joints below
/// `joints`. If something is wrong, adds a fault at `offset` and returns nothing. Linear in the payload's size;
/// allocates nothing.
std::optional<PackedView> read_packed(Bytes payload, std::uint32_t joints, std::uint64_t offset, Faults& faults);

/// The values of up to kPackedGroup tracks at both ends of a frame interval, relative to rest: [component][track], not
/// interpolated.
struct PackedGroup {
    PackedKind kind;
    std::uint32_t count = 0;
    std::array<std::uint32_t, kPackedGroup> joints{};
    std::array<std::array<float, kPackedGroup>, 3> left{};
    std::array<std::array<float, kPackedGroup>, 3> right{};  ///< those of the next frame; for a constant the same
};

/// Iterates over the tracks of a PACK, group by group, at one frame and the one after it. Scalar, portable and exact:
/// the reference for tests.
class PackedGroupReader {
public:
    PackedGroupReader(const PackedView& view, std::uint32_t frame);
    /// Reads the next group; returns false if there is none.
    bool next(PackedGroup& group);

private:
    void read_numbers(const PackedList& list, std::uint32_t first, PackedGroup& group);

    const PackedView& view_;
    PackedSegment segment_;
    std::size_t list_ = 0;
    std::uint32_t track_ = 0;   // in the list
    std::uint32_t joint_ = 0;   // to examine next
    std::uint64_t tables_ = 0;  // of the list: offset in the payload
    std::uint64_t bit_left_ = 0;
    std::uint64_t bit_right_ = 0;
};

/// Returns exp of a rotation vector: x y z w, unit.
std::array<double, 4> packed_rotation(const std::array<double, 3>& vector);
/// Returns the slerp of rest * exp(left) and rest * exp(right) along the shorter arc; x y z w, unit.
std::array<double, 4> blend_packed_rotations(const std::array<float, 4>& rest, const std::array<double, 3>& left,
                                             const std::array<double, 3>& right, double fraction);

/// The samples of a PACK as integers: the input of the writer, and of the clip codec.
struct PackedTrack {
    TrackPath path = TrackPath::rotation;
    std::uint32_t joint = 0;
    std::array<std::uint8_t, 3> steps{160, 160, 160};  ///< codes, one per component
    std::uint32_t components = 3;                      ///< 1 or 3
    bool animated = false;
    std::vector<std::int32_t> numbers;  ///< components * (animated ? frames : 1), ordered by component

    friend bool operator==(const PackedTrack&, const PackedTrack&) = default;
};
struct PackedSamples {
    std::uint32_t frames = 1;
    float start = 0.0f;        ///< seconds
    float frame_rate = 1.0f;   ///< per second
    std::vector<float> times;  ///< seconds, one per frame, if frame_rate is 0
    std::uint32_t joints = 0;
    std::uint32_t segment_frames = 0;  ///< 0: one segment
    std::vector<PackedTrack> tracks;   ///< ordered by list, then joint
};

/// Returns the payload; nothing if a number's range needs more than kMaxPackedBits.
std::optional<std::vector<std::byte>> write_packed(const PackedSamples& samples);
/// Returns the samples of a payload that has been read: at most 96 times the payload's bytes.
PackedSamples packed_samples(const PackedView& view);

/// A packed track as ordinary linear keys, one per frame: for output without PACK.
struct UnpackedTrack {
    TrackPath path = TrackPath::rotation;
    std::uint32_t joint = 0;
    std::uint32_t components = 4;
    std::vector<float> times;
    std::vector<float> values;
};
/// \param rests  of the model's joints, as many as were passed to read_packed
std::vector<UnpackedTrack> unpack_clip(const PackedView& view, std::span<const RestRecord> rests);

/// Adds faults of content: times that are not finite or do not ascend, a negative rate.
void check_packed_values(const PackedView& view, std::uint64_t offset, Faults& faults);

}  // namespace bendy
