#pragma once

#include "sized.h"

#include <bendy/runtime/model.h>

namespace bendy::capi {

/// Fills `out` with one of `submeshes`: the model's, or those at a level of detail.
inline bendy_status get_submesh(std::span<const Submesh> submeshes, std::uint32_t number, bendy_submesh* out,
                                bendy_error* error) {
    if (const bendy_status status = check_index(number, submeshes.size(), "submesh", error)) return status;
    if (const bendy_status status = check_out(out, "out", error)) return status;
    const Submesh& submesh = submeshes[number];
    put(*out, {0, submesh.mesh, submesh.material, static_cast<std::uint32_t>(submesh.topology), submesh.first,
               submesh.count});
    return BENDY_OK;
}

}  // namespace bendy::capi
