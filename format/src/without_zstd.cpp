// Replaces the functions that call zstd, for a library without it: check_encoded rejects everything that would be
// decoded here.
#include "clip_codec.h"
#include "zstd_frame.h"

namespace bendy {

bool take_zstd(Bytes /*bytes*/, std::span<std::byte> /*out*/) {
    return false;
}
std::optional<std::uint64_t> zstd_size(Bytes /*bytes*/) {
    return std::nullopt;
}
bool put_zstd(Bytes /*bytes*/, std::vector<std::byte>& /*out*/) {
    return false;
}
bool decode_clip(Bytes /*body*/, std::span<std::byte> /*out*/) {
    return false;
}
bool encode_clip(Bytes /*payload*/, std::vector<std::byte>& /*out*/) {
    return false;
}

}  // namespace bendy
