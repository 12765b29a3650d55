#include "reports/json.h"

#include "reports/messages.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace bendy::tools {

std::string without_controls(std::string json) {
    const auto is_plain = [](char c) { return static_cast<unsigned char>(c) < 0x7f; };
    if (std::all_of(json.begin(), json.end(), is_plain)) return json;
    std::string out;
    out.reserve(json.size());
    std::array<char, kMostEscaped> letter{};
    const char* const end = json.data() + json.size();
    for (const char* at = json.data(); at != end;) {
        if (is_plain(*at)) {  // including line breaks between the values
            out += *at++;
            continue;
        }
        const std::size_t size = escape_letter(at, end, letter.data());
        const std::string_view shown(letter.data(), size);
        if (shown.starts_with("\\x")) {
            out.append("\\u00").append(shown.substr(2));
        } else if (shown.starts_with("\\U")) {  // JSON uses UTF-16
            const unsigned long offset = std::stoul(std::string(shown.substr(2)), nullptr, 16) - 0x10000;
            std::array<char, 13> pair{};
            std::snprintf(pair.data(), pair.size(), "\\u%04hx\\u%04hx",
                          static_cast<unsigned short>(0xd800 + (offset >> 10)),
                          static_cast<unsigned short>(0xdc00 + (offset & 0x3ff)));
            out += pair.data();
        } else {
            out += shown;
        }
    }
    return out;
}

}  // namespace bendy::tools
