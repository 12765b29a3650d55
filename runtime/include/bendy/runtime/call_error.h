#pragma once

#include <bendy/format/public.h>

#include <cstdint>

namespace BENDY_PUBLIC bendy {

/// Why a call of the runtime failed. Functions return it in a Result<..., CallError>, which allocates no memory.
enum class CallError : std::uint8_t {
    missing,       ///< a clip or chain is null, or a Crossfade plays nothing
    not_finite,    ///< a number is not finite
    other_model,   ///< arguments belong to different models, or a clip or chain is not one of the model's own: a copy
                   ///< of one is not either
    out_of_range,  ///< no mesh, joint, vertex or worker has that number
    wrong_size,    ///< a mask or a list of weights does not have one number for each joint or target
    output_too_short,  ///< a non-empty output has no room for everything that would be written
    stride_too_small,  ///< an output's stride is smaller than the data written per vertex
    not_available,     ///< not supported by this program or this machine
};

/// Returns what was expected, in one line: "expected a finite number".
const char* error_text(CallError error);

}  // namespace bendy
