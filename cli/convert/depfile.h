#pragma once

#include <bendy/format/result.h>

#include <string>
#include <vector>

namespace bendy::cli {

/// A name with letters that Make or Ninja takes for something else, such as ';', which begins a command.
struct UnwritableName {
    std::string name;
};

/// A rule that Make and Ninja read alike: `target` depends on `sources`; it has no commands. Names are not checked for
/// being UTF-8. The error is the first name that cannot be written.
Result<std::string, UnwritableName> depfile_text(const std::string& target, const std::vector<std::string>& sources);

}  // namespace bendy::cli
