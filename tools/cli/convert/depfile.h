#pragma once

#include <bendy/format/result.h>

#include <string>
#include <vector>

namespace bendy::tools {

/// A name with characters that Make or Ninja would misinterpret, such as ';', which begins a command.
struct UnwritableName {
    std::string name;
};

/// Returns a rule that Make and Ninja read alike: `target` depends on `sources`, without commands. Names need not be
/// UTF-8. The error is the first name that cannot be written.
Result<std::string, UnwritableName> depfile_text(const std::string& target, const std::vector<std::string>& sources);

}  // namespace bendy::tools
