#pragma once

#include <bendy/converter/report.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/error.h>

#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>

namespace bendy::cli {

/// Thrown when the input is bad or the work failed, after the reason has been printed.
struct Failed {
    int status = 1;                   ///< what the program exits with
    std::filesystem::path file = {};  ///< that the reason is about, and the reason; for reports
    std::string what = {};
};

/// Prints `bendy: error: FILE: what is wrong` to standard error and throws Failed.
[[noreturn]] void fail(const std::filesystem::path& file, std::string_view what);
/// The same for a fault in a file's bytes, with chunk path and offset.
[[noreturn]] void fail(const std::filesystem::path& file, const Error& error, Bytes bytes);
/// Prints `bendy: warning: FILE: what` to standard error.
void warn(const std::filesystem::path& file, std::string_view what);

/// An input's name for a terminal; a dash is standard input.
std::string shown_name(const std::filesystem::path& input);
/// Text for a terminal: control characters are escaped, so that a name cannot move the cursor or forge a line.
std::string printable(std::string_view text);
/// 1234567 as "1,234,567".
std::string grouped(std::uint64_t number);

/// Prints what a conversion has left out or changed, and what it suggests, a line each, to standard error.
void print_warnings(const std::filesystem::path& file, const converter::Report& report);
/// Prints what it has guessed, likewise.
void print_proposals(const converter::Report& report);

/// A line for each fault: the file, the code, what is wrong and where.
void print_fault_lines(std::ostream& out, const std::filesystem::path& file, const Faults& faults, Bytes bytes);

/// The file that an error of the converter is about.
std::filesystem::path file_of(const converter::ImportError& error, const std::filesystem::path& input);
/// What is wrong with it, in one line.
std::string describe(const converter::ImportError& error);

}  // namespace bendy::cli
