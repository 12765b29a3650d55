#pragma once

#include <bendy/converter/report.h>
#include <bendy/json/json.h>

#include <cstddef>
#include <span>
#include <string_view>

namespace bendy::converter {

using bendy::Json;
using bendy::OrderedJson;

/// Limit on nested arrays and objects of a source.
inline constexpr std::size_t kMostJsonLevels = 128;

/// Parses JSON text; Value is Json or OrderedJson. A byte order mark is skipped; an unpaired surrogate is replaced by
/// U+FFFD, with a warning. Fails, with an empty place, with line and column on text that is not JSON or not UTF-8, on
/// numbers outside the range of double, and on nesting deeper than `most_levels`.
template <class Value>
Value parse_json_text(std::string_view text, Report& report, std::size_t most_levels = kMostJsonLevels);

/// A float as the shortest decimal number that reads back as the same float.
Json json_number(float value);

/// A list of such numbers.
Json json_numbers(std::span<const float> values);

}  // namespace bendy::converter
