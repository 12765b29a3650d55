// Rig files: an error with its place, or a rig.
#include <bendy/converter/report.h>

#include "mutators.h"
#include "rigging/rig/parse_rig.h"
#include "scene/failure.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    bendy::converter::Report report;
    try {
        (void)bendy::converter::parse_rig({reinterpret_cast<const char*>(data), size}, report);
    } catch (const bendy::converter::Failure&) {
    }
    return 0;
}

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    return bendy::fuzz::mutate_gltf(data, size, max_size, seed);
}
