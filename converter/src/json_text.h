#pragma once

#include "members_in_order.h"

#include <bendy/converter/report.h>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <span>
#include <string_view>

namespace bendy::converter {

using Json = nlohmann::json;
using OrderedJson = nlohmann::basic_json<MembersInOrder>;

/// Of arrays and objects in each other: what copies or prints JSON recurses.
inline constexpr std::size_t kMostJsonLevels = 128;

/// Parses JSON text, Value being Json or OrderedJson. A byte order mark is skipped; half a surrogate pair is replaced
/// by U+FFFD, with a warning. Fails, with an empty place, with line and column on what is no JSON or no UTF-8, on
/// numbers past a double's range, and on nesting deeper than `most_levels`.
template <class Value>
Value parse_json_text(std::string_view text, Report& report, std::size_t most_levels = kMostJsonLevels);

/// A float as the shortest decimal number that reads back as the same float.
Json json_number(float value);

/// A list of such numbers.
Json json_numbers(std::span<const float> values);

}  // namespace bendy::converter
