#pragma once

// What the C++ library of Debian's emscripten lacks: std::bit_cast, and std::to_chars and std::from_chars of floats and
// doubles. The results are those of libstdc++, to the character. CMake includes this header before every source of the
// tools.
#include <bit>
#include <charconv>
#include <cstring>

namespace std {

template <class To, class From>
[[nodiscard]] To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From) && is_trivially_copyable_v<To> && is_trivially_copyable_v<From>);
    To to;
    memcpy(&to, &from, sizeof(To));
    return to;
}

/// The fewest digits that are read as the same number; in the shorter notation, or the fixed one if they are equally
/// long.
to_chars_result to_chars(char* first, char* last, float value);
to_chars_result to_chars(char* first, char* last, double value);
/// The same in the given notation: only chars_format::fixed is implemented.
to_chars_result to_chars(char* first, char* last, float value, chars_format format);
to_chars_result to_chars(char* first, char* last, double value, chars_format format);
/// As printf's %e and %g: chars_format::scientific and general are implemented.
to_chars_result to_chars(char* first, char* last, float value, chars_format format, int precision);
to_chars_result to_chars(char* first, char* last, double value, chars_format format, int precision);

from_chars_result from_chars(const char* first, const char* last, float& value);
from_chars_result from_chars(const char* first, const char* last, double& value);

}  // namespace std
