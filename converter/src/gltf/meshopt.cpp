#include "meshopt.h"

#include "failure.h"
#include "meshopt_filters.h"
#include "meshopt_vertices.h"

#include <meshoptimizer.h>

#include <cstdint>

namespace bendy::converter::gltf {
namespace {

// What the codecs can make of one byte at most: the vertex codec spends as little as 2 bits on each run of 256 equal
// bytes (4 bytes in version 0), the index codecs one byte on a triangle (12) or an index (4).
constexpr std::uint64_t kMaxRatio = 1024;

void decode_attributes(const CompressedView& view, std::span<const std::byte> source, std::vector<std::byte>& out) {
    if (view.stride % 4 != 0) fail(view.place + ".byteStride", "mode ATTRIBUTES demands a multiple of 4");
    const bool is_four_or_eight = view.stride == 4 || view.stride == 8;
    if (!decode_meshopt_vertices(source, view.stride, out)) {
        fail(view.place, "the compressed attribute data is malformed");
    }
    if (view.filter == "OCTAHEDRAL") {
        if (!is_four_or_eight) fail(view.place, "filter OCTAHEDRAL demands a byteStride of 4 or 8");
        decode_octahedral(out, view.stride);
    } else if (view.filter == "QUATERNION") {
        if (view.stride != 8) fail(view.place, "filter QUATERNION demands a byteStride of 8");
        decode_quaternion(out);
    } else if (view.filter == "EXPONENTIAL") {
        decode_exponential(out);
    } else if (view.filter == "COLOR") {
        if (!is_four_or_eight) fail(view.place, "filter COLOR demands a byteStride of 4 or 8");
        decode_colour(out, view.stride);
    }
}

void decode_indices(const CompressedView& view, std::span<const std::byte> source, std::vector<std::byte>& out) {
    if (view.stride != 2 && view.stride != 4) fail(view.place + ".byteStride", "indices have 2 or 4 bytes");
    if (view.filter != "NONE") fail(view.place + ".filter", "filters are for mode ATTRIBUTES");
    const auto* bytes = reinterpret_cast<const unsigned char*>(source.data());
    int status = 0;
    if (view.mode == "TRIANGLES") {
        if (view.count % 3 != 0) fail(view.place + ".count", "mode TRIANGLES demands a multiple of 3");
        status = meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, bytes, source.size());
    } else {
        status = meshopt_decodeIndexSequence(out.data(), view.count, view.stride, bytes, source.size());
    }
    if (status != 0) fail(view.place, "the compressed index data is malformed");
}

}  // namespace

std::vector<std::byte> decode_meshopt(const CompressedView& view, std::span<const std::byte> source, Budget& budget) {
    const std::uint64_t size = std::uint64_t{view.count} * view.stride;
    if (size / kMaxRatio > source.size()) {
        fail(view.place, std::to_string(source.size()) + " compressed bytes cannot hold " + std::to_string(size));
    }
    budget.take(size, 1, view.place);
    std::vector<std::byte> out(static_cast<std::size_t>(size));
    if (view.mode == "ATTRIBUTES") {
        decode_attributes(view, source, out);
    } else {
        decode_indices(view, source, out);
    }
    return out;
}

}  // namespace bendy::converter::gltf
