#pragma once

#include "fail.h"

#include <algorithm>
#include <cstddef>

// Structs that begin with their size, which may differ between the program and this library.
namespace bendy::capi {

/// The fields of S that version 0.1 had: every program's struct has them. Fields that are added later do not change
/// this.
template <class S>
inline constexpr std::size_t kFirstSize = sizeof(S);

/// More than any struct will ever have: a size that nobody has set.
inline constexpr std::size_t kMostSize = 4096;

/// Whether the caller has set the size of a struct that is to be filled.
template <class S>
bendy_status check_out(const S* out, const char* name, bendy_error* error) {
    if (const bendy_status status = check_pointer(out, name, error)) return status;
    if (out->size >= kFirstSize<S> && out->size <= kMostSize) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT,
                std::string(name) + ": its size is " + std::to_string(out->size) + ", set it to its sizeof");
}

/// Fills as much as both know, and zeroes what only the program knows.
template <class S>
void put(S& out, S value) {
    value.size = out.size;
    const std::size_t known = std::min<std::size_t>(out.size, sizeof(S));
    std::memcpy(&out, &value, known);
    std::memset(reinterpret_cast<char*>(&out) + known, 0, out.size - known);  // NOLINT(*-reinterpret-cast)
}

/// Takes a struct of the caller's over `value`, which holds what fields have that the program does not know. A field
/// that this library does not know may not ask for anything.
template <class S>
bendy_status take(const S* in, const char* name, S& value, bendy_error* error) {
    if (in == nullptr) return BENDY_OK;
    if (const bendy_status status = check_out(in, name, error)) return status;
    const std::size_t known = std::min<std::size_t>(in->size, sizeof(S));
    const auto* const bytes = reinterpret_cast<const char*>(in);  // NOLINT(*-reinterpret-cast)
    if (std::any_of(bytes + known, bytes + in->size, [](char byte) { return byte != 0; }))
        return fail(error, BENDY_BAD_ARGUMENT,
                    std::string(name) + " asks for something that this version of the library does not know");
    std::memcpy(&value, in, known);
    return BENDY_OK;
}

}  // namespace bendy::capi
