#pragma once

#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace bendy::test {

/// The places of a file that the tests of damage visit: every `step`-th, from `first` on.
struct Places {
    std::size_t first = 0;
    std::size_t step = 1;
};

/// All places, or those that the environment variable BENDY_PLACES names as FIRST/STEP. scripts/test.sh visits one of
/// seven, another one for each commit; seven has no factor in common with the 8 bits of a byte nor with the 4 bytes of
/// a field, so all of these are visited in turn.
inline Places places() {
    const char* const given = std::getenv("BENDY_PLACES");
    if (given == nullptr) return {};
    const std::string_view text = given;
    const char* const end = text.data() + text.size();
    Places places;
    const auto first = std::from_chars(text.data(), end, places.first);
    if (first.ec == std::errc() && first.ptr != end && *first.ptr == '/') {
        const auto step = std::from_chars(first.ptr + 1, end, places.step);
        if (step.ec == std::errc() && step.ptr == end && places.first < places.step) return places;
    }
    throw std::runtime_error("BENDY_PLACES is FIRST/STEP, as in 3/7, with FIRST below STEP");
}

}  // namespace bendy::test
