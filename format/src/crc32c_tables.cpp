#include "crc32c_kernels.h"

#include <array>

namespace bendy {
namespace {

using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

// tables[0] is the bytewise table; tables[k] advances a byte over k more zero bytes, so that eight bytes are summed at
// a time ("slicing-by-8", Kounavis and Berry, 2005).
constexpr Tables make_tables() {
    constexpr std::uint32_t kReflectedPolynomial = 0x82f63b78u;
    Tables tables{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t sum = byte;
        for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1u) != 0 ? kReflectedPolynomial : 0u);
        tables[0][byte] = sum;
    }
    for (std::size_t k = 1; k < tables.size(); ++k) {
        for (std::size_t byte = 0; byte < 256; ++byte) {
            const std::uint32_t last = tables[k - 1][byte];
            tables[k][byte] = (last >> 8) ^ tables[0][last & 0xffu];
        }
    }
    return tables;
}

constexpr Tables kTables = make_tables();

}  // namespace

std::uint32_t crc32c_tables(Bytes bytes, std::uint32_t before) {
    std::uint32_t sum = ~before;
    std::size_t at = 0;
    for (; bytes.size() - at >= 8; at += 8) {
        std::uint64_t word = 0;
        copy_at(bytes, at, word);
        word ^= sum;
        sum = 0;
        for (std::size_t k = 0; k < 8; ++k) sum ^= kTables[7 - k][word >> (8 * k) & 0xffu];
    }
    for (; at < bytes.size(); ++at)
        sum = (sum >> 8) ^ kTables[0][(sum ^ std::to_integer<std::uint32_t>(bytes[at])) & 0xffu];
    return ~sum;
}

}  // namespace bendy
