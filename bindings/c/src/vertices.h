#pragma once

#include <bendy.h>
#include <bendy/runtime/vertices.h>

#include <cstdint>

namespace bendy::capi {

/// Checks the caller's memory for `needed` vertices, and wraps it.
bendy_status take_buffer(const bendy_vertices& values, std::uint64_t needed, VertexBuffer& out, bendy_error* error);

}  // namespace bendy::capi
