#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bendy::tools {

/// Returns the arguments after the program's name, in UTF-8.
std::vector<std::string> command_line(int argc, const char* const* argv);

/// Makes standard input and output pass bytes unchanged, and a console show UTF-8.
void prepare_console();

enum class Stream { output, error };

/// Returns true if the stream is a terminal that understands escape sequences.
bool is_terminal(Stream stream = Stream::error);

/// Returns the number of columns of the stream's terminal; 0 if it is not a terminal or does not say.
std::size_t columns_of(Stream stream);

}  // namespace bendy::tools
