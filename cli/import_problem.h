#pragma once

#include <bendy/converter/report.h>

#include <filesystem>
#include <string>

namespace bendy::cli {

/// The file that an error of the converter is about.
std::filesystem::path file_of(const converter::ImportError& error, const std::filesystem::path& input);
/// What is wrong with it, in one line.
std::string describe(const converter::ImportError& error);

}  // namespace bendy::cli
