#pragma once

#include <bendy/converter/report.h>

#include <filesystem>

namespace bendy::cli {

/// Prints what a conversion has left out or changed, and what it suggests, a line each, to standard error.
void print_warnings(const std::filesystem::path& file, const converter::Report& report);
/// Prints what it has guessed, likewise.
void print_proposals(const converter::Report& report);

}  // namespace bendy::cli
