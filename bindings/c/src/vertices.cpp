// The caller's memory for vertices.
#include "vertices.h"

#include "fail.h"

#include <cstdint>
#include <limits>
#include <string>

namespace bendy::capi {
namespace {

/// Checks one attribute of `numbers` floats per vertex.
bendy_status take_array(float* data, std::size_t stride, std::size_t numbers, std::uint64_t vertices, const char* name,
                        StridedFloats& out, bendy_error* error) {
    if (data == nullptr || vertices == 0) return BENDY_OK;
    if (stride == 0) stride = numbers * sizeof(float);
    if (stride % sizeof(float) != 0 || stride < numbers * sizeof(float)) {
        return fail(error, BENDY_BAD_ARGUMENT,
                    std::string(name) + ": a stride of " + std::to_string(stride) +
                        " bytes is not a multiple of 4 that holds " + std::to_string(numbers) + " floats");
    }
    if (reinterpret_cast<std::uintptr_t>(data) % alignof(float) != 0)  // NOLINT(*-reinterpret-cast)
        return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + " does not start on a 4-byte boundary");
    out.stride = stride / sizeof(float);
    constexpr std::size_t kMost = std::numeric_limits<std::ptrdiff_t>::max() / sizeof(float);
    if (out.stride > kMost || vertices - 1 > (kMost - numbers) / out.stride)
        return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + ": no memory is that large");
    out.floats = {data, static_cast<std::size_t>((vertices - 1) * out.stride + numbers)};
    return BENDY_OK;
}

}  // namespace

bendy_status take_buffer(const bendy_vertices& values, std::uint64_t needed, VertexBuffer& out, bendy_error* error) {
    if (const bendy_status status = check_room(values.capacity, needed, "out", error)) return status;
    if (const bendy_status status =
            take_array(values.positions, values.position_stride, 3, needed, "positions", out.positions, error))
        return status;
    if (const bendy_status status =
            take_array(values.normals, values.normal_stride, 3, needed, "normals", out.normals, error))
        return status;
    return take_array(values.tangents, values.tangent_stride, 4, needed, "tangents", out.tangents, error);
}

}  // namespace bendy::capi
