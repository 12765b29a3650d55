#pragma once

#include <string>
#include <string_view>

namespace bendy::converter::x {

/// Text for a string of an X-file, which has no escapes and which some readers take for code: every byte but letters,
/// digits, `-_.:+` and spaces becomes a percent sign and two hexadecimal digits; UTF-8 past ASCII stays.
std::string encode_text(std::string_view text);

/// The text again; a percent sign without two digits stands for itself.
std::string decode_text(std::string_view text);

/// UTF-8: text of other encodings is taken for Latin-1.
std::string to_utf8(std::string_view text);

}  // namespace bendy::converter::x
