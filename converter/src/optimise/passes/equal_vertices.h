#pragma once

#include <bendy/format/byte_reader.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// The rows of a per-vertex stream, `width` bytes for each vertex.
struct VertexRows {
    Bytes bytes;
    std::size_t width = 1;
};

/// Adds a vector with `entries` numbers or vectors per vertex; an empty one is left out.
template <class Vector>
void add_rows(std::vector<VertexRows>& streams, const Vector& values, std::size_t entries) {
    if (values.empty() || entries == 0) return;
    streams.push_back({std::as_bytes(std::span(values)), entries * sizeof(values[0])});
}

/// For each vertex, the first one whose rows are the same bytes in every stream: itself if no earlier one is equal. The
/// time is that of sorting the vertices, whatever their bytes.
std::vector<std::uint32_t> first_equal_vertices(std::size_t vertices, std::span<const VertexRows> streams);

}  // namespace bendy::converter
