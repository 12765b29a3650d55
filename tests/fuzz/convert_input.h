#pragma once

#include <bendy/converter/convert.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace bendy::fuzz {

/// What fuzz_convert takes apart from its bytes: a source, behind it a rig file, behind that a tail of kTail bytes.
struct ConvertInput {
    static constexpr std::size_t kTail = 8;
    static constexpr std::size_t kOptions = 4;  ///< so many bytes of it say the options

    std::string_view source;
    std::string_view rig;
    /// The options: a bit for each switch, the bound of `compact`, the joint of `skeleton` and `scene`, a number for
    /// what is done with the result; then the rig's length in four bytes, little-endian.
    std::string_view tail;

    /// Nothing of bytes that are shorter than a tail: all of them are a source then.
    static ConvertInput split(std::span<const std::uint8_t> bytes);
    [[nodiscard]] converter::ConvertOptions options() const;
    /// Any number.
    [[nodiscard]] unsigned choice() const;
};

/// The bytes of which `split` makes these parts. \param tail  kTail bytes; the length in it is set
std::string join(std::string_view source, std::string_view rig, std::string_view tail);

}  // namespace bendy::fuzz
