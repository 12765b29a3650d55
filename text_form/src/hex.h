#pragma once

#include <bendy/format/byte_reader.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::text_form {

/// Appends two hexadecimal digits per byte.
void append_hex(std::string& out, Bytes bytes);

/// Appends the bytes for a text of hexadecimal digits, upper or lower case. Returns false if the text contains other
/// characters, or an odd number of digits.
bool parse_hex(std::string_view text, std::vector<std::byte>& out);

}  // namespace bendy::text_form
