#include "optimise/compact/leaf_writer.h"

#include <bendy/format/chunk.h>

#include <algorithm>
#include <cstddef>
#include <optional>

namespace bendy::converter {
namespace {

/// For a longer payload, the encodings are compared on a sample from its middle.
constexpr std::size_t kSample = std::size_t{1} << 16U;
constexpr std::size_t kLong = 16 * kSample;

/// A codec with its arguments for encode_payload.
struct Way {
    Codec codec = Codec::raw;
    std::uint16_t head = 0;
    std::uint16_t stride = 0;
};

/// The codecs that fit a shape, in order of preference.
class Ways {
public:
    explicit Ways(const LeafShape& shape) {
        if (shape.is_packed_clip) add(Codec::clip, 0, 0);
        if (shape.is_triangles) {
            add(Codec::indices, shape.head, shape.number);
            add(Codec::indices_zstd, shape.head, shape.number);
        }
        if (shape.row != 0) {
            add(Codec::vertices, shape.head, shape.row);
            add(Codec::vertices_zstd, shape.head, shape.row);
            add(Codec::zstd, 0, shape.row);
            if (shape.sums) add(Codec::sums, shape.head, shape.row);
        }
        if (shape.number > 1 && shape.number != shape.row) add(Codec::zstd, 0, shape.number);
        add(Codec::zstd, 0, 0);
    }
    [[nodiscard]] std::span<const Way> list() const { return std::span(ways_).first(count_); }

private:
    void add(Codec codec, std::uint16_t head, std::uint16_t stride) { ways_[count_++] = {codec, head, stride}; }

    std::array<Way, kCodecs + 2> ways_{};  // zstd may occur three times
    std::size_t count_ = 0;
};

/// Encodes a payload in one way; nothing unless the padded size is less than `least`.
std::optional<std::vector<std::byte>> encode(Bytes payload, const Way& way, std::uint64_t least) {
    auto encoded = encode_payload(way.codec, payload, way.head, way.stride);
    if (encoded && padded(encoded->size()) >= least) encoded.reset();
    return encoded;
}

EncodedLeaf smallest(Bytes payload, std::span<const Way> ways) {
    EncodedLeaf best;
    std::uint64_t least = padded(payload.size());
    for (const Way& way : ways) {
        auto encoded = encode(payload, way, least);
        if (!encoded) continue;
        least = padded(encoded->size());
        best = {way.codec, std::move(*encoded)};
    }
    return best;
}

/// The head, and rows from the middle: whole rows and whole triangles.
std::vector<std::byte> take_sample(Bytes payload, const LeafShape& shape) {
    const std::size_t row = std::size_t{3} * (shape.row != 0 ? shape.row : std::max<std::size_t>(shape.number, 1));
    const Bytes rows = payload.subspan(shape.head);
    std::vector<std::byte> sample(payload.begin(), payload.begin() + shape.head);
    const Bytes middle = rows.subspan(rows.size() / 2 / row * row, kSample / row * row);
    sample.insert(sample.end(), middle.begin(), middle.end());
    return sample;
}

/// The ways sorted by the size of the encoded sample.
std::vector<Way> by_size(Bytes sample, std::span<const Way> ways) {
    std::vector<std::pair<std::uint64_t, Way>> sizes;
    for (const Way& way : ways) {
        if (const auto encoded = encode(sample, way, padded(sample.size()))) sizes.emplace_back(encoded->size(), way);
    }
    std::stable_sort(sizes.begin(), sizes.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Way> sorted;
    sorted.reserve(sizes.size());
    for (const auto& [size, way] : sizes) sorted.push_back(way);
    return sorted;
}

}  // namespace

EncodedLeaf encode_leaf(Bytes payload, const LeafShape& shape) {
    const Ways ways(shape);
    if (payload.size() < shape.head + kLong) return smallest(payload, ways.list());
    for (const Way& way : by_size(take_sample(payload, shape), ways.list())) {
        // The best way may fail for the whole payload: the ratio of decoded to encoded bytes is limited.
        if (auto encoded = encode(payload, way, padded(payload.size()))) return {way.codec, std::move(*encoded)};
    }
    return {};
}

}  // namespace bendy::converter
