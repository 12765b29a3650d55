#include "terminal/problem.h"

#include "terminal/colour.h"

#include <bendy/format/diagnostics.h>

#include <array>
#include <cstdio>
#include <iostream>
#include <ostream>
#include <string>

namespace bendy::cli {

void fail(const std::filesystem::path& file, std::string_view what) {
    std::cerr << error_label() << shown_name(file) << ": " << what << '\n';
    throw Failed{1, file, std::string(what)};
}

void fail(const std::filesystem::path& file, const Error& error, Bytes bytes) {
    fail(file, describe_with_place(error, bytes));
}

void warn(const std::filesystem::path& file, std::string_view what) {
    std::cerr << warning_label() << shown_name(file) << ": " << what << '\n';
}

std::string shown_name(const std::filesystem::path& input) {
    return input == "-" ? "standard input" : printable(input.string());
}

std::string printable(std::string_view text) {
    std::string out;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte != 0x7f) {
            out += c;
            continue;
        }
        std::array<char, 5> escape{};
        std::snprintf(escape.data(), escape.size(), "\\x%02x", static_cast<unsigned>(byte));
        out += escape.data();
    }
    return out;
}

std::string grouped(std::uint64_t number) {
    std::string digits = std::to_string(number);
    for (std::size_t at = digits.size(); at > 3;) {
        at -= 3;
        digits.insert(at, 1, ',');
    }
    return digits;
}

void print_warnings(const std::filesystem::path& file, const converter::Report& report) {
    for (const converter::Warning& warning : report.warnings()) {
        std::string line;
        if (!warning.first_place.empty()) line = warning.first_place + ": ";
        line += warning.message;
        if (warning.count > 1) line += " (" + grouped(warning.count) + " times)";
        warn(file, printable(line));
    }
    for (const std::string& line : report.suggestions())
        std::cerr << "bendy: note: " << printable(file.string()) << ": " << printable(line) << '\n';
}

void print_proposals(const converter::Report& report) {
    for (const std::string& line : report.proposals()) std::cerr << "bendy: proposed: " << printable(line) << '\n';
}

void print_fault_lines(std::ostream& out, const std::filesystem::path& file, const Faults& faults, Bytes bytes) {
    for (const Error& fault : faults.list())
        out << shown_name(file) << ": " << code_name(fault.code) << ": " << describe_with_place(fault, bytes) << '\n';
    if (faults.left_out() != 0) out << shown_name(file) << ": " << grouped(faults.left_out()) << " more faults\n";
}

std::filesystem::path file_of(const converter::ImportError& error, const std::filesystem::path& input) {
    return error.file.empty() ? input : error.file;
}

std::string describe(const converter::ImportError& error) {
    return printable(error.place.empty() ? error.message : error.place + ": " + error.message);
}

}  // namespace bendy::cli
