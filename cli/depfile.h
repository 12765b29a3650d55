#pragma once

#include <bendy/converter/report.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bendy::cli {

/// A rule for Make and Ninja: `output` depends on the sources that are there; no commands. A name with a line break
/// cannot be written: the result is empty.
std::string depfile_text(const std::filesystem::path& output, const std::vector<converter::SourceFile>& sources);

}  // namespace bendy::cli
