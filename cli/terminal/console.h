#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bendy::cli {

/// What the user typed behind the program's name, in UTF-8.
std::vector<std::string> command_line(int argc, const char* const* argv);

/// Makes standard input and output take bytes as they are, and a console show UTF-8.
void prepare_console();

enum class Stream { output, error };

/// Whether the stream is a terminal, one that understands escape sequences.
bool is_terminal(Stream stream = Stream::error);

/// How many letters fit into a line of the stream's terminal; 0 where it is none, or does not say.
std::size_t columns_of(Stream stream);

}  // namespace bendy::cli
