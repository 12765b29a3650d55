// Linked into the targets whose input is a bendy file.
#include "mutators.h"

// NOLINTBEGIN(readability-identifier-naming): libFuzzer's names
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    return bendy::fuzz::mutate_bendy(data, size, max_size, seed);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* a, std::size_t a_size, const std::uint8_t* b,
                                                 std::size_t b_size, std::uint8_t* out, std::size_t max_size,
                                                 unsigned seed) {
    return bendy::fuzz::cross_bendy(a, a_size, b, b_size, out, max_size, seed);
}
// NOLINTEND(readability-identifier-naming)
