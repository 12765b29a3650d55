// Every codec, both ways, and packed clips. Input: codec, stride (packed clips: joints), head, a byte that is left
// out, then a payload: encoded, and plain.
#include "check.h"

#include <bendy/format/codec.h>
#include <bendy/format/packed_clip.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace {

using namespace bendy;

void decode(unsigned codec, Bytes encoded) {
    CodecHeader header;
    if (check_encoded(codec, encoded, header)) return;
    fuzz::check(header.size <= kMaxCodecRatio * encoded.size(), "a size is bounded by the encoded bytes");
    AlignedBytes out(header.size);
    (void)decode_payload(static_cast<Codec>(codec), encoded, out.span());
}

void encode(unsigned codec, Bytes payload, std::uint16_t head, std::uint16_t stride) {
    const auto encoded = encode_payload(static_cast<Codec>(codec), payload, head, stride);
    if (!encoded) return;
    CodecHeader header;
    fuzz::check(!check_encoded(codec, *encoded, header), "what was encoded can be decoded");
    AlignedBytes out(header.size);
    fuzz::check(decode_payload(static_cast<Codec>(codec), *encoded, out.span()), "what was encoded is decoded");
    fuzz::check(std::ranges::equal(out.bytes(), payload), "decoding gives back what was encoded");
}

/// A packed clip, at each of its ends and between, and as integers that are written again.
void unpack(Bytes payload, std::uint32_t joints) {
    Faults faults;
    const auto view = read_packed(payload, joints, 0, faults);
    if (!view) {
        fuzz::check(!faults.empty(), "what is refused has a fault");
        return;
    }
    check_packed_values(*view, 0, faults);
    for (const std::uint32_t frame : {0u, view->record.frames / 2, view->record.frames - 1}) {
        PackedGroupReader reader(*view, frame);
        PackedGroup group;
        while (reader.next(group)) {
            for (std::uint32_t track = 0; track < group.count; ++track)
                fuzz::check(group.joints[track] < joints, "a packed track's joint is there");
        }
    }
    (void)write_packed(packed_samples(*view));
    if (joints <= 64) (void)unpack_clip(*view, std::vector<RestRecord>(joints));
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4) return 0;
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    const std::vector<std::byte> payload(bytes + 4, bytes + size);
    const unsigned codec = data[0] % (kCodecs + 1);
    if (codec < kCodecs) {
        decode(codec, payload);
        encode(codec, payload, data[2], data[1]);
    } else {
        unpack(payload, data[1]);
    }
    return 0;
}
