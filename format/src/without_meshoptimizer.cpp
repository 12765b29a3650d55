// Replaces the functions that call meshoptimizer, for a library without it: check_encoded rejects everything that would
// be decoded here.
#include "mesh_codecs.h"

namespace bendy {

bool decode_rows(const CodecHeader& /*header*/, bool /*is_zstd*/, Bytes /*body*/, std::span<std::byte> /*out*/) {
    return false;
}
bool encode_rows(const CodecHeader& /*header*/, bool /*is_zstd*/, Bytes /*payload*/, std::vector<std::byte>& /*out*/) {
    return false;
}
bool decode_triangles(const CodecHeader& /*header*/, bool /*is_zstd*/, Bytes /*body*/, std::span<std::byte> /*out*/) {
    return false;
}
bool encode_triangles(const CodecHeader& /*header*/, bool /*is_zstd*/, Bytes /*payload*/,
                      std::vector<std::byte>& /*out*/) {
    return false;
}

}  // namespace bendy
