#include "terminal/colour.h"

#include <cstdlib>

namespace bendy::cli {
namespace {

bool shows_colour(Stream stream) {
    static const char* const refused = std::getenv("NO_COLOR");  // NOLINT(concurrency-mt-unsafe): nothing changes it
    static const bool on_output = is_terminal(Stream::output);
    static const bool on_error = is_terminal(Stream::error);
    if (refused != nullptr && *refused != '\0') return false;
    return stream == Stream::output ? on_output : on_error;
}

}  // namespace

std::string in_colour(Colour colour, std::string_view text, Stream stream) {
    if (!shows_colour(stream)) return std::string(text);
    std::string_view start = "\x1b[1m";
    if (colour == Colour::red) start = "\x1b[1;31m";
    if (colour == Colour::yellow) start = "\x1b[1;33m";
    return std::string(start) + std::string(text) + "\x1b[0m";
}

std::string error_label() {
    return "bendy: " + in_colour(Colour::red, "error:", Stream::error) + ' ';
}

std::string warning_label() {
    return "bendy: " + in_colour(Colour::yellow, "warning:", Stream::error) + ' ';
}

}  // namespace bendy::cli
