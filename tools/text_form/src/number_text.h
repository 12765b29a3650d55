#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/record_table.h>
#include <bendy/format/records.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Numbers and bytes in the text form. Floats are written as the shortest decimal that reads back to the same bits.
namespace bendy::text_form {

/// Appends the number at `at`, which must be inside the bytes. A float that JSON cannot express is written as a string:
/// "inf", "-inf", or "nan:0x7fc00000" with its bits.
void append_number(std::string& out, NumberType type, Bytes bytes, std::uint64_t at);

/// Why a text is not a number of a type.
enum class NumberFault : std::uint8_t { none, not_whole, out_of_range, no_number };

/// Appends the number's bytes.
/// \param token  starts with a number in JSON's grammar; anything after it is ignored
NumberFault parse_number(std::string_view token, NumberType type, std::vector<std::byte>& out);
/// The same for the strings that append_number writes.
NumberFault parse_special(std::string_view text, std::vector<std::byte>& out);

/// Appends two hexadecimal digits per byte.
void append_hex(std::string& out, Bytes bytes);

/// Appends the bytes for a text of hexadecimal digits, upper or lower case. Returns false if the text contains other
/// characters, or an odd number of digits.
bool parse_hex(std::string_view text, std::vector<std::byte>& out);

}  // namespace bendy::text_form
