#pragma once

#include <bendy/runtime/model.h>

#include <optional>
#include <string>

namespace bendy::motion {

/// Says which character of a file has the roles if it has joints enough for another one beside it; otherwise nothing.
/// \param what  "the source" or "the target"
std::optional<std::string> tell_other_characters(const Model& model, const char* what);

}  // namespace bendy::motion
