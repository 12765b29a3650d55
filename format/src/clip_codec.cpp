#include "codec_parts.h"

#include <bendy/format/packed_clip.h>
#include <bendy/format/public.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace bendy {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{0x28, 0xb5, 0x2f, 0xfd};  // the start of every zstd frame, which is left
                                                                       // out
constexpr unsigned kPredictors = 4;

// All numbers are taken modulo 2^32, so that nothing can overflow.
using Word = std::uint32_t;

Word to_zigzag(Word number) {
    return (number << 1) ^ (0u - (number >> 31));
}
Word from_zigzag(Word number) {
    return (number >> 1) ^ (0u - (number & 1u));
}

/// Predicts number k of a component from the three before it: as the last one, or by extrapolation.
BENDY_ALWAYS_INLINE Word predict(unsigned predictor, std::size_t k, Word last, Word before, Word first) {
    if (predictor == 0 || k < 2) return last;
    const Word rise = last - before;
    if (predictor == 2 && k >= 3) return last + 2 * rise - (before - first);
    if (predictor == 3) return last + static_cast<Word>(static_cast<std::int32_t>(rise) >> 1);
    return last + rise;
}

std::vector<Word> residuals(unsigned predictor, std::span<const Word> numbers) {
    std::vector<Word> found;
    found.reserve(numbers.size());
    Word last = numbers[0], before = 0, first = 0;
    for (std::size_t k = 1; k < numbers.size(); ++k) {
        found.push_back(to_zigzag(numbers[k] - predict(predictor, k, last, before, first)));
        first = before;
        before = last;
        last = numbers[k];
    }
    return found;
}

/// Returns the number of bytes that the largest of the numbers needs, at least 1.
unsigned planes_for(std::span<const Word> numbers) {
    Word all = 0;
    for (const Word number : numbers) all |= number;
    return std::max(1u, (static_cast<unsigned>(std::bit_width(all)) + 7) / 8);
}

void put_plane(std::span<const Word> numbers, unsigned plane, std::vector<std::byte>& out) {
    for (const Word number : numbers) out.push_back(static_cast<std::byte>(number >> (8 * plane)));
}

/// Writes the number of planes, then the planes.
void put_numbers(std::span<const Word> numbers, std::vector<std::byte>& out) {
    const unsigned planes = planes_for(numbers);
    out.push_back(static_cast<std::byte>(planes));
    for (unsigned plane = 0; plane < planes; ++plane) put_plane(numbers, plane, out);
}

/// Writes the plain form of a clip, before zstd.
class Plain {
public:
    explicit Plain(const PackedSamples& samples) : samples_(samples) {}

    /// \param head  the payload's record, the bits of the lists and, if present, the times
    std::vector<std::byte> write(Bytes head) {
        out_.assign(head.begin(), head.end());
        put_steps();
        std::vector<Word> constants;
        std::vector<Word> firsts;
        for (const PackedTrack& track : samples_.tracks) {
            for (std::uint32_t c = 0; c < track.components; ++c)
                add_component(track, c, track.animated ? firsts : constants);
        }
        put_numbers(constants, out_);
        put_numbers(firsts, out_);
        for (const Component& component : components_)
            out_.push_back(static_cast<std::byte>(component.predictor | component.planes << 2));
        for (unsigned plane = 0; plane < 4; ++plane) {
            for (const Component& component : components_) {
                if (component.planes > plane) put_plane(component.residuals, plane, out_);
            }
        }
        return std::move(out_);
    }

private:
    struct Component {
        unsigned predictor = 0;
        unsigned planes = 1;
        std::vector<Word> residuals;
    };

    void put_steps() {
        std::array<std::uint8_t, kTrackPaths> before{160, 160, 160, 160};
        for (const PackedTrack& track : samples_.tracks) {
            auto& last = before[static_cast<std::size_t>(track.path)];
            for (std::uint32_t c = 0; c < track.components; ++c) {
                out_.push_back(static_cast<std::byte>(track.steps[c] - last));
                last = track.steps[c];
            }
        }
    }

    void add_component(const PackedTrack& track, std::uint32_t c, std::vector<Word>& firsts) {
        const std::size_t count = track.animated ? samples_.frames : 1;
        std::vector<Word> numbers(count);
        for (std::size_t k = 0; k < count; ++k) numbers[k] = static_cast<Word>(track.numbers[c * count + k]);
        firsts.push_back(to_zigzag(numbers[0]));
        if (!track.animated) return;
        Component best;
        std::uint64_t least = ~std::uint64_t{0};
        for (unsigned predictor = 0; predictor < kPredictors; ++predictor) {
            std::vector<Word> tried = residuals(predictor, numbers);
            std::uint64_t cost = 0;  // approximate number of bits
            for (const Word residual : tried)
                cost += residual == 0 ? 1u : 1u + 2u * static_cast<unsigned>(std::bit_width(residual));
            if (cost >= least) continue;
            least = cost;
            best.predictor = predictor;
            best.residuals = std::move(tried);
        }
        best.planes = planes_for(best.residuals);
        components_.push_back(std::move(best));
    }

    const PackedSamples& samples_;
    std::vector<Component> components_;
    std::vector<std::byte> out_;
};

/// Reads the plain form; checks every count against the remaining bytes before it allocates anything.
class PlainReader {
public:
    explicit PlainReader(Bytes plain) : plain_(plain) {}

    std::optional<std::vector<std::byte>> payload() {
        if (!read_head() || !read_steps() || !read_numbers()) return std::nullopt;
        return write_packed(samples_);
    }

private:
    Bytes take(std::uint64_t size) {
        if (size > plain_.size() - at_) {
            is_good_ = false;
            return {};
        }
        at_ += size;
        return plain_.subspan(at_ - size, size);
    }

    bool read_head() {
        const Bytes bytes = take(sizeof(PackRecord));
        if (!is_good_) return false;
        PackRecord record;
        copy_at(bytes, 0, record);
        samples_.frames = record.frames;
        samples_.start = record.start;
        samples_.frame_rate = record.frame_rate;
        samples_.joints = record.joints;
        samples_.segment_frames = record.segment_frames;
        for (std::size_t k = 0; k < kPackedLists; ++k) {
            if ((record.lists >> k & 1u) != 0 && !read_list(kPackedKinds[k])) return false;
        }
        if (record.frame_rate == 0.0f) {
            const Bytes times = take(std::uint64_t{record.frames} * sizeof(float));
            if (!is_good_) return false;
            samples_.times.resize(record.frames);
            if (!times.empty()) std::memcpy(samples_.times.data(), times.data(), times.size());
        }
        return record.frames > 0 && (record.frames > 1 || animated_ == 0);
    }

    bool read_list(const PackedKind& kind) {
        const Bytes bits = take((samples_.joints + 7) / 8);
        for (std::size_t joint = 0; joint < bits.size() * 8; ++joint) {
            if ((std::to_integer<unsigned>(bits[joint / 8]) >> (joint % 8) & 1u) == 0) continue;
            if (joint >= samples_.joints) return false;
            PackedTrack track;
            track.path = kind.path;
            track.joint = static_cast<std::uint32_t>(joint);
            track.components = kind.components;
            track.animated = kind.animated;
            (kind.animated ? animated_ : constant_) += kind.components;
            samples_.tracks.push_back(std::move(track));
        }
        return is_good_;
    }

    bool read_steps() {
        const Bytes steps = take(animated_ + constant_);
        if (!is_good_) return false;
        std::array<std::uint8_t, kTrackPaths> last{160, 160, 160, 160};
        std::size_t k = 0;
        for (PackedTrack& track : samples_.tracks) {
            auto& before = last[static_cast<std::size_t>(track.path)];
            for (std::uint32_t c = 0; c < track.components; ++c, ++k) {
                before = static_cast<std::uint8_t>(before + std::to_integer<unsigned>(steps[k]));
                track.steps[c] = before;
            }
        }
        return true;
    }

    /// Reads the number of planes, then numbers in planes.
    std::vector<Word> take_numbers(std::uint64_t count) {
        const Bytes planes = take(1);
        if (!is_good_ || std::to_integer<unsigned>(planes[0]) > 4) {
            is_good_ = false;
            return {};
        }
        const Bytes bytes = take(count * std::to_integer<unsigned>(planes[0]));
        std::vector<Word> numbers(is_good_ ? count : 0);
        for (std::size_t k = 0; k < bytes.size(); ++k)
            numbers[k % count] |= std::to_integer<Word>(bytes[k]) << (8 * (k / count));
        return numbers;
    }

    bool read_numbers() {
        const std::vector<Word> constants = take_numbers(constant_);
        const std::vector<Word> firsts = take_numbers(animated_);
        const Bytes heads = take(animated_);
        if (!is_good_) return false;
        std::uint64_t planes = 0;
        for (const std::byte head : heads) {
            const unsigned of_component = std::to_integer<unsigned>(head) >> 2;
            if (of_component < 1 || of_component > 4) return false;
            planes += of_component;
        }
        const std::uint64_t each = samples_.frames - 1;
        if (planes > 0 && each > (plain_.size() - at_) / planes) return false;
        if (planes * each != plain_.size() - at_) return false;
        std::size_t constant = 0;
        std::size_t component = 0;
        for (PackedTrack& track : samples_.tracks) {
            const std::size_t count = track.animated ? samples_.frames : 1;
            track.numbers.resize(count * track.components);
            for (std::uint32_t c = 0; c < track.components; ++c) {
                const auto numbers = std::span(track.numbers).subspan(c * count, count);
                if (!track.animated) {
                    numbers[0] = static_cast<std::int32_t>(from_zigzag(constants[constant++]));
                    continue;
                }
                numbers_of_.push_back(numbers);
                numbers[0] = static_cast<std::int32_t>(from_zigzag(firsts[component++]));
            }
        }
        for (unsigned plane = 0; plane < 4; ++plane) add_planes(heads, plane);
        for (std::size_t k = 0; k < heads.size(); ++k) undo(std::to_integer<unsigned>(heads[k]) & 3u, numbers_of_[k]);
        return is_good_;
    }

    void add_planes(Bytes heads, unsigned plane) {
        for (std::size_t k = 0; k < heads.size(); ++k) {
            if (std::to_integer<unsigned>(heads[k]) >> 2 <= plane) continue;
            const Bytes bytes = take(samples_.frames - 1);
            std::int32_t* const numbers = numbers_of_[k].data() + 1;
            for (std::size_t f = 0; f < bytes.size(); ++f)
                numbers[f] |= static_cast<std::int32_t>(std::to_integer<Word>(bytes[f]) << (8 * plane));
        }
    }

    /// Turns residuals into numbers.
    static void undo(unsigned predictor, std::span<std::int32_t> numbers) {
        if (predictor == 0) return undo<0>(numbers);
        if (predictor == 1) return undo<1>(numbers);
        return predictor == 2 ? undo<2>(numbers) : undo<3>(numbers);
    }

    template <unsigned predictor>
    static void undo(std::span<std::int32_t> numbers) {
        Word last = static_cast<Word>(numbers[0]), before = 0, first = 0;
        for (std::size_t k = 1; k < numbers.size(); ++k) {
            const Word number = from_zigzag(static_cast<Word>(numbers[k])) + predict(predictor, k, last, before, first);
            numbers[k] = static_cast<std::int32_t>(number);
            first = before;
            before = last;
            last = number;
        }
    }

    Bytes plain_;
    std::uint64_t at_ = 0;
    bool is_good_ = true;
    PackedSamples samples_;
    std::uint64_t constant_ = 0;  // number of components
    std::uint64_t animated_ = 0;
    std::vector<std::span<std::int32_t>> numbers_of_;  // one per animated component
};

/// Returns the part of a payload that the plain form stores unchanged.
std::vector<std::byte> head_of(const PackedView& view) {
    const auto first = [&](std::uint64_t size) { return view.payload.first(size); };
    std::uint64_t size = sizeof(PackRecord);
    for (const PackedList& list : view.lists) size += list.joints.size();
    std::vector<std::byte> head(first(size).begin(), first(size).end());
    if (!view.is_even()) {
        const Bytes times = view.payload.subspan(view.times_at, std::uint64_t{view.record.frames} * sizeof(float));
        head.insert(head.end(), times.begin(), times.end());
    }
    return head;
}

}  // namespace

bool encode_clip(Bytes payload, std::vector<std::byte>& out) {
    Faults faults;
    const auto view = read_packed(payload, kMaxJoints, 0, faults);
    if (!view) return false;
    const PackedSamples samples = packed_samples(*view);
    const std::vector<std::byte> plain = Plain(samples).write(head_of(*view));
    const auto again = write_packed(samples);
    if (!again || !std::equal(again->begin(), again->end(), payload.begin(), payload.end())) return false;
    std::vector<std::byte> frame;
    if (plain.size() > 0xffff'ffffu || !put_zstd(plain, frame)) return false;
    const auto plain_size = static_cast<std::uint32_t>(plain.size());
    const auto head = std::as_bytes(std::span(&plain_size, 1));
    out.insert(out.end(), head.begin(), head.end());
    out.insert(out.end(), frame.begin() + kMagic.size(), frame.end());
    return plain.size() <= out.size() * kMaxCodecRatio;
}

bool decode_clip(Bytes body, std::span<std::byte> out) {
    std::uint32_t size = 0;
    if (body.size() < sizeof size) return false;
    copy_at(body, 0, size);
    if (size > body.size() * kMaxCodecRatio) return false;
    const auto magic = std::as_bytes(std::span(kMagic));
    std::vector<std::byte> frame(magic.begin(), magic.end());
    frame.insert(frame.end(), body.begin() + sizeof size, body.end());
    std::vector<std::byte> plain(size);
    if (!take_zstd(frame, plain)) return false;
    const auto payload = PlainReader(plain).payload();
    if (!payload || payload->size() != out.size()) return false;
    // The payload's record can be derived from the numbers; the stored one must be the same.
    if (!std::equal(plain.begin(), plain.begin() + sizeof(PackRecord), payload->begin())) return false;
    std::copy(payload->begin(), payload->end(), out.begin());
    return true;
}

}  // namespace bendy
