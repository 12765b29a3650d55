#include "meshopt.h"

#include "failure.h"

#include <meshoptimizer.h>

#include <cstdint>

namespace bendy::converter::gltf {
namespace {

// What the codecs can make of one byte at most: version 0 of the vertex codec spends 4 bytes on a run of 256 equal bytes,
// the index codecs one byte on a triangle (12) or an index (4).
constexpr std::uint64_t kMaxRatio = 64;
constexpr std::uint64_t kSlack = 256 * 256;  // one block of the vertex codec may cost nearly nothing

void decode_attributes(const CompressedView& view, std::span<const std::byte> source, std::vector<std::byte>& out) {
    if (view.stride % 4 != 0) fail(view.place + ".byteStride", "mode ATTRIBUTES demands a multiple of 4");
    const auto* bytes = reinterpret_cast<const unsigned char*>(source.data());
    if ((bytes[0] & 0x0fu) != 0 && (bytes[0] & 0xf0u) == 0xa0u) {
        fail(view.place, "version " + std::to_string(bytes[0] & 0x0fu) + " of the vertex codec is not supported");
    }
    if (meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, bytes, source.size()) != 0) {
        fail(view.place, "the compressed attribute data is malformed");
    }
    if (view.filter == "OCTAHEDRAL") {
        if (view.stride != 4 && view.stride != 8) fail(view.place, "filter OCTAHEDRAL demands a byteStride of 4 or 8");
        meshopt_decodeFilterOct(out.data(), view.count, view.stride);
    } else if (view.filter == "QUATERNION") {
        if (view.stride != 8) fail(view.place, "filter QUATERNION demands a byteStride of 8");
        meshopt_decodeFilterQuat(out.data(), view.count, view.stride);
    } else if (view.filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(out.data(), view.count, view.stride);
    } else if (view.filter != "NONE") {
        fail(view.place + ".filter", "filter " + view.filter + " is not supported");
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
    if (size > kSlack && (size - kSlack) / kMaxRatio > source.size()) {
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
