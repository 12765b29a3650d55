#include "problem.h"

#include "colour.h"

#include <bendy/format/diagnostics.h>

#include <array>
#include <cstdio>
#include <iostream>

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

}  // namespace bendy::cli
