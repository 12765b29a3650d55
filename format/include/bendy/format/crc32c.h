#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/public.h>

#include <cstdint>

namespace BENDY_PUBLIC bendy {

/// Computes the CRC-32C (Castagnoli polynomial 0x1EDC6F41, reflected, initial value and final exclusive-or 0xffffffff)
/// as in RFC 3720 appendix B.4. To continue with more bytes, pass the previous result: crc32c(b, crc32c(a)) is the sum
/// of a followed by b.
std::uint32_t crc32c(Bytes bytes, std::uint32_t before = 0);

}  // namespace bendy
