#include "convert/depfile.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <type_traits>

namespace bendy::tools {
namespace {

constexpr bool kHasDrives = std::is_same_v<std::filesystem::path::value_type, wchar_t>;

bool is_letter_or_digit(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           static_cast<unsigned char>(c) >= 0x80;
}

/// Characters that neither Make nor Ninja treats specially. '[', '*' and '?' are patterns in Make, '=' makes a name a
/// variable assignment, and Ninja ends a name at quotes, '&', '<', '>', '^', '`', ';' and '|'.
bool is_plain(char c) {
    return is_letter_or_digit(c) || std::string_view("_-./+,@{}()!~]%").find(c) != std::string_view::npos;
}

/// Before a space or '#', every backslash is doubled and one more is added. Elsewhere a backslash stands for itself, if
/// the following character is not one that it escapes.
bool add_backslashes(std::string& text, std::size_t count, char following) {
    if (count == 0) return true;
    const bool is_doubled = following == ' ' || following == '#';
    text.append(is_doubled ? 2 * count : count, '\\');
    return is_doubled || is_letter_or_digit(following) || following == '.' || following == '_' || following == '-';
}

/// Escapes a name so that both programs read it unchanged; nothing if that is impossible.
std::optional<std::string> as_in_rule(std::string_view name) {
    std::string text;
    std::size_t backslashes = 0;
    for (std::size_t at = 0; at < name.size(); ++at) {
        const char c = name[at];
        if (c == '\\') {
            ++backslashes;
            continue;
        }
        if (!add_backslashes(text, backslashes, c)) return std::nullopt;
        backslashes = 0;
        const bool is_last = at + 1 == name.size();
        const bool is_drive = kHasDrives && c == ':' && at == 1;  // C:/fox.glb
        if (is_drive || is_plain(c)) {
            text += c;
        } else if (c == '$') {
            text += "$$";
        } else if (c == '#' || ((c == ' ' || c == ':') && !is_last)) {
            text += '\\';
            text += c;
        } else {
            return std::nullopt;
        }
    }
    if (name.empty() || backslashes != 0) return std::nullopt;
    // Make expands "~a", and "./~a" too, to a home folder, and reads "a(b)" as an archive member.
    if (name.starts_with('~') || name.starts_with("./~")) return std::nullopt;
    if (name.ends_with(')') && name.find('(') != std::string_view::npos) return std::nullopt;
    return text;
}

}  // namespace

Result<std::string, UnwritableName> depfile_text(const std::string& target, const std::vector<std::string>& sources) {
    const auto written_target = as_in_rule(target);
    // In a target, Make treats % as a pattern.
    if (!written_target || target.find('%') != std::string::npos) return UnwritableName{target};
    std::string text = *written_target + ':';
    for (const std::string& source : sources) {
        const auto written = as_in_rule(source);
        if (!written) return UnwritableName{source};
        text += " \\\n  " + *written;
    }
    return text + '\n';
}

}  // namespace bendy::tools
