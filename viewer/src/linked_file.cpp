#include <bendy/viewer/linked_file.h>

#include <algorithm>
#include <charconv>
#include <string>

namespace bendy::viewer {
namespace {

/// "a%20b" as "a b"; a percent sign that means nothing stays.
std::string percent_decoded(std::string_view text) {
    std::string out;
    for (std::size_t at = 0; at < text.size(); ++at) {
        unsigned byte = 0;
        const char* digits = text.data() + at + 1;
        if (text[at] == '%' && text.size() - at > 2 &&
            std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2 && byte != 0) {
            out += static_cast<char>(byte);
            at += 2;
        } else {
            out += text[at];
        }
    }
    return out;
}

}  // namespace

std::optional<std::filesystem::path> linked_file(const std::filesystem::path& folder, std::string_view uri) {
    if (folder.empty() || uri.empty() || uri.find(':') != std::string_view::npos) return std::nullopt;
    const std::filesystem::path file = percent_decoded(uri);
    const bool leads_out = std::any_of(file.begin(), file.end(), [](const auto& part) { return part == ".."; });
    if (file.is_absolute() || leads_out) return std::nullopt;
    return folder / file;
}

}  // namespace bendy::viewer
