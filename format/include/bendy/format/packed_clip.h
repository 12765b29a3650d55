#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/faults.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// PACK: tracks of a clip as quantised samples on one grid of frames, decoded in place. spec/chunks/PACK.md has the
// layout.
namespace BENDY_PUBLIC bendy {

/// What a list of PACK's tracks holds. Numbers are relative to the joint's rest transform: rotations are rotation
/// vectors (radians, along the joint's axes at rest: q = rest * exp(v)), translations and scales are added.
struct PackedKind {
    TrackPath path = TrackPath::rotation;
    bool animated = false;         ///< a value for every frame, rather than one
    std::uint32_t components = 3;  ///< 1: a scale that is the same along all axes
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

inline constexpr unsigned kMaxPackedBits = 24;    ///< of a number: a float holds it, and 32 bits read at its byte too
inline constexpr std::uint32_t kPackedGroup = 8;  ///< tracks whose numbers stand together, component by component
inline constexpr std::uint32_t kPackedTail = 4;   ///< zero bytes at the end: 32 bits can be read at every number
/// Rotation vectors are at most so long, radians: a turn and a little. Longer ones are decoded as if they were
/// 2 sqrt(kMaxHalfTurnSquare) long, and the result is normalised.
inline constexpr double kMaxHalfTurnSquare = 10.89;

/// The step that a code stands for: 2^((code - 160) / 4), from 2^-40.
float packed_step(std::uint8_t code);

/// One list of tracks: where its parts lie in the payload.
struct PackedList {
    Bytes joints;                  ///< a bit for each joint, ascending
    std::uint32_t count = 0;       ///< tracks
    Bytes steps;                   ///< components * count codes
    Bytes constants;               ///< of a list that is not animated: components * count bases
    std::uint32_t base_bytes = 2;  ///< of a base: 2 or 4
};

/// A PACK payload that has been read and checked: whatever it holds, decoding it stays in bounds.
struct PackedView {
    PackRecord record;
    Bytes payload;
    std::array<PackedList, kPackedLists> lists;
    std::uint64_t times_at = 0;          ///< f32 for each frame, if the rate is 0
    std::uint32_t segments = 0;          ///< 0 if no track is animated
    std::uint32_t animated_numbers = 0;  ///< components of all animated tracks
    std::uint64_t offsets_at = 0;        ///< u32 for each segment, if there are several
    std::uint64_t first_segment = 0;     ///< where segment 0 starts
    std::uint64_t table_bytes = 0;       ///< of a segment: its widths and bases

    /// Joints that a property of theirs is animated by.
    [[nodiscard]] bool animates(std::uint32_t joint, TrackPath path) const;
    /// Seconds, on the clip's time line.
    [[nodiscard]] double time_of(std::uint32_t frame) const;
    /// The frames are evenly spaced.
    [[nodiscard]] bool is_even() const { return record.frame_rate != 0.0f; }
};

/// A frame pair: `first` and, if fraction is not 0, the one after it.
struct PackedMoment {
    std::uint32_t frame = 0;
    double fraction = 0.0;  ///< [0, 1)
};
PackedMoment packed_moment(const PackedView& view, float seconds);

/// Where one segment's tables and frames lie: for the animated lists in order widths (a byte for each component and
/// track), then bases; then the frames.
struct PackedSegment {
    std::uint64_t tables = 0;
    std::uint64_t frames = 0;
    std::uint64_t stride = 0;  ///< bytes of a frame
    std::uint32_t first = 0;   ///< frame
    std::uint32_t count = 0;   ///< frames, the next segment's first one included
};
/// The segment that holds a frame and, unless the frame is the last one, the frame after it.
PackedSegment packed_segment(const PackedView& view, std::uint32_t frame);

/// Reads a PACK payload and checks all that memory safety hangs on: sizes, counts, widths, joints below `joints`.
/// Nothing and a fault at `offset` if something is wrong. Linear in the payload's size; nothing is allocated.
std::optional<PackedView> read_packed(Bytes payload, std::uint32_t joints, std::uint64_t offset, Faults& faults);

/// Up to kPackedGroup tracks at a moment, relative to rest: [component][track]; without interpolation both ends.
struct PackedGroup {
    PackedKind kind;
    std::uint32_t count = 0;
    std::array<std::uint32_t, kPackedGroup> joints{};
    std::array<std::array<float, kPackedGroup>, 3> left{};
    std::array<std::array<float, kPackedGroup>, 3> right{};  ///< the next frame's; of a constant the same
};

/// Walks over the tracks of a PACK, group after group, at one frame and the one after it. Plain, portable and exact:
/// what others are tested against.
class PackedGroupReader {
public:
    PackedGroupReader(const PackedView& view, std::uint32_t frame);
    /// The next group; false when there is none.
    bool next(PackedGroup& group);

private:
    void read_numbers(const PackedList& list, std::uint32_t first, PackedGroup& group);

    const PackedView& view_;
    PackedSegment segment_;
    std::size_t list_ = 0;
    std::uint32_t track_ = 0;   // of the list
    std::uint32_t joint_ = 0;   // to look at next
    std::uint64_t tables_ = 0;  // of the list, in the payload
    std::uint64_t bit_left_ = 0;
    std::uint64_t bit_right_ = 0;
};

/// exp of a rotation vector: x y z w, unit.
std::array<double, 4> packed_rotation(const std::array<double, 3>& vector);
/// rest * exp(left), rest * exp(right), and between them on the shorter arc (slerp); x y z w, unit.
std::array<double, 4> blend_packed_rotations(const std::array<float, 4>& rest, const std::array<double, 3>& left,
                                             const std::array<double, 3>& right, double fraction);

/// The samples of a PACK as integers: what is written, and what the clip codec works on.
struct PackedTrack {
    TrackPath path = TrackPath::rotation;
    std::uint32_t joint = 0;
    std::array<std::uint8_t, 3> steps{160, 160, 160};  ///< codes, one per component
    std::uint32_t components = 3;                      ///< 1 or 3
    bool animated = false;
    std::vector<std::int32_t> numbers;  ///< components * (animated ? frames : 1), component by component

    friend bool operator==(const PackedTrack&, const PackedTrack&) = default;
};
struct PackedSamples {
    std::uint32_t frames = 1;
    float start = 0.0f;        ///< seconds
    float frame_rate = 1.0f;   ///< per second
    std::vector<float> times;  ///< seconds, of each frame, if frame_rate is 0
    std::uint32_t joints = 0;
    std::uint32_t segment_frames = 0;  ///< 0: one segment
    std::vector<PackedTrack> tracks;   ///< by list, then joint
};

/// The payload; nothing if a number's range needs more than kMaxPackedBits.
std::optional<std::vector<std::byte>> write_packed(const PackedSamples& samples);
/// The samples of a payload that has been read: at most 96 times the payload's bytes.
PackedSamples packed_samples(const PackedView& view);

/// A packed track as ordinary linear keys, one for each frame: what to write when PACK is not wanted.
struct UnpackedTrack {
    TrackPath path = TrackPath::rotation;
    std::uint32_t joint = 0;
    std::uint32_t components = 4;
    std::vector<float> times;
    std::vector<float> values;
};
/// \param rests  of the model's joints, as many as read_packed was given
std::vector<UnpackedTrack> unpack_clip(const PackedView& view, std::span<const RestRecord> rests);

/// Faults of meaning: times that are not finite or do not ascend, a rate below zero.
void check_packed_values(const PackedView& view, std::uint64_t offset, Faults& faults);

}  // namespace bendy
