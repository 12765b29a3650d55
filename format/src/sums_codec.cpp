#include "sums_codec.h"

#include "coded_rows.h"
#include "planes.h"
#include "zstd_frame.h"

#include <cstring>

namespace bendy {
namespace {

/// Adds a row's other u16 to its first, or subtracts them, modulo 65536.
void change_first(std::span<std::byte> row, bool add) {
    std::uint16_t first = 0;
    copy_at(row, 0, first);
    for (std::size_t at = sizeof first; at < row.size(); at += sizeof first) {
        std::uint16_t other = 0;
        copy_at(row, at, other);
        first = static_cast<std::uint16_t>(add ? first + other : first - other);
    }
    std::memcpy(row.data(), &first, sizeof first);
}

}  // namespace

bool decode_sums(const CodecHeader& header, Bytes body, std::span<std::byte> out) {
    if (!take_head(header, body, out) || header.stride % 2 != 0) return false;
    const auto rows = count_of(out.size(), header.stride);
    if (!rows) return false;
    AlignedBytes planes(out.size());
    if (!take_zstd(body, planes.span())) return false;
    from_planes(planes.bytes(), header.stride, out);
    for (std::size_t row = 0; row < *rows; ++row) change_first(out.subspan(row * header.stride, header.stride), false);
    return true;
}

bool encode_sums(const CodecHeader& header, Bytes payload, std::vector<std::byte>& out) {
    if (header.head > payload.size() || header.stride % 2 != 0) return false;
    out.insert(out.end(), payload.begin(), payload.begin() + header.head);
    std::vector<std::byte> numbers(payload.begin() + header.head, payload.end());
    const auto rows = count_of(numbers.size(), header.stride);
    if (!rows) return false;
    for (std::size_t row = 0; row < *rows; ++row)
        change_first(std::span(numbers).subspan(row * header.stride, header.stride), true);
    std::vector<std::byte> planes(numbers.size());
    to_planes(numbers, header.stride, planes);
    return put_zstd(planes, out);
}

}  // namespace bendy
