#pragma once

#include "sized.h"

#include <bendy/runtime/model.h>

namespace bendy::capi {

/// Fills `out` with one of `draws`: the model's, or those at a level of detail.
inline bendy_status get_draw(std::span<const Draw> draws, std::uint32_t number, bendy_draw* out, bendy_error* error) {
    if (const bendy_status status = check_index(number, draws.size(), "draw", error)) return status;
    if (const bendy_status status = check_out(out, "out", error)) return status;
    const Draw& draw = draws[number];
    put(*out, {0, draw.pool, draw.material, static_cast<std::uint32_t>(draw.topology), draw.first, draw.count});
    return BENDY_OK;
}

}  // namespace bendy::capi
