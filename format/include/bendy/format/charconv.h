#pragma once

#include <bendy/format/public.h>

#include <bit>
#include <charconv>
#include <cstring>

// std::to_chars, std::from_chars and std::bit_cast, also for the C++ library of Debian's emscripten, which lacks
// std::bit_cast and the conversions of floats and doubles. bindings/web/tools/charconv.cpp has those: the results are
// those of libstdc++, to the character.
namespace BENDY_PUBLIC bendy {

using std::from_chars;
using std::to_chars;

#ifdef __EMSCRIPTEN__

template <class To, class From>
[[nodiscard]] To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From));
    To to;
    std::memcpy(&to, &from, sizeof(To));
    return to;
}

/// Writes the fewest digits that read back to the same number, in the shorter notation; fixed if both are equally long.
std::to_chars_result to_chars(char* first, char* last, float value);
std::to_chars_result to_chars(char* first, char* last, double value);
/// The same in the given notation: only std::chars_format::fixed is implemented.
std::to_chars_result to_chars(char* first, char* last, float value, std::chars_format format);
std::to_chars_result to_chars(char* first, char* last, double value, std::chars_format format);
/// As printf's %e and %g: std::chars_format::scientific and general are implemented.
std::to_chars_result to_chars(char* first, char* last, float value, std::chars_format format, int precision);
std::to_chars_result to_chars(char* first, char* last, double value, std::chars_format format, int precision);

std::from_chars_result from_chars(const char* first, const char* last, float& value);
std::from_chars_result from_chars(const char* first, const char* last, double& value);

#else

using std::bit_cast;

#endif

}  // namespace bendy
