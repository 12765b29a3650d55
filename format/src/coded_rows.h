#pragma once

#include <bendy/format/codec.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>

// What the codecs of rows share.
namespace bendy {

/// The payload's head goes as it is; false if it is not there.
inline bool take_head(const CodecHeader& header, Bytes& body, std::span<std::byte>& out) {
    if (header.head > out.size() || header.head > body.size()) return false;
    std::copy_n(body.begin(), header.head, out.begin());
    body = body.subspan(header.head);
    out = out.subspan(header.head);
    return true;
}

/// A number of rows or triangles: none if the bytes are no whole number of them.
inline std::optional<std::size_t> count_of(std::size_t size, std::size_t step) {
    if (step == 0 || size % step != 0) return std::nullopt;
    return size / step;
}

}  // namespace bendy
