#pragma once

#include <bendy.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/error.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

// Fills in the caller's bendy_error, and checks arguments. Each `fail` returns the status, for the caller to return.
namespace bendy::capi {

bendy_status fail(bendy_error* error, bendy_status status, std::string_view message);
/// Reports a fault in a file's bytes, with its code, chunk path and offset.
bendy_status fail(bendy_error* error, const Error& fault, Bytes file);
/// Returns BENDY_OK, or the error of a call whose arguments have been checked already.
bendy_status from_call(const Result<void, CallError>& result, bendy_error* error);

/// Returns BENDY_OK, or the error "NAME is NULL".
bendy_status check_pointer(const void* pointer, const char* name, bendy_error* error);
/// Returns BENDY_OK, or an error; `kind` is the kind of thing that is indexed: "joint".
bendy_status check_index(std::uint32_t index, std::size_t count, const char* kind, bendy_error* error);
/// Checks that [first, first + count) is within `all`.
bendy_status check_range(std::uint32_t first, std::uint32_t count, std::size_t all, const char* kind,
                         bendy_error* error);
/// Checks that the caller's array, with room for `room` elements, is large enough.
bendy_status check_room(std::uint64_t room, std::uint64_t needed, const char* name, bendy_error* error);
bendy_status check_finite(std::span<const float> numbers, const char* name, bendy_error* error);
/// Checks that a rotation consists of four finite numbers, with length 1 within 0.01.
bendy_status check_rotation(const float* rotation, bendy_error* error);

/// Returns the result of call(). Converts running out of memory into an error, so that no exception reaches C.
template <class Call>
bendy_status guarded(bendy_error* error, const Call& call) {
#ifdef __cpp_exceptions
    try {
        return call();
    } catch (...) {  // the library itself throws nothing: see docs/decisions/0020
        return fail(error, BENDY_OUT_OF_MEMORY, "there is not enough memory");
    }
#else
    (void)error;
    return call();
#endif
}

}  // namespace bendy::capi
