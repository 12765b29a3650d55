#pragma once

#include <bendy/format/public.h>

#include <cstdint>

namespace BENDY_PUBLIC bendy {

/// Why a call of the runtime failed. Functions return it in a Result<..., CallError>: no memory is allocated, whether
/// they succeed or not.
enum class CallError : std::uint8_t {
    missing,           ///< a clip or chain is null, or a Crossfade plays nothing
    not_finite,        ///< a number is not finite
    other_model,       ///< two arguments belong to different models
    out_of_range,      ///< the model has no mesh of that number
    wrong_size,        ///< a mask or a list of weights does not have one number for each joint or target
    output_too_short,  ///< an output that is not empty has no room for all that would be written
    stride_too_small,  ///< an output's stride is smaller than what is written for each vertex
    not_available,     ///< this program or this machine does not have it
};

/// What was expected, in one line: "expected a finite number".
const char* error_text(CallError error);

}  // namespace bendy
