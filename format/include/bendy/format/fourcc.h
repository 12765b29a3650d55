#pragma once

#include <bendy/format/public.h>

#include <array>
#include <cstdint>

namespace BENDY_PUBLIC bendy {

/// A chunk id: four capital letters or digits, stored in reading order (the first letter is the first byte in the
/// file).
struct FourCC {
    std::uint32_t value = 0;

    constexpr FourCC() = default;
    constexpr explicit FourCC(std::uint32_t raw) : value(raw) {}
    consteval explicit FourCC(const char (&letters)[5])
        : value(static_cast<std::uint32_t>(letters[0]) | static_cast<std::uint32_t>(letters[1]) << 8 |
                static_cast<std::uint32_t>(letters[2]) << 16 | static_cast<std::uint32_t>(letters[3]) << 24) {}

    friend constexpr bool operator==(FourCC, FourCC) = default;

    /// Returns true if all four bytes are 'A'..'Z' or '0'..'9'.
    [[nodiscard]] constexpr bool is_readable() const {
        for (unsigned shift = 0; shift < 32; shift += 8) {
            const std::uint32_t letter = value >> shift & 0xffu;
            if (!((letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9'))) return false;
        }
        return true;
    }

    /// Returns the letters, zero-terminated; bytes that are not printable ASCII become '?'.
    [[nodiscard]] constexpr std::array<char, 5> letters() const {
        std::array<char, 5> text{};
        for (unsigned i = 0; i < 4; ++i) {
            const std::uint32_t letter = value >> (8 * i) & 0xffu;
            text[i] = letter > 0x20 && letter < 0x7f ? static_cast<char>(letter) : '?';
        }
        return text;
    }
};

}  // namespace bendy
