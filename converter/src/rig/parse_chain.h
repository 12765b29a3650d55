#pragma once

#include "angle.h"
#include "json_text.h"
#include "rig.h"

#include <string>

namespace bendy::converter {

/// One chain of a rig file or of extras. Fails at the JSON path of what is wrong.
RigChain parse_chain(const OrderedJson& value, const std::string& place, AngleUnit unit);

}  // namespace bendy::converter
