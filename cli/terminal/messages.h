#pragma once

#include "terminal/console.h"

#include <bendy/converter/report.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/error.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>

// What the program says: numbers and texts from a file made fit for a line of a terminal, errors and warnings.
namespace bendy::cli {

/// An input's name for a terminal; a dash is standard input.
std::string shown_name(const std::filesystem::path& input);
/// Text with everything escaped that a terminal does not show as a letter of its own, so that a name cannot move the
/// cursor, forge a line or turn the direction of writing: control characters (also U+0080 to U+009F), line and
/// paragraph separators, bidirectional and other invisible format characters, and bytes that are not UTF-8.
std::string escaped(std::string_view text);
/// The same for one letter: writes it to `to`, which has room for kMostEscaped bytes, and moves `at`, which is before
/// `end`, behind it. \return how many bytes were written. May be called from signal handlers.
std::size_t escape_letter(const char*& at, const char* end, char* to);
inline constexpr std::size_t kMostEscaped = 10;
/// Escaped text for one line of a message: the middle of a very long one is left out.
std::string printable(std::string_view text);
/// 1234567 as "1,234,567".
std::string grouped(std::uint64_t number);
/// "1 mesh", "1,200 meshes". \param many  `one` with an s if not given
std::string counted(std::uint64_t count, std::string_view one, std::string_view many = {});

/// How many columns UTF-8 text takes on a terminal: two for a letter of East Asian scripts, none for a combining mark.
std::size_t width_of(std::string_view text);

/// The text so that it fits into so many columns, with "..." where something was cut off; 0: all of it.
std::string cut_to(std::string_view text, std::size_t columns);

/// A number with up to four significant digits; what is next to nothing is 0, as in a rest pose's rounding errors.
std::string brief(float number);

/// Numbers with spaces between them.
template <std::size_t N>
std::string brief(const std::array<float, N>& numbers) {
    std::string text;
    for (const float number : numbers) {
        if (!text.empty()) text += ' ';
        text += brief(number);
    }
    return text;
}

/// The text up to 72 bytes, escaped; "..." where it was cut.
std::string brief(std::string_view text);

/// Adds a part to a line, after ", " if it is not the first.
void add_part(std::string& line, std::string_view part);

/// Colours are shown only on a terminal, and not where NO_COLOR is set (no-color.org) or TERM is "dumb".
enum class Colour { bold, red, yellow };

/// The text in that colour, bold, where the stream shows it; else as it is.
std::string in_colour(Colour colour, std::string_view text, Stream stream);

/// "bendy: error: " and "bendy: warning: ", for standard error.
std::string error_label();
std::string warning_label();

/// Thrown when the input is bad or the work failed, after the reason has been printed.
struct Failed {
    int status = 1;                   ///< what the program exits with
    std::filesystem::path file = {};  ///< that the reason is about, and the reason; for reports
    std::string what = {};
};

/// Prints `bendy: error: FILE: what is wrong` to standard error, made printable, and throws Failed.
[[noreturn]] void fail(const std::filesystem::path& file, std::string_view what);
/// The same for a fault in a file's bytes, with chunk path and offset.
[[noreturn]] void fail(const std::filesystem::path& file, const Error& error, Bytes bytes);
/// Prints `bendy: warning: FILE: what` to standard error, made printable.
void warn(const std::filesystem::path& file, std::string_view what);

/// Prints what a conversion has left out or changed, and what it suggests, a line each, to standard error.
void print_warnings(const std::filesystem::path& file, const converter::Report& report);
/// Prints what it has guessed, likewise.
void print_proposals(const converter::Report& report);

/// A line for each fault: the file, the code, what is wrong and where.
void print_fault_lines(std::ostream& out, const std::filesystem::path& file, const Faults& faults, Bytes bytes);

/// Warns of a file that is shown or written in spite of its faults.
void warn_of_faults(const std::filesystem::path& file, const Faults& faults, Bytes bytes);

/// The file that an error of the converter is about.
std::filesystem::path file_of(const converter::ImportError& error, const std::filesystem::path& input);
/// What is wrong with it, in one line.
std::string describe(const converter::ImportError& error);

}  // namespace bendy::cli
