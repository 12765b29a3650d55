#include <bendy/format/packed_clip.h>

#include "packed_layout.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace bendy {
namespace {

using namespace packed;

/// Returns the tracks with their steps; constants with their numbers, animated ones with room for them.
std::vector<PackedTrack> list_tracks(const PackedView& view) {
    std::vector<PackedTrack> tracks;
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        const PackedKind& kind = kPackedKinds[k];
        const PackedList& list = view.lists[k];
        std::uint32_t joint = 0;
        for (std::uint32_t t = 0; t < list.count; ++t, ++joint) {
            while ((byte_at(list.joints, joint / 8) >> (joint % 8) & 1u) == 0) ++joint;
            PackedTrack track{kind.path, joint, {160, 160, 160}, kind.components, kind.animated, {}};
            track.numbers.resize(std::size_t{kind.components} * (kind.animated ? view.record.frames : 1));
            for (std::uint32_t c = 0; c < kind.components; ++c) {
                const std::uint64_t number = std::uint64_t{c} * list.count + t;
                track.steps[c] = static_cast<std::uint8_t>(list.steps[number]);
                if (!kind.animated)
                    track.numbers[c] = base_at(list.constants, number * list.base_bytes, list.base_bytes);
            }
            tracks.push_back(std::move(track));
        }
    }
    return tracks;
}

/// Reads one frame of one list.
class FrameReader {
public:
    /// \param bit  position of the frame in the payload
    FrameReader(const PackedView& view, const PackedSegment& segment, std::uint64_t bit)
        : view_(view), tables_(segment.tables), bit_(bit) {}

    /// Sets the numbers of the list's tracks for the frame; must be called for one list after another.
    void read(const PackedList& list, const PackedKind& kind, PackedTrack* const* tracks, std::uint32_t frame) {
        for (std::uint32_t group = 0; group < list.count; group += kPackedGroup) {
            const std::uint32_t end = std::min(group + kPackedGroup, list.count);
            for (std::uint32_t c = 0; c < kind.components; ++c) {
                for (std::uint32_t t = group; t < end; ++t)
                    tracks[t]->numbers[std::size_t{c} * view_.record.frames + frame] = next(list, kind, c, t);
            }
        }
        tables_ += table_bytes(list, kind);
    }

private:
    std::int32_t next(const PackedList& list, const PackedKind& kind, std::uint32_t c, std::uint32_t t) {
        const std::uint64_t number = std::uint64_t{c} * list.count + t;
        const std::uint64_t bases = tables_ + std::uint64_t{kind.components} * list.count;
        const std::uint32_t width = byte_at(view_.payload, tables_ + number);
        const std::int32_t base = base_at(view_.payload, bases + number * list.base_bytes, list.base_bytes);
        bit_ += width;
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(base) +
                                         bits_at(view_.payload, bit_ - width, width));
    }

    const PackedView& view_;
    std::uint64_t tables_;
    std::uint64_t bit_;
};

}  // namespace

PackedSamples packed_samples(const PackedView& view) {
    PackedSamples samples;
    samples.frames = view.record.frames;
    samples.start = view.record.start;
    samples.frame_rate = view.record.frame_rate;
    if (!view.is_even()) {
        for (std::uint32_t f = 0; f < samples.frames; ++f) samples.times.push_back(static_cast<float>(view.time_of(f)));
    }
    samples.joints = view.record.joints;
    samples.segment_frames = view.record.segment_frames;
    samples.tracks = list_tracks(view);
    std::vector<PackedTrack*> animated;
    for (PackedTrack& track : samples.tracks) {
        if (track.animated) animated.push_back(&track);
    }
    for (std::uint32_t s = 0; s < view.segments; ++s) {
        const PackedSegment segment = packed_segment(view, s * view.record.segment_frames);
        for (std::uint32_t f = 0; f < segment.count; ++f) {
            FrameReader reader(view, segment, (segment.frames + f * segment.stride) * 8);
            PackedTrack* const* tracks = animated.data();
            for (std::size_t k = 0; k < kPackedLists; ++k) {
                if (!kPackedKinds[k].animated) continue;
                reader.read(view.lists[k], kPackedKinds[k], tracks, segment.first + f);
                tracks += view.lists[k].count;
            }
        }
    }
    return samples;
}

std::vector<UnpackedTrack> unpack_clip(const PackedView& view, std::span<const RestRecord> rests) {
    std::vector<UnpackedTrack> tracks;
    for (const PackedTrack& packed : packed_samples(view).tracks) {
        UnpackedTrack track;
        track.path = packed.path;
        track.joint = packed.joint;
        track.components = packed.path == TrackPath::rotation ? 4 : 3;
        const std::uint32_t keys = packed.animated ? view.record.frames : 1;
        const RestRecord& rest = rests[packed.joint];
        track.times.reserve(keys);
        track.values.reserve(std::size_t{keys} * track.components);
        for (std::uint32_t key = 0; key < keys; ++key) {
            track.times.push_back(static_cast<float>(view.time_of(key)));
            std::array<float, 3> value{};
            for (std::uint32_t c = 0; c < 3; ++c) {
                const std::uint32_t from = c < packed.components ? c : 0;
                value[c] = static_cast<float>(packed.numbers[std::size_t{from} * keys + key]) *
                           packed_step(packed.steps[from]);
            }
            if (packed.path == TrackPath::rotation) {
                const std::array<double, 3> vector{value[0], value[1], value[2]};
                for (const double q : blend_packed_rotations(rest.rotation, vector, vector, 0.0))
                    track.values.push_back(static_cast<float>(q));
                continue;
            }
            const auto& at_rest = packed.path == TrackPath::translation ? rest.translation : rest.scale;
            for (std::uint32_t c = 0; c < 3; ++c) track.values.push_back(at_rest[c] + value[c]);
        }
        tracks.push_back(std::move(track));
    }
    return tracks;
}

}  // namespace bendy
