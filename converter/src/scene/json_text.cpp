#include "scene/json_text.h"

#include "scene/failure.h"

#include <bendy/format/charconv.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>

namespace bendy::converter {
namespace {

bool is_hex(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

/// Whether text[i] starts `\uXYxx` with XY from `low` to `high` (hexadecimal digits of a surrogate's high byte).
bool is_surrogate(std::string_view text, std::size_t i, char low, char high) {
    if (i > text.size() || text.size() - i < 6 || text[i] != '\\' || text[i + 1] != 'u') return false;
    const char first = text[i + 2];
    const char second = text[i + 3] >= 'a' ? static_cast<char>(text[i + 3] - 'a' + 'A') : text[i + 3];
    return (first == 'd' || first == 'D') && second >= low && second <= high && is_hex(text[i + 4]) &&
           is_hex(text[i + 5]);
}

/// One pass over the text before parsing: bounds the nesting, and replaces escaped unpaired surrogates by U+FFFD in the
/// copy; JSON allows them, but UTF-8 cannot encode them. Returns how many there were.
std::size_t scan_text(std::string_view text, std::size_t most_levels, std::string& repaired) {
    std::size_t depth = 0;
    std::size_t unpaired = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '"') in_string = false;
            if (c != '\\') continue;
            if (is_surrogate(text, i, '8', 'B') && is_surrogate(text, i + 6, 'C', 'F')) {
                i += 11;
            } else if (is_surrogate(text, i, '8', 'F')) {
                if (unpaired++ == 0) repaired = text;
                repaired.replace(i, 6, "\\ufffd");
                i += 5;
            } else {
                i += 1;
            }
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > most_levels) {
                fail({}, "the JSON is nested deeper than " + std::to_string(most_levels) + " levels (byte " +
                             std::to_string(i) + ")");
            }
        } else if ((c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
    return unpaired;
}

[[noreturn]] void fail_at_byte(std::string_view text, std::size_t byte, std::string_view reason) {
    constexpr std::size_t kMaxReason = 160;
    byte = std::min(byte, text.size());
    const std::string_view before = text.substr(0, byte);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
    std::string message = "invalid JSON at line " + std::to_string(line) + ", column " +
                          std::to_string(std::max<std::size_t>(1, byte - line_start)) + " (byte " +
                          std::to_string(byte) + "): ";
    // The library's message repeats the place before the reason.
    if (const std::size_t colon = reason.find("column "); colon != std::string_view::npos) {
        if (const std::size_t end = reason.find(": ", colon); end != std::string_view::npos)
            reason.remove_prefix(end + 2);
    }
    const bool cut = reason.size() > kMaxReason;
    for (const char c : reason.substr(0, kMaxReason)) message += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    if (cut) {
        while (!message.empty() && (static_cast<unsigned char>(message.back()) & 0xc0u) == 0x80u) message.pop_back();
        message += "...";
    }
    fail({}, message);
}

}  // namespace

template <class Value>
Value parse_json_text(std::string_view text, Report& report, std::size_t most_levels) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) fail({}, "invalid JSON: the text is empty");
    std::string repaired;
    if (const std::size_t unpaired = scan_text(text, most_levels, repaired); unpaired > 0) {
        report.warn("half a surrogate pair in a string was replaced by U+FFFD", {}, unpaired);
        text = repaired;
    }
    JsonFault fault;
    std::optional<Value> value = Value::parse(text, &fault);
    if (value) return *std::move(value);
    if (!fault.is_out_of_range) fail_at_byte(text, fault.byte, fault.reason);
    // "[json.exception.out_of_range.406] number overflow parsing '1e999'"
    fail({}, "invalid JSON: " + fault.reason.substr(std::min(fault.reason.find(' ') + 1, fault.reason.size()), 160));
}

template Json parse_json_text<Json>(std::string_view text, Report& report, std::size_t most_levels);
template OrderedJson parse_json_text<OrderedJson>(std::string_view text, Report& report, std::size_t most_levels);

Json json_number(float value) {
    std::array<char, 64> text{};
    const char* end = to_chars(text.data(), text.data() + text.size(), value).ptr;
    double shortest = 0.0;
    from_chars(text.data(), end, shortest);
    return shortest;
}

Json json_numbers(std::span<const float> values) {
    Json list = Json::array();
    for (const float value : values) list.push_back(json_number(value));
    return list;
}

}  // namespace bendy::converter
