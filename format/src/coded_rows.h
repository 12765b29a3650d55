#pragma once

#include <bendy/format/codec.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>

// Helpers shared by the codecs of rows.
namespace bendy {

/// Copies the payload's head, which is stored unchanged; returns false if the data is too short.
inline bool take_head(const CodecHeader& header, Bytes& body, std::span<std::byte>& out) {
    if (header.head > out.size() || header.head > body.size()) return false;
    std::copy_n(body.begin(), header.head, out.begin());
    body = body.subspan(header.head);
    out = out.subspan(header.head);
    return true;
}

/// Returns the number of rows or triangles; nothing if the size is not a multiple of the step.
inline std::optional<std::size_t> count_of(std::size_t size, std::size_t step) {
    if (step == 0 || size % step != 0) return std::nullopt;
    return size / step;
}

}  // namespace bendy
