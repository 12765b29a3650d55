#pragma once

#include <cstddef>

namespace bendy::test {

/// Tests that damage a file in every place visit every place in an optimised build, and one of seven under
/// AddressSanitizer, where a visit takes fifteen times as long. Seven has no factor in common with the 8 bits of a byte
/// nor with the 4 bytes of a field, so all of these are visited in turn.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr std::size_t kStep = 7;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr std::size_t kStep = 7;
#else
inline constexpr std::size_t kStep = 1;
#endif
#else
inline constexpr std::size_t kStep = 1;
#endif

}  // namespace bendy::test
