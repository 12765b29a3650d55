#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bendy::cli {

/// How many columns UTF-8 text takes on a terminal: two for a letter of East Asian scripts, none for a combining mark.
std::size_t width_of(std::string_view text);

/// The text so that it fits into so many columns, with "..." where something was cut off; 0: all of it.
std::string cut_to(std::string_view text, std::size_t columns);

}  // namespace bendy::cli
