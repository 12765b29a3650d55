#pragma once

#include "reports/console.h"

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

// The program's output: numbers and texts from a file made safe for a line on a terminal, errors and warnings.
namespace bendy::tools {

/// An input's name for a terminal; a dash becomes standard input.
std::string shown_name(const std::filesystem::path& input);
/// Escapes everything that a terminal does not show as a character of its own, so that a name cannot move the cursor,
/// forge a line or change the direction of writing: control characters (including U+0080 to U+009F), line and paragraph
/// separators, bidirectional and other invisible format characters, and bytes that are not UTF-8.
std::string escaped(std::string_view text);
/// The same for one character: writes it to `to`, which has room for kMostEscaped bytes, and advances `at`, which is
/// before `end`. \return the number of bytes written. Safe in signal handlers.
std::size_t escape_letter(const char*& at, const char* end, char* to);
inline constexpr std::size_t kMostEscaped = 10;
/// Escapes text for one line of a message; leaves out the middle of a very long text.
std::string printable(std::string_view text);
/// 1234567 as "1,234,567".
std::string grouped(std::uint64_t number);
/// "1 mesh", "1,200 meshes". \param many  `one` with an s if not given
std::string counted(std::uint64_t count, std::string_view one, std::string_view many = {});

/// Returns how many columns UTF-8 text takes on a terminal: two for East Asian characters, none for a combining mark.
std::size_t width_of(std::string_view text);

/// Truncates the text to that many columns, with "..." at the cut; 0: no limit.
std::string cut_to(std::string_view text, std::size_t columns);

/// Formats a number with up to four significant digits; tiny values become 0, such as the rounding errors of a rest
/// pose.
std::string brief(float number);

/// Formats numbers with spaces between them.
template <std::size_t N>
std::string brief(const std::array<float, N>& numbers) {
    std::string text;
    for (const float number : numbers) {
        if (!text.empty()) text += ' ';
        text += brief(number);
    }
    return text;
}

/// Returns the first 72 bytes of a text, escaped; "..." if it was cut.
std::string brief(std::string_view text);

/// "Hips, Spine"; of more than five names the first five, and how many more there are.
std::string some_of(const std::vector<std::string>& names);

/// Adds a part to a line, after ", " if it is not the first.
void add_part(std::string& line, std::string_view part);

/// Colours are used only on a terminal, and not if NO_COLOR is set (no-color.org) or TERM is "dumb".
enum class Colour { bold, red, yellow };

/// Returns the text in that colour, bold, if the stream shows colours; otherwise unchanged.
std::string in_colour(Colour colour, std::string_view text, Stream stream);

/// "bendy: error: " and "bendy: warning: ", for standard error.
std::string error_label();
std::string warning_label();

/// Thrown when the input is bad or the work failed, after the reason has been printed.
struct Failed {
    int status = 1;                   ///< the program's exit status
    std::filesystem::path file = {};  ///< the file that the reason is about, and the reason; for reports
    std::string what = {};
};

/// Prints `bendy: error: FILE: reason` to standard error, escaped, and throws Failed.
[[noreturn]] void fail(const std::filesystem::path& file, std::string_view what);
/// The same for a fault in a file's bytes, with chunk path and offset.
[[noreturn]] void fail(const std::filesystem::path& file, const Error& error, Bytes bytes);
/// Prints `bendy: warning: FILE: what` to standard error, escaped.
void warn(const std::filesystem::path& file, std::string_view what);

/// Prints what a conversion has left out or changed, and its suggestions, one per line, to standard error.
void print_warnings(const std::filesystem::path& file, const converter::Report& report);
/// Prints its guesses in the same way: all, or, unless `is_verbose`, one line with how many there are of each kind.
void print_proposals(const std::filesystem::path& file, const converter::Report& report, bool is_verbose);

/// Prints a line for each fault: the file, the code, the fault and its position.
void print_fault_lines(std::ostream& out, const std::filesystem::path& file, const Faults& faults, Bytes bytes);

/// Says that a file has faults, and the first of them: in a warning if it is written nevertheless, and as an error.
void warn_of_faults(const std::filesystem::path& file, const Faults& faults, Bytes bytes);
[[noreturn]] void fail_for_faults(const std::filesystem::path& file, const Faults& faults, Bytes bytes);

/// Returns the file that an error of the converter is about.
std::filesystem::path file_of(const converter::ImportError& error, const std::filesystem::path& input);
/// Describes the error in one line.
std::string describe(const converter::ImportError& error);

}  // namespace bendy::tools
