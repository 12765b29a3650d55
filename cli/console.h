#pragma once

#include <string>
#include <vector>

namespace bendy::cli {

/// What the user typed behind the program's name, in UTF-8.
std::vector<std::string> command_line(int argc, const char* const* argv);

/// Makes standard input and output take bytes as they are, and a console show UTF-8.
void prepare_console();

/// Whether standard error is a terminal, one that understands escape sequences.
bool is_terminal();

/// Whether standard output is a terminal.
bool output_is_terminal();

}  // namespace bendy::cli
