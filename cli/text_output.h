#pragma once

#include <filesystem>
#include <string_view>

namespace bendy::cli {

/// Writes a command's result to `output`, or to standard output if that is empty. Fails, naming it, if it cannot.
void write_text(const std::filesystem::path& output, std::string_view text);

}  // namespace bendy::cli
