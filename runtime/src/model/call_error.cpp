#include <bendy/runtime/call_error.h>

namespace bendy {

const char* error_text(CallError error) {
    switch (error) {
        case CallError::missing:
            return "expected a clip or an IK chain, found none";
        case CallError::not_finite:
            return "expected finite numbers";
        case CallError::other_model:
            return "expected arguments that belong to one model";
        case CallError::out_of_range:
            return "expected the number of a mesh, joint, vertex or worker that exists";
        case CallError::wrong_size:
            return "expected one number for each joint or target";
        case CallError::output_too_short:
            return "expected an output with room for all vertices or matrices";
        case CallError::stride_too_small:
            return "expected a stride of at least the attribute's own numbers";
        case CallError::not_available:
            return "expected a kernel that this program has and this machine can run";
    }
    return "unknown error";
}

}  // namespace bendy
