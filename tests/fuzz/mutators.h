#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

// Mutations with which the hours go beneath the checks that a single changed byte fails at, with the signatures of
// LLVMFuzzerCustomMutator and LLVMFuzzerCustomCrossOver in libFuzzer's documentation. What cannot be read as a file of
// the kind changes as bytes.

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace bendy::fuzz {

using Random = std::minstd_rand;

/// An index of one of `count` things; 0 if there is none.
inline std::size_t below(Random& random, std::size_t count) {
    return count == 0 ? 0 : random() % count;
}

/// JSON, or .glb: a value of the JSON, or the bytes behind it, so that both stay readable. Text stays text, .glb stays
/// .glb with lengths that are right.
std::size_t mutate_gltf(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed);

/// A bendy file: inside leaves, and whole chunks that move; sizes, padding and sums are right.
std::size_t mutate_bendy(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed);
/// A chunk of one file takes the place of one with the same id in the other.
std::size_t cross_bendy(const std::uint8_t* a, std::size_t a_size, const std::uint8_t* b, std::size_t b_size,
                        std::uint8_t* out, std::size_t max_size, unsigned seed);

}  // namespace bendy::fuzz
