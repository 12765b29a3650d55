#pragma once

#include "terminal/console.h"

#include <string>
#include <string_view>

// Colour on a terminal: nowhere else, and nowhere where NO_COLOR is set (no-color.org) or TERM is "dumb".
namespace bendy::cli {

enum class Colour { bold, red, yellow };

/// The text in that colour, bold, where the stream shows it; else as it is.
std::string in_colour(Colour colour, std::string_view text, Stream stream);

/// "bendy: error: " and "bendy: warning: ", for standard error.
std::string error_label();
std::string warning_label();

}  // namespace bendy::cli
