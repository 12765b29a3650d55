#pragma once

#include "angle.h"
#include "json_text.h"

#include <bendy/format/records.h>

#include <string>
#include <vector>

namespace bendy::converter {

/// One constraint of a rig file or of extras. The rest pose may lie outside; all else passes check_limit. Fails at the
/// JSON path of what is wrong.
LimitRecord parse_limit(const OrderedJson& value, const std::string& place, AngleUnit unit);

/// A joint's constraints: one, or a list, at most one of each scope.
std::vector<LimitRecord> parse_limits(const OrderedJson& value, const std::string& place, AngleUnit unit);

/// Fails at `place` where check_limit finds a fault other than a rest pose outside.
void check_limit_at(const LimitRecord& limit, const std::string& place);

}  // namespace bendy::converter
