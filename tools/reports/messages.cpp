#include "reports/messages.h"

#include <bendy/format/charconv.h>
#include <bendy/format/diagnostics.h>

#include <utf8cpp/utf8.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>

namespace bendy::tools {
namespace {

struct Range {
    char32_t first, last;
};

bool is_in(char32_t letter, const Range* begin, const Range* end) {
    return std::any_of(begin, end, [letter](const Range& r) { return letter >= r.first && letter <= r.last; });
}

/// Unicode's East Asian wide and fullwidth letters, in large blocks.
std::size_t columns_of_letter(char32_t letter) {
    constexpr std::array kWide{Range{0x1100, 0x115f}, Range{0x2e80, 0xa4cf},   Range{0xac00, 0xd7a3},
                               Range{0xf900, 0xfaff}, Range{0xfe30, 0xfe6f},   Range{0xff00, 0xff60},
                               Range{0xffe0, 0xffe6}, Range{0x1f300, 0x1faff}, Range{0x20000, 0x3fffd}};
    constexpr std::array kNone{Range{0x300, 0x36f}, Range{0x200b, 0x200f}, Range{0x20d0, 0x20ff},
                               Range{0xfe00, 0xfe0f}};
    if (is_in(letter, kNone.data(), kNone.data() + kNone.size())) return 0;
    return is_in(letter, kWide.data(), kWide.data() + kWide.size()) ? 2 : 1;
}

/// Returns the columns that the character at `at` takes, and advances `at`. A byte that is not UTF-8 takes one column.
std::size_t next_columns(const char*& at, const char* end) {
    constexpr std::ptrdiff_t kLongest = 4;
    if (utf8::find_invalid(at, at + std::min(kLongest, end - at)) == at) {
        ++at;
        return 1;
    }
    return columns_of_letter(utf8::unchecked::next(at));
}

/// Returns true if a character is printed as itself and affects nothing else on the line.
bool is_shown(char32_t letter) {
    constexpr std::array kHidden{Range{0x00, 0x1f},     Range{0x7f, 0x9f},     Range{0xad, 0xad},
                                 Range{0x61c, 0x61c},   Range{0x180e, 0x180e}, Range{0x200b, 0x200b},
                                 Range{0x200e, 0x200f}, Range{0x2028, 0x202e}, Range{0x2060, 0x206f},
                                 Range{0xfeff, 0xfeff}, Range{0xfff9, 0xfffb}, Range{0xe0000, 0xe0fff}};
    return !is_in(letter, kHidden.data(), kHidden.data() + kHidden.size());
}

/// Writes "\x1b". \return the length
std::size_t put_escape(std::string_view before, std::uint32_t number, std::size_t digits, char* to) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    char* at = std::copy(before.begin(), before.end(), to);
    for (std::size_t k = digits; k > 0; --k) *at++ = kDigits[number >> 4 * (k - 1) & 0xfu];
    return static_cast<std::size_t>(at - to);
}

std::string about_faults(const Faults& faults, Bytes bytes) {
    return "the file has faults, `bendy validate` lists them; the first: " +
           describe_with_place(faults.list().front(), bytes);
}

/// "2 IK chains (LeftLeg, RightLeg), limits of 1 joint (LeftFoot)"
std::string count_by_kind(const std::vector<converter::Proposal>& proposals) {
    using converter::Proposal;
    struct Words {
        Proposal::Kind kind;
        std::string_view before, one, many;
    };
    constexpr std::array kWords{Words{Proposal::Kind::chain, "", "IK chain", "IK chains"},
                                Words{Proposal::Kind::limits, "limits of ", "joint", "joints"},
                                Words{Proposal::Kind::skin, "skins of ", "mesh", "meshes"}};
    std::string line;
    for (const Words& words : kWords) {
        std::vector<std::string> names;
        for (const Proposal& proposal : proposals) {
            if (proposal.kind == words.kind) names.push_back(proposal.name);
        }
        if (names.empty()) continue;
        add_part(line, words.before);
        line += counted(names.size(), words.one, words.many) + " (" + some_of(names) + ')';
    }
    return line;
}

bool shows_colour(Stream stream) {
    static const char* const refused = std::getenv("NO_COLOR");  // NOLINT(concurrency-mt-unsafe): nothing changes it
    static const bool on_output = is_terminal(Stream::output);
    static const bool on_error = is_terminal(Stream::error);
    if (refused != nullptr && *refused != '\0') return false;
    return stream == Stream::output ? on_output : on_error;
}

}  // namespace

std::string shown_name(const std::filesystem::path& input) {
    return input == "-" ? "standard input" : escaped(input.string());
}

std::size_t escape_letter(const char*& at, const char* end, char* to) {
    constexpr std::ptrdiff_t kLongest = 4;
    const char* const first = at;
    if (utf8::find_invalid(at, at + std::min(kLongest, end - at)) == at) {
        ++at;
        return put_escape("\\x", static_cast<unsigned char>(*first), 2, to);
    }
    const char32_t letter = utf8::unchecked::next(at);
    if (is_shown(letter)) return static_cast<std::size_t>(std::copy(first, at, to) - to);
    if (letter < 0x80) return put_escape("\\x", letter, 2, to);
    return letter < 0x10000 ? put_escape("\\u", letter, 4, to) : put_escape("\\U", letter, 8, to);
}

std::string escaped(std::string_view text) {
    std::string out;
    std::array<char, kMostEscaped> letter{};
    const char* const end = text.data() + text.size();
    for (const char* at = text.data(); at != end;) {
        const std::size_t size = escape_letter(at, end, letter.data());
        out.append(letter.data(), size);
    }
    return out;
}

std::string printable(std::string_view text) {
    constexpr std::size_t kMost = 600;
    constexpr std::size_t kAtEnd = 150;
    std::string out = escaped(text);
    if (out.size() <= kMost) return out;
    const auto is_inside_letter = [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) == 0x80u; };
    std::size_t cut = kMost - kAtEnd;
    std::size_t from = out.size() - kAtEnd;
    while (is_inside_letter(out[cut])) --cut;
    while (is_inside_letter(out[from])) --from;
    return out.replace(cut, from - cut, "...");
}

std::string grouped(std::uint64_t number) {
    std::string digits = std::to_string(number);
    for (std::size_t at = digits.size(); at > 3;) {
        at -= 3;
        digits.insert(at, 1, ',');
    }
    return digits;
}

std::string counted(std::uint64_t count, std::string_view one, std::string_view many) {
    std::string text = grouped(count) + ' ';
    text += count == 1 || many.empty() ? one : many;
    if (count != 1 && many.empty()) text += 's';
    return text;
}

std::size_t width_of(std::string_view text) {
    std::size_t columns = 0;
    const char* const end = text.data() + text.size();
    for (const char* at = text.data(); at != end;) columns += next_columns(at, end);
    return columns;
}

std::string cut_to(std::string_view text, std::size_t columns) {
    constexpr std::string_view kDots = "...";
    if (columns == 0 || text.size() <= columns || width_of(text) <= columns) return std::string(text);
    if (columns <= kDots.size()) return std::string(kDots.substr(0, columns));
    const char* const end = text.data() + text.size();
    const char* cut = text.data();
    std::size_t taken = 0;
    for (const char* at = cut; at != end; cut = at) {
        taken += next_columns(at, end);
        if (taken > columns - kDots.size()) break;
    }
    return std::string(text.data(), cut) + std::string(kDots);
}

std::string brief(float number) {
    constexpr float kNextToNothing = 5e-7f;
    constexpr int kDigits = 4;
    if (std::abs(number) < kNextToNothing) return "0";
    std::array<char, 32> digits{};
    const auto end =
        to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::general, kDigits).ptr;
    return {digits.data(), end};
}

std::string brief(std::string_view text) {
    constexpr std::size_t kMost = 72;
    std::size_t cut = std::min(kMost, text.size());
    while (cut > 0 && cut < text.size() && (static_cast<unsigned char>(text[cut]) & 0xc0u) == 0x80u)
        --cut;  // not inside a character
    std::string shown = escaped(text.substr(0, cut));
    if (cut < text.size()) shown += "...";
    return shown;
}

std::string some_of(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 5;
    std::string text;
    for (std::size_t k = 0; k < names.size() && k < kMost; ++k) add_part(text, names[k]);
    if (names.size() > kMost) text += " and " + grouped(names.size() - kMost) + " more";
    return text;
}

void add_part(std::string& line, std::string_view part) {
    if (!line.empty()) line += ", ";
    line += part;
}

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

void fail(const std::filesystem::path& file, std::string_view what) {
    std::cerr << error_label() << shown_name(file) << ": " << printable(what) << '\n';
    throw Failed{1, file, std::string(what)};
}

void fail(const std::filesystem::path& file, const Error& error, Bytes bytes) {
    fail(file, describe_with_place(error, bytes));
}

void warn(const std::filesystem::path& file, std::string_view what) {
    std::cerr << warning_label() << shown_name(file) << ": " << printable(what) << '\n';
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
        std::cerr << "bendy: note: " << shown_name(file) << ": " << printable(line) << '\n';
}

void print_proposals(const std::filesystem::path& file, const converter::Report& report, bool is_verbose) {
    const std::vector<converter::Proposal>& proposals = report.proposals();
    const auto print = [&](std::string_view line) {
        std::cerr << "bendy: proposed: " << shown_name(file) << ": " << printable(line) << '\n';
    };
    if (is_verbose || proposals.size() <= 1) {
        for (const converter::Proposal& proposal : proposals) print(proposal.line);
        return;
    }
    print(count_by_kind(proposals) + "; --verbose lists them");
}

void print_fault_lines(std::ostream& out, const std::filesystem::path& file, const Faults& faults, Bytes bytes) {
    for (const Error& fault : faults.list()) {
        out << shown_name(file) << ": " << code_name(fault.code) << ": " << printable(describe_with_place(fault, bytes))
            << '\n';
    }
    if (faults.left_out() != 0) out << shown_name(file) << ": " << grouped(faults.left_out()) << " more faults\n";
}

void warn_of_faults(const std::filesystem::path& file, const Faults& faults, Bytes bytes) {
    warn(file, about_faults(faults, bytes));
}

void fail_for_faults(const std::filesystem::path& file, const Faults& faults, Bytes bytes) {
    fail(file, about_faults(faults, bytes));
}

std::filesystem::path file_of(const converter::ImportError& error, const std::filesystem::path& input) {
    return error.file.empty() ? input : error.file;
}

std::string describe(const converter::ImportError& error) {
    return printable(error.place.empty() ? error.message : error.place + ": " + error.message);
}

}  // namespace bendy::tools
