#pragma once

#include <bendy.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/error.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

// Fills in the caller's bendy_error, and checks arguments. Each `fail` returns the status, for the caller to return.
namespace bendy::capi {

bendy_status fail(bendy_error* error, bendy_status status, std::string_view message);
bendy_status out_of_memory(bendy_error* error);
/// Reports a fault in a file's bytes, with its code, chunk path and offset.
bendy_status fail(bendy_error* error, const Error& fault, Bytes file);
/// Returns BENDY_OK, or the error of a call whose arguments have passed their checks.
bendy_status from_call(const Result<void, CallError>& result, bendy_error* error);

/// Returns BENDY_OK, or the error "NAME is NULL".
bendy_status check_pointer(const void* pointer, const char* name, bendy_error* error);
template <class Result, class... Taken>
bendy_status check_pointer(Result (*function)(Taken...), const char* name, bendy_error* error) {
    return check_pointer(function == nullptr ? nullptr : name, name, error);
}
/// Returns BENDY_OK, or an error; `kind` names the indexed things, such as "joint", and `owner` what has them.
bendy_status check_index(std::uint32_t index, std::size_t count, const char* kind, bendy_error* error,
                         const char* owner = "the model");
/// Checks that [first, first + count) is within `all`.
bendy_status check_range(std::uint32_t first, std::uint32_t count, std::size_t all, const char* kind,
                         bendy_error* error);
/// Checks that the caller's array, with room for `room` elements, is large enough.
bendy_status check_room(std::uint64_t room, std::uint64_t needed, const char* name, bendy_error* error);
bendy_status check_finite(std::span<const float> numbers, const char* name, bendy_error* error);
bendy_status check_finite(std::span<const double> numbers, const char* name, bendy_error* error);
template <class Number>
requires std::is_arithmetic_v<Number> bendy_status check_finite(const Number& number, const char* name,
                                                                bendy_error* error) {
    return check_finite(std::span(&number, 1), name, error);
}
/// Checks that a number, which may be infinite, is not NaN.
bendy_status check_number(double number, const char* name, bendy_error* error);
bendy_status check_fraction(double number, const char* name, bendy_error* error);
/// Checks that a rotation consists of four finite numbers, with length 1 within 0.01.
bendy_status check_rotation(const float* rotation, bendy_error* error);
bendy_status check_rotation(const double* rotation, bendy_error* error);
/// Checks a value of the enumeration `kind`, which has `count` values from 0 on.
bendy_status check_value(std::uint32_t value, std::uint32_t count, const char* name, const char* kind,
                         bendy_error* error);

/// Returns the result of call(). Converts running out of memory into an error, so that no exception reaches C.
template <class Call>
bendy_status guarded(bendy_error* error, const Call& call) {
#ifdef __cpp_exceptions
    try {
        return call();
    } catch (...) {
        // The library throws nothing itself (docs/decisions/0020), so that memory has run out. Its type would not be
        // recognised where the program and this library have a C++ library each.
        return out_of_memory(error);
    }
#else
    (void)error;
    return call();
#endif
}

// Structs that begin with their size, which may differ between the program and this library.

/// The size that S had when it was added to bendy.h: every program's struct has these fields. Fields added later do not
/// change it, see fields.h; padding at the end of the original form is not counted.
template <class S>
inline constexpr std::size_t kFirstSize = sizeof(S);

/// Larger than any struct will ever be: a size this large was never set.
inline constexpr std::size_t kMostSize = 4096;

/// Returns true if the caller has set the size of a struct that is to be filled.
template <class S>
bendy_status check_out(const S* out, const char* name, bendy_error* error) {
    if (const bendy_status status = check_pointer(out, name, error)) return status;
    if (out->size >= kFirstSize<S> && out->size <= kMostSize) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT,
                std::string(name) + ": its size is " + std::to_string(out->size) + ", set it to its sizeof");
}

/// Fills the fields that both the program and this library know, and zeroes those that only the program knows.
template <class S>
void put(S& out, S value) {
    value.size = out.size;
    const std::size_t known = std::min<std::size_t>(out.size, sizeof(S));
    std::memcpy(&out, &value, known);
    std::memset(reinterpret_cast<char*>(&out) + known, 0, out.size - known);  // NOLINT(*-reinterpret-cast)
}

/// Copies a struct of the caller over `value`, which holds the defaults of fields that the program does not know.
/// Fields that this library does not know must be zero.
template <class S>
bendy_status take(const S* in, const char* name, S& value, bendy_error* error) {
    if (in == nullptr) return BENDY_OK;
    if (const bendy_status status = check_out(in, name, error)) return status;
    const std::size_t known = std::min<std::size_t>(in->size, sizeof(S));
    const auto* const bytes = reinterpret_cast<const char*>(in);  // NOLINT(*-reinterpret-cast)
    if (std::any_of(bytes + known, bytes + in->size, [](char byte) { return byte != 0; })) {
        return fail(error, BENDY_BAD_ARGUMENT,
                    std::string(name) + " asks for something that this version of the library does not know");
    }
    std::memcpy(&value, in, known);
    return BENDY_OK;
}

// Arrays of structs, each of which has the size that the first one states.

/// Struct `number` of the caller's array.
template <class S>
S* at(S* first, std::size_t number) {
    using Byte = std::conditional_t<std::is_const_v<S>, const char, char>;
    auto* const bytes = reinterpret_cast<Byte*>(first);         // NOLINT(*-reinterpret-cast)
    return reinterpret_cast<S*>(bytes + number * first->size);  // NOLINT(*-reinterpret-cast)
}

/// Checks that the first of `count` structs has a size that is valid in an array, and that all others have the same.
/// This comes before any is accessed: one that claims to be larger would reach past the end of the array.
template <class S>
bendy_status check_array(const S* first, std::size_t count, const char* name, bendy_error* error) {
    if (count == 0) return BENDY_OK;
    if (const bendy_status status = check_out(first, name, error)) return status;
    if (first->size % alignof(S) != 0)
        return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + ": their size is not that of a struct in an array");
    for (std::size_t k = 1; k < count; ++k) {
        if (at(first, k)->size != first->size)
            return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + " have different sizes");
    }
    return BENDY_OK;
}

}  // namespace bendy::capi
