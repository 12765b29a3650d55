#pragma once

#include <bendy/format/byte_reader.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::text_form {

/// Appends two hexadecimal digits for each byte.
void append_hex(std::string& out, Bytes bytes);

/// Appends the bytes that the digits, upper or lower case, stand for. False if the text has others, or an odd number.
bool parse_hex(std::string_view text, std::vector<std::byte>& out);

}  // namespace bendy::text_form
