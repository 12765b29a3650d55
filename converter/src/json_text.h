#pragma once

#include "members_in_order.h"

#include <bendy/converter/report.h>

#include <nlohmann/json.hpp>

#include <string_view>

namespace bendy::converter {

using Json = nlohmann::json;
using OrderedJson = nlohmann::basic_json<MembersInOrder>;

/// Parses JSON text, Value being Json or OrderedJson. A byte order mark is skipped; half a surrogate pair is replaced
/// by U+FFFD, with a warning. Fails, with an empty place, with line and column on what is no JSON or no UTF-8, on
/// numbers past a double's range, and on nesting deeper than 128 levels.
template <class Value>
Value parse_json_text(std::string_view text, Report& report);

}  // namespace bendy::converter
