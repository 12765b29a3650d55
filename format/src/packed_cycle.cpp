#include <bendy/format/packed_cycle.h>

#include <bendy/format/trig.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace bendy {
namespace {

/// Takes parts off the payload one after another; a part that does not fit ends it all.
class Parts {
public:
    explicit Parts(Bytes payload) : payload_(payload) {}

    Bytes take(std::uint64_t size) {
        if (is_short_ || size > payload_.size() - at_) {
            is_short_ = true;
            return {};
        }
        at_ += size;
        return payload_.subspan(at_ - size, size);
    }
    [[nodiscard]] std::uint64_t at() const { return at_; }
    [[nodiscard]] bool is_short() const { return is_short_; }

private:
    Bytes payload_;
    std::uint64_t at_ = 0;
    bool is_short_ = false;
};

std::uint32_t byte_at(Bytes bytes, std::uint64_t at) {
    return static_cast<std::uint32_t>(bytes[at]);
}

std::int32_t base_at(Bytes payload, std::uint64_t at, std::uint32_t size) {
    if (size == 2) {
        std::int16_t base = 0;
        copy_at(payload, at, base);
        return base;
    }
    std::int32_t base = 0;
    copy_at(payload, at, base);
    return base;
}

std::uint32_t bits_at(Bytes payload, std::uint64_t bit, std::uint32_t width) {
    std::uint32_t word = 0;
    copy_at(payload, bit / 8, word);
    return (word >> (bit % 8)) & ((1u << width) - 1);
}

std::uint64_t table_bytes(const PackedList& list, const PackedKind& kind) {
    return std::uint64_t{list.count} * kind.components * (1 + list.base_bytes);
}

std::uint64_t all_table_bytes(const PackedView& view) {
    std::uint64_t bytes = 0;
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        if (kPackedKinds[k].animated) bytes += table_bytes(view.lists[k], kPackedKinds[k]);
    }
    return bytes;
}

/// The bits of one list: as many joints as the record says, none past them.
bool read_joints(Bytes bits, std::uint32_t joints, PackedList& list) {
    list.joints = bits;
    for (const std::byte byte : bits)
        list.count += static_cast<std::uint32_t>(std::popcount(std::to_integer<unsigned>(byte)));
    return joints % 8 == 0 || bits.empty() || byte_at(bits, bits.size() - 1) >> (joints % 8) == 0;
}

/// Bits of a frame of the segment whose tables start at `at`; nothing if a width is not allowed, or a track has none.
std::optional<std::uint64_t> frame_bits(const PackedView& view, std::uint64_t at) {
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        const PackedList& list = view.lists[k];
        const PackedKind& kind = kPackedKinds[k];
        if (!kind.animated) continue;
        for (std::uint32_t track = 0; track < list.count; ++track) {
            std::uint64_t of_track = 0;
            for (std::uint32_t c = 0; c < kind.components; ++c) {
                const std::uint32_t width = byte_at(view.payload, at + std::uint64_t{c} * list.count + track);
                if (width > kMaxPackedBits) return std::nullopt;
                of_track += width;
            }
            if (of_track == 0) return std::nullopt;
            bits += of_track;
        }
        at += table_bytes(list, kind);
    }
    return bits;
}

std::uint32_t segment_count(const PackRecord& record) {
    if (record.segment_frames == 0 || record.frames < 2) return 1;
    return (record.frames - 2) / record.segment_frames + 1;
}

/// Holds the segments' places and sizes against the payload.
bool check_segments(const PackedView& view, Parts parts, std::uint64_t offset, Faults& faults) {
    const PackRecord& record = view.record;
    const std::uint64_t tables = all_table_bytes(view);
    for (std::uint32_t s = 0; s < view.segments; ++s) {
        if (view.segments > 1) {
            std::uint32_t stated = 0;
            copy_at(view.payload, view.offsets_at + std::uint64_t{s} * 4, stated);
            if (stated != parts.at()) {
                faults.add({ErrorCode::kCountMismatch, offset, stated, parts.at()});
                return false;
            }
        }
        const std::uint64_t at = parts.at();
        parts.take(tables);
        const auto bits = parts.is_short() ? std::nullopt : frame_bits(view, at);
        if (!parts.is_short() && !bits) {
            faults.add({ErrorCode::kEnumRange, offset, s, kMaxPackedBits});
            return false;
        }
        const std::uint32_t first = s * record.segment_frames;
        const std::uint32_t count = s + 1 < view.segments ? record.segment_frames + 1u : record.frames - first;
        parts.take(count * ((bits.value_or(0) + 7) / 8));
        if (parts.is_short()) break;
    }
    const Bytes tail = parts.take(kPackedTail);
    if (parts.is_short() || parts.at() != view.payload.size()) {
        faults.add({ErrorCode::kRecordSize, offset, view.payload.size(), parts.at()});
        return false;
    }
    if (std::any_of(tail.begin(), tail.end(), [](std::byte b) { return b != std::byte{}; })) {
        faults.add({ErrorCode::kReservedField, offset, 1});
        return false;
    }
    return true;
}

/// Puts the low `width` bits of `value` at a bit of zeros.
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
    /// Of list k: [segment][component][track].
    Range& range(std::size_t k, std::uint32_t segment, std::uint32_t c, std::size_t track) {
        return ranges_[k][(std::size_t{segment} * kPackedKinds[k].components + c) * lists_[k].size() + track];
    }

    bool find_ranges() {
        for (std::size_t k = 0; k < kPackedLists; ++k) {
            const PackedKind& kind = kPackedKinds[k];
            const std::uint32_t segments = kind.animated ? segments_ : 1;
            ranges_[k].resize(lists_[k].size() * kind.components * segments);
            animated_ = animated_ || (kind.animated && !lists_[k].empty());
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
    const double sign = dot < 0.0 ? -1.0 : 1.0;
    const double angle = trig::acos(std::abs(dot));
    double weight_a = 1.0 - u;
    double weight_b = u;
    constexpr double kStraight = 1e-6;  // below it sin(angle) is angle and slerp is linear
    if (angle >= kStraight) {
        const double sine = trig::sin_cos(angle).sin;
        weight_a = trig::sin_cos(angle * (1.0 - u)).sin / sine;
        weight_b = trig::sin_cos(angle * u).sin / sine;
    }
    Quaternion q;
    for (std::size_t c = 0; c < 4; ++c) q[c] = weight_a * a[c] + sign * weight_b * b[c];
    return normalised(q);
}

/// The last frame that is not after the time, by bisection.
PackedMoment uneven_moment(const PackedView& view, float seconds) {
    std::uint32_t left = 0;
    std::uint32_t right = view.record.frames;
    while (right - left > 1) {
        const std::uint32_t middle = left + (right - left) / 2;
        (view.time_of(middle) <= seconds ? left : right) = middle;
    }
    const double start = view.time_of(left);
    if (right == view.record.frames || !(seconds > start)) return {left, 0.0};
    const double fraction = (seconds - start) / (view.time_of(right) - start);
    return {left, fraction < 1.0 ? fraction : 0.0};
}

}  // namespace

float packed_step(std::uint8_t code) {
    constexpr std::array<double, 4> kRoots{1.0, 1.189207115002721, 1.4142135623730951, 1.681792830507429};
    return static_cast<float>(std::ldexp(kRoots[code % 4], code / 4 - 40));
}

bool PackedView::animates(std::uint32_t joint, TrackPath path) const {
    if (joint >= record.joints) return false;
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        if (kPackedKinds[k].path != path || lists[k].count == 0) continue;
        if ((byte_at(lists[k].joints, joint / 8) >> (joint % 8) & 1u) != 0) return true;
    }
    return false;
}

double PackedView::time_of(std::uint32_t frame) const {
    if (is_even()) return double{record.start} + frame / double{record.frame_rate};
    float time = 0.0f;
    copy_at(payload, times_at + std::uint64_t{frame} * 4, time);
    return time;
}

PackedMoment packed_moment(const PackedView& view, float seconds) {
    if (!view.is_even()) return uneven_moment(view, seconds);
    const double frame = (double{seconds} - view.record.start) * view.record.frame_rate;
    const std::uint32_t last = view.record.frames - 1;
    if (!(frame > 0.0)) return {};
    if (frame >= last) return {last, 0.0};
    const auto whole = static_cast<std::uint32_t>(frame);
    return {whole, frame - whole};
}

PackedSegment packed_segment(const PackedView& view, std::uint32_t frame) {
    PackedSegment segment;
    std::uint64_t begin = view.first_segment;
    std::uint64_t end = view.payload.size() - kPackedTail;
    std::uint32_t number = 0;
    segment.count = view.record.frames;
    if (view.segments > 1) {
        number = std::min(frame / view.record.segment_frames, view.segments - 1);
        segment.first = number * view.record.segment_frames;
        std::uint32_t offset = 0;
        copy_at(view.payload, view.offsets_at + std::uint64_t{number} * 4, offset);
        begin = offset;
        if (number + 1 < view.segments) {
            copy_at(view.payload, view.offsets_at + std::uint64_t{number} * 4 + 4, offset);
            end = offset;
        }
        segment.count =
            number + 1 < view.segments ? view.record.segment_frames + 1u : view.record.frames - segment.first;
    }
    segment.tables = begin;
    segment.frames = begin + view.table_bytes;
    segment.stride = (end - segment.frames) / segment.count;
    return segment;
}

std::optional<PackedView> read_packed(Bytes payload, std::uint32_t joints, std::uint64_t offset, Faults& faults) {
    PackedView view;
    view.payload = payload;
    PackRecord& record = view.record;
    if (payload.size() < sizeof record) {
        faults.add({ErrorCode::kRecordTooShort, offset, payload.size(), sizeof record});
        return std::nullopt;
    }
    copy_at(payload, 0, record);
    if (record.joints > joints) {
        faults.add({ErrorCode::kJointRange, offset, record.joints, joints});
        return std::nullopt;
    }
    if (record.reserved != decltype(record.reserved){} || (record.wide & ~record.lists) != 0) {
        faults.add({ErrorCode::kReservedField, offset, 1});
        return std::nullopt;
    }
    Parts parts(payload);
    parts.take(sizeof record);
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        if ((record.lists >> k & 1u) == 0) continue;
        if (read_joints(parts.take((record.joints + 7u) / 8), record.joints, view.lists[k])) continue;
        faults.add({ErrorCode::kJointRange, offset, record.joints, joints});
        return std::nullopt;
    }
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        PackedList& list = view.lists[k];
        list.steps = parts.take(std::uint64_t{list.count} * kPackedKinds[k].components);
        list.base_bytes = (record.wide >> k & 1u) != 0 ? 4 : 2;
        if (kPackedKinds[k].animated) view.animated_numbers += list.count * kPackedKinds[k].components;
    }
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        PackedList& list = view.lists[k];
        if (!kPackedKinds[k].animated)
            list.constants = parts.take(std::uint64_t{list.count} * kPackedKinds[k].components * list.base_bytes);
    }
    if (record.frames == 0 || (record.frames < 2 && view.animated_numbers > 0)) {
        faults.add({ErrorCode::kKeyRange, offset, 0});
        return std::nullopt;
    }
    view.table_bytes = all_table_bytes(view);
    view.segments = view.animated_numbers == 0 ? 0 : segment_count(record);
    view.times_at = parts.at();
    if (record.frame_rate == 0.0f) parts.take(std::uint64_t{record.frames} * 4);
    view.offsets_at = parts.at();
    if (view.segments > 1) parts.take(std::uint64_t{view.segments} * 4);
    view.first_segment = parts.at();
    if (parts.is_short()) {
        faults.add({ErrorCode::kRecordSize, offset, payload.size(), parts.at()});
        return std::nullopt;
    }
    if (!check_segments(view, parts, offset, faults)) return std::nullopt;
    return view;
}

PackedWalk::PackedWalk(const PackedView& view, std::uint32_t frame) : view_(view) {
    if (view.animated_numbers == 0) return;
    segment_ = packed_segment(view, frame);
    const std::uint32_t right = std::min(frame + 1, view.record.frames - 1);
    tables_ = segment_.tables;
    bit_left_ = (segment_.frames + (frame - segment_.first) * segment_.stride) * 8;
    bit_right_ = (segment_.frames + (right - segment_.first) * segment_.stride) * 8;
}

bool PackedWalk::next(PackedGroup& group) {
    while (list_ < kPackedLists && track_ >= view_.lists[list_].count) {
        if (kPackedKinds[list_].animated) tables_ += table_bytes(view_.lists[list_], kPackedKinds[list_]);
        ++list_;
        track_ = 0;
        joint_ = 0;
    }
    if (list_ >= kPackedLists) return false;
    const PackedList& list = view_.lists[list_];
    group.kind = kPackedKinds[list_];
    group.count = std::min(kPackedGroup, list.count - track_);
    for (std::uint32_t found = 0; found < group.count; ++joint_) {
        if ((byte_at(list.joints, joint_ / 8) >> (joint_ % 8) & 1u) != 0) group.joints[found++] = joint_;
    }
    read_numbers(list, track_, group);
    track_ += group.count;
    return true;
}

void PackedWalk::read_numbers(const PackedList& list, std::uint32_t first, PackedGroup& group) {
    const std::uint32_t components = group.kind.components;
    const std::uint64_t bases = tables_ + std::uint64_t{components} * list.count;
    for (std::uint32_t c = 0; c < components; ++c) {
        for (std::uint32_t t = 0; t < group.count; ++t) {
            const std::uint64_t number = std::uint64_t{c} * list.count + first + t;
            const float step = packed_step(static_cast<std::uint8_t>(list.steps[number]));
            const auto value = [&](std::int32_t base, std::uint32_t bits) {
                return static_cast<float>(static_cast<std::int32_t>(static_cast<std::uint32_t>(base) + bits)) * step;
            };
            if (!group.kind.animated) {
                const std::int32_t base = base_at(list.constants, number * list.base_bytes, list.base_bytes);
                group.left[c][t] = group.right[c][t] = value(base, 0);
                continue;
            }
            const std::uint32_t width = byte_at(view_.payload, tables_ + number);
            const std::int32_t base = base_at(view_.payload, bases + number * list.base_bytes, list.base_bytes);
            group.left[c][t] = value(base, bits_at(view_.payload, bit_left_, width));
            group.right[c][t] = value(base, bits_at(view_.payload, bit_right_, width));
            bit_left_ += width;
            bit_right_ += width;
        }
    }
    for (std::uint32_t c = components; c < 3; ++c) {
        group.left[c] = group.left[0];
        group.right[c] = group.right[0];
    }
}

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

std::optional<std::vector<std::byte>> write_packed(const PackedSamples& samples) {
    return PackWriter(samples).write();
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
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        const PackedKind& kind = kPackedKinds[k];
        const PackedList& list = view.lists[k];
        std::uint32_t joint = 0;
        for (std::uint32_t t = 0; t < list.count; ++t, ++joint) {
            while ((byte_at(list.joints, joint / 8) >> (joint % 8) & 1u) == 0) ++joint;
            PackedTrack track{kind.path, joint, {160, 160, 160}, kind.components, kind.animated, {}};
            for (std::uint32_t c = 0; c < kind.components; ++c)
                track.steps[c] = static_cast<std::uint8_t>(list.steps[std::uint64_t{c} * list.count + t]);
            track.numbers.resize(std::size_t{kind.components} * (kind.animated ? samples.frames : 1));
            for (std::uint32_t c = 0; c < kind.components && !kind.animated; ++c) {
                const std::uint64_t number = std::uint64_t{c} * list.count + t;
                track.numbers[c] = base_at(list.constants, number * list.base_bytes, list.base_bytes);
            }
            samples.tracks.push_back(std::move(track));
        }
    }
    std::vector<PackedTrack*> animated;
    for (PackedTrack& track : samples.tracks) {
        if (track.animated) animated.push_back(&track);
    }
    for (std::uint32_t s = 0; s < view.segments; ++s) {
        const PackedSegment segment = packed_segment(view, s * view.record.segment_frames);
        for (std::uint32_t f = 0; f < segment.count; ++f) {
            std::uint64_t bit = (segment.frames + f * segment.stride) * 8;
            std::uint64_t tables = segment.tables;
            std::size_t before = 0;
            for (std::size_t k = 0; k < kPackedLists; ++k) {
                const PackedKind& kind = kPackedKinds[k];
                const PackedList& list = view.lists[k];
                if (!kind.animated) continue;
                const std::uint64_t bases = tables + std::uint64_t{kind.components} * list.count;
                for (std::uint32_t group = 0; group < list.count; group += kPackedGroup) {
                    const std::uint32_t end = std::min(group + kPackedGroup, list.count);
                    for (std::uint32_t c = 0; c < kind.components; ++c) {
                        for (std::uint32_t t = group; t < end; ++t) {
                            const std::uint64_t number = std::uint64_t{c} * list.count + t;
                            const std::uint32_t width = byte_at(view.payload, tables + number);
                            const std::int32_t base =
                                base_at(view.payload, bases + number * list.base_bytes, list.base_bytes);
                            animated[before + t]->numbers[std::size_t{c} * samples.frames + segment.first + f] =
                                static_cast<std::int32_t>(static_cast<std::uint32_t>(base) +
                                                          bits_at(view.payload, bit, width));
                            bit += width;
                        }
                    }
                }
                tables += table_bytes(list, kind);
                before += list.count;
            }
        }
    }
    return samples;
}

std::vector<UnpackedTrack> unpack_cycle(const PackedView& view, std::span<const RestRecord> rests) {
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

void check_packed_values(const PackedView& view, std::uint64_t offset, Faults& faults) {
    const PackRecord& record = view.record;
    for (const float number : {record.start, record.frame_rate}) {
        if (!std::isfinite(number)) faults.add({ErrorCode::kNotFinite, offset, 0});
    }
    if (record.frame_rate < 0.0f) faults.add({ErrorCode::kBelowZero, offset, 8});
    if (view.is_even()) return;
    for (std::uint32_t f = 0; f < record.frames; ++f) {
        const double time = view.time_of(f);
        if (!std::isfinite(time)) {
            faults.add({ErrorCode::kNotFinite, offset, f});
            return;
        }
        if (f > 0 ? !(time > view.time_of(f - 1)) : time != double{record.start}) {
            faults.add({ErrorCode::kKeyOrder, offset, f});
            return;
        }
    }
}

}  // namespace bendy
