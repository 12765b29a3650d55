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

// Filling a caller's bendy_error, and what is checked of arguments. Each `fail` gives the status, to be returned.
namespace bendy::capi {

bendy_status fail(bendy_error* error, bendy_status status, std::string_view message);
/// A fault in a file's bytes, with its code, chunk path and offset.
bendy_status fail(bendy_error* error, const Error& fault, Bytes file);
/// BENDY_OK, or the error: of a call whose arguments have been checked already.
bendy_status from_call(const Result<void, CallError>& result, bendy_error* error);

/// BENDY_OK, or the error "NAME is NULL".
bendy_status check_pointer(const void* pointer, const char* name, bendy_error* error);
/// BENDY_OK, or an error; `kind` is what is numbered: "joint".
bendy_status check_index(std::uint32_t index, std::size_t count, const char* kind, bendy_error* error);
/// [first, first + count) among `all`.
bendy_status check_range(std::uint32_t first, std::uint32_t count, std::size_t all, const char* kind,
                         bendy_error* error);
/// Whether the caller's array, with room for so many, holds what is needed.
bendy_status check_room(std::uint64_t room, std::uint64_t needed, const char* name, bendy_error* error);
bendy_status check_finite(std::span<const float> numbers, const char* name, bendy_error* error);
/// Four finite numbers, of length 1 within 0.01.
bendy_status check_rotation(const float* rotation, bendy_error* error);

/// Calls call() and gives what it returns; memory that runs out is an error, too: no exception reaches C.
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
