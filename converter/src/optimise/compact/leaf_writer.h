#pragma once

#include <bendy/format/chunk_writer.h>
#include <bendy/format/codec.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::converter {

/// The layout of the numbers in a leaf's payload; zeros: unknown.
struct LeafShape {
    std::uint16_t head = 0;    ///< bytes before the rows
    std::uint16_t row = 0;     ///< bytes of a row
    std::uint16_t number = 0;  ///< bytes of a number
    bool is_triangles = false;
    bool is_packed_clip = false;
    bool sums = false;  ///< rows of u16 with a constant sum
};

struct EncodedLeaf {
    Codec codec = Codec::raw;
    std::vector<std::byte> bytes;  ///< empty: store the payload as is
};

/// The smallest of all encodings that fit the shape; raw if none saves anything.
EncodedLeaf encode_leaf(Bytes payload, const LeafShape& shape);

/// A ChunkWriter that can store each leaf in its smallest encoding.
class LeafWriter {
public:
    /// \param is_draft  stores every leaf raw, and is compact otherwise
    explicit LeafWriter(bool is_compact, bool is_draft = false) : is_compact_(is_compact), is_draft_(is_draft) {}

    [[nodiscard]] bool is_compact() const { return is_compact_; }
    void reserve(std::uint64_t bytes) { chunks_.reserve(bytes); }
    void begin(FourCC id) { chunks_.begin(id); }
    void end() { chunks_.end(); }

    /// Writes a leaf raw: it must be readable without decoding, or is compressed already.
    void raw_leaf(FourCC id, std::span<const Bytes> pieces) { chunks_.leaf(id, pieces); }

    void leaf(FourCC id, std::span<const Bytes> pieces, const LeafShape& shape = {}) {
        if (!is_compact_ || is_draft_) {
            chunks_.leaf(id, pieces);
            return;
        }
        std::vector<std::byte> payload;
        for (const Bytes piece : pieces) payload.insert(payload.end(), piece.begin(), piece.end());
        const EncodedLeaf encoded = encode_leaf(payload, shape);
        const bool is_raw = encoded.codec == Codec::raw;
        chunks_.leaf(id, is_raw ? Bytes(payload) : Bytes(encoded.bytes), codec_flags(encoded.codec));
    }
    void leaf(FourCC id, Bytes payload, const LeafShape& shape = {}) { leaf(id, std::span(&payload, 1), shape); }
    void text_leaf(FourCC id, std::string_view text) { leaf(id, as_byte_span(text)); }

    std::vector<std::byte> finish() && { return std::move(chunks_).finish(); }

private:
    /// A header's flags with the codec in their upper byte.
    static std::uint16_t codec_flags(Codec codec) {
        return static_cast<std::uint16_t>(static_cast<unsigned>(codec) << 8U);
    }

    ChunkWriter chunks_;
    bool is_compact_;
    bool is_draft_;
};

}  // namespace bendy::converter
