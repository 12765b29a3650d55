#include <bendy/format/packed_clip.h>

#include <bendy/format/slerp.h>
#include <bendy/format/trig.h>

#include "packed_layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace bendy {
namespace {

using namespace packed;

using Quaternion = std::array<double, 4>;

Quaternion normalised(const Quaternion& q) {
    double square = 0.0;
    for (const double c : q) square += c * c;
    if (!(square > 0.0)) return {0.0, 0.0, 0.0, 1.0};
    const double length = std::sqrt(square);
    return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

Quaternion product(const Quaternion& a, const Quaternion& b) {
    return {
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

Quaternion slerp(const Quaternion& a, const Quaternion& b, double u) {
    double dot = 0.0;
    for (std::size_t c = 0; c < 4; ++c) dot += a[c] * b[c];
    const SlerpWeights weights = slerp_weights(dot, u);
    Quaternion q;
    for (std::size_t c = 0; c < 4; ++c) q[c] = weights.first * a[c] + weights.second * b[c];
    return normalised(q);
}

/// Returns the tracks with their steps; constants with their numbers, animated ones with room for them.
std::vector<PackedTrack> list_tracks(const PackedView& view) {
    std::vector<PackedTrack> tracks;
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        const PackedKind& kind = kPackedKinds[k];
        const PackedList& list = view.lists[k];
        std::uint32_t joint = 0;
        for (std::uint32_t t = 0; t < list.count; ++t, ++joint) {
            while (!has_joint(list, joint)) ++joint;
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

void put_base(std::vector<std::byte>& out, std::int32_t base, std::uint32_t size) {
    const auto bytes = std::as_bytes(std::span(&base, 1)).first(size);
    out.insert(out.end(), bytes.begin(), bytes.end());
}

struct Range {
    std::int32_t base = 0;
    std::uint32_t width = 0;
};

Range range_of(std::span<const std::int32_t> numbers) {
    const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
    const auto span = static_cast<std::uint32_t>(*high) - static_cast<std::uint32_t>(*low);
    return {*low, static_cast<std::uint32_t>(std::bit_width(span))};
}

bool is_of(const PackedTrack& track, const PackedKind& kind) {
    return track.path == kind.path && track.components == kind.components && track.animated == kind.animated;
}

/// Writes PackedSamples: see the layout in spec/chunks/PACK.md.
class PackWriter {
public:
    explicit PackWriter(const PackedSamples& samples) : samples_(samples) {
        record_.frames = samples.frames;
        record_.start = samples.start;
        record_.frame_rate = samples.frame_rate;
        record_.joints = static_cast<std::uint16_t>(samples.joints);
        record_.segment_frames = static_cast<std::uint16_t>(samples.segment_frames);
        segments_ = segment_count(record_);
        for (std::size_t k = 0; k < kPackedLists; ++k) {
            for (const PackedTrack& track : samples.tracks) {
                if (is_of(track, kPackedKinds[k])) lists_[k].push_back(&track);
            }
            if (!lists_[k].empty()) record_.lists |= static_cast<std::uint8_t>(1u << k);
        }
    }

    std::optional<std::vector<std::byte>> write() {
        if (!find_ranges()) return std::nullopt;
        out_.resize(sizeof record_);
        std::memcpy(out_.data(), &record_, sizeof record_);
        for (const auto& list : lists_) put_joints(list);
        for (std::size_t k = 0; k < kPackedLists; ++k) {
            for (std::uint32_t c = 0; c < kPackedKinds[k].components; ++c) {
                for (const PackedTrack* track : lists_[k]) out_.push_back(static_cast<std::byte>(track->steps[c]));
            }
        }
        for (std::size_t k = 0; k < kPackedLists; ++k) {
            if (!kPackedKinds[k].animated) put_bases(k, 0);
        }
        const Bytes times = std::as_bytes(std::span(samples_.times));
        out_.insert(out_.end(), times.begin(), times.end());
        if (animated_) put_segments();
        out_.resize(out_.size() + kPackedTail);
        if (out_.size() > 0xffff'ffffu) return std::nullopt;
        return std::move(out_);
    }

private:
    [[nodiscard]] std::span<const std::int32_t> numbers(const PackedTrack& track, std::uint32_t c,
                                                        std::uint32_t segment) const {
        if (!track.animated) return std::span(track.numbers).subspan(c, 1);
        const std::uint32_t first = segment * record_.segment_frames;
        return std::span(track.numbers).subspan(std::size_t{c} * samples_.frames + first, frames_of(segment));
    }
    [[nodiscard]] std::uint32_t frames_of(std::uint32_t segment) const {
        return segment + 1 < segments_ ? record_.segment_frames + 1u
                                       : record_.frames - segment * record_.segment_frames;
    }
    /// For list k: [segment][component][track].
    Range& range(std::size_t k, std::uint32_t segment, std::uint32_t c, std::size_t track) {
        return ranges_[k][(std::size_t{segment} * kPackedKinds[k].components + c) * lists_[k].size() + track];
    }

    bool find_ranges() {
        for (std::size_t k = 0; k < kPackedLists; ++k) {
            const PackedKind& kind = kPackedKinds[k];
            const std::uint32_t segments = kind.animated ? segments_ : 1;
            ranges_[k].resize(lists_[k].size() * kind.components * segments);
            if (lists_[k].empty()) continue;  // otherwise it would iterate over frames that have no bytes
            animated_ = animated_ || kind.animated;
            for (std::uint32_t s = 0; s < segments; ++s) {
                for (std::size_t t = 0; t < lists_[k].size(); ++t) {
                    std::uint32_t bits = 0;
                    for (std::uint32_t c = 0; c < kind.components; ++c) {
                        const Range found = range_of(numbers(*lists_[k][t], c, s));
                        range(k, s, c, t) = found;
                        bits += found.width;
                        if (found.width > kMaxPackedBits) return false;
                        if (found.base != static_cast<std::int16_t>(found.base))
                            record_.wide |= static_cast<std::uint8_t>(1u << k);
                    }
                    if (kind.animated && bits == 0) range(k, s, 0, t).width = 1;
                }
            }
        }
        return true;
    }

    void put_joints(const std::vector<const PackedTrack*>& list) {
        if (list.empty()) return;
        const std::size_t at = out_.size();
        out_.resize(at + (samples_.joints + 7) / 8);
        for (const PackedTrack* track : list)
            out_[at + track->joint / 8] |= static_cast<std::byte>(1u << (track->joint % 8));
    }

    void put_bases(std::size_t k, std::uint32_t segment) {
        const std::uint32_t size = (record_.wide >> k & 1u) != 0 ? 4 : 2;
        for (std::uint32_t c = 0; c < kPackedKinds[k].components; ++c) {
            for (std::size_t t = 0; t < lists_[k].size(); ++t) put_base(out_, range(k, segment, c, t).base, size);
        }
    }

    void put_segments() {
        const std::size_t offsets = out_.size();
        if (segments_ > 1) out_.resize(offsets + std::size_t{segments_} * 4);
        for (std::uint32_t s = 0; s < segments_; ++s) {
            const auto at = static_cast<std::uint32_t>(out_.size());
            if (segments_ > 1) std::memcpy(out_.data() + offsets + std::size_t{s} * 4, &at, sizeof at);
            put_segment(s);
        }
    }

    void put_segment(std::uint32_t s) {
        std::uint64_t bits = 0;
        for (std::size_t k = 0; k < kPackedLists; ++k) {
            if (!kPackedKinds[k].animated) continue;
            for (std::uint32_t c = 0; c < kPackedKinds[k].components; ++c) {
                for (std::size_t t = 0; t < lists_[k].size(); ++t) {
                    out_.push_back(static_cast<std::byte>(range(k, s, c, t).width));
                    bits += range(k, s, c, t).width;
                }
            }
            put_bases(k, s);
        }
        const std::size_t frames = out_.size();
        const std::uint64_t stride = (bits + 7) / 8;
        out_.resize(frames + frames_of(s) * stride);
        const std::vector<Column> columns = columns_of(s);
        for (std::uint32_t f = 0; f < frames_of(s); ++f) put_frame(columns, f, out_.data() + frames + f * stride);
    }

    /// One component of a track in a segment.
    struct Column {
        const std::int32_t* numbers;  ///< of the segment's frames
        std::uint32_t base, width;
    };

    /// In the order of a frame.
    std::vector<Column> columns_of(std::uint32_t s) {
        std::vector<Column> columns;
        for (std::size_t k = 0; k < kPackedLists; ++k) {
            if (!kPackedKinds[k].animated) continue;
            for (std::size_t group = 0; group < lists_[k].size(); group += kPackedGroup) {
                const std::size_t end = std::min<std::size_t>(group + kPackedGroup, lists_[k].size());
                for (std::uint32_t c = 0; c < kPackedKinds[k].components; ++c) {
                    for (std::size_t t = group; t < end; ++t) {
                        const Range& found = range(k, s, c, t);
                        columns.push_back(
                            {numbers(*lists_[k][t], c, s).data(), static_cast<std::uint32_t>(found.base), found.width});
                    }
                }
            }
        }
        return columns;
    }

    static void put_frame(std::span<const Column> columns, std::uint32_t f, std::byte* to) {
        std::uint64_t word = 0;
        std::uint32_t bits = 0;  // in `word`; fewer than 32 before a number is added
        for (const Column& column : columns) {
            word |= std::uint64_t{static_cast<std::uint32_t>(column.numbers[f]) - column.base} << bits;
            bits += column.width;
            if (bits < 32) continue;
            std::memcpy(to, &word, 4);
            to += 4;
            word >>= 32;
            bits -= 32;
        }
        std::memcpy(to, &word, (bits + 7) / 8);
    }

    const PackedSamples& samples_;
    PackRecord record_;
    std::uint32_t segments_ = 1;
    bool animated_ = false;
    std::array<std::vector<const PackedTrack*>, kPackedLists> lists_;
    std::array<std::vector<Range>, kPackedLists> ranges_;
    std::vector<std::byte> out_;
};

}  // namespace

std::array<double, 4> packed_rotation(const std::array<double, 3>& vector) {
    const double square = (vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]) / 4;
    const double half = std::sqrt(std::min(square, kMaxHalfTurnSquare));
    const trig::SinCos of = trig::sin_cos(half);
    const double factor = half < 1e-8 ? 0.5 : of.sin / (2.0 * half);
    return normalised({vector[0] * factor, vector[1] * factor, vector[2] * factor, of.cos});
}

std::array<double, 4> blend_packed_rotations(const std::array<float, 4>& rest, const std::array<double, 3>& left,
                                             const std::array<double, 3>& right, double fraction) {
    const Quaternion base = normalised({rest[0], rest[1], rest[2], rest[3]});
    Quaternion between = packed_rotation(left);
    if (fraction > 0.0) between = slerp(between, packed_rotation(right), fraction);
    return normalised(product(base, between));
}

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

std::optional<std::vector<std::byte>> write_packed(const PackedSamples& samples) {
    return PackWriter(samples).write();
}

}  // namespace bendy
