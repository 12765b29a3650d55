#pragma once

#include <bendy/converter/convert.h>

#include <filesystem>

namespace bendy::cli {

/// converter::convert of a file, or of standard input if its name is a dash: what that refers to is relative to the
/// working directory. A rig file may be a dash too. Prints what cannot be read of standard input and throws Failed.
Result<std::vector<std::byte>, converter::ImportError> convert_input(const std::filesystem::path& input,
                                                                     converter::ConvertOptions options,
                                                                     converter::Report& report);

}  // namespace bendy::cli
