#include <bendy/format/packed_clip.h>

#include "packed_layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

namespace bendy {
namespace {

using namespace packed;

/// Writes the low `width` bits of `value` at a bit position that holds zeros.
void put_bits(std::vector<std::byte>& out, std::uint64_t bit, std::uint32_t value) {
    std::uint64_t word = std::uint64_t{value} << (bit % 8);
    for (std::uint64_t at = bit / 8; word != 0; ++at, word >>= 8) out[at] |= static_cast<std::byte>(word);
}

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
        for (std::uint32_t f = 0; f < frames_of(s); ++f) put_frame(s, f, (frames + f * stride) * 8);
    }

    void put_frame(std::uint32_t s, std::uint32_t f, std::uint64_t bit) {
        for (std::size_t k = 0; k < kPackedLists; ++k) {
            if (!kPackedKinds[k].animated) continue;
            for (std::size_t group = 0; group < lists_[k].size(); group += kPackedGroup) {
                const std::size_t end = std::min<std::size_t>(group + kPackedGroup, lists_[k].size());
                for (std::uint32_t c = 0; c < kPackedKinds[k].components; ++c) {
                    for (std::size_t t = group; t < end; ++t) {
                        const Range& found = range(k, s, c, t);
                        const std::int32_t number = numbers(*lists_[k][t], c, s)[f];
                        put_bits(out_, bit,
                                 static_cast<std::uint32_t>(number) - static_cast<std::uint32_t>(found.base));
                        bit += found.width;
                    }
                }
            }
        }
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

std::optional<std::vector<std::byte>> write_packed(const PackedSamples& samples) {
    return PackWriter(samples).write();
}

}  // namespace bendy
