// Reads a Biovision file: whatever the bytes are, an error or a Scene that makes a valid bendy file.
#include "check.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/format/document.h>

#include <cstddef>
#include <cstdint>
#include <string_view>

// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    bendy::converter::Report report;
    const auto scene = bendy::converter::import_bvh({reinterpret_cast<const char*>(data), size}, "fuzz", {}, report);
    if (!scene) return 0;
    const auto bytes = bendy::converter::build_chunks(*scene, "fuzz", report);
    bendy::fuzz::check(bendy::validate(bytes).empty(), "what is read makes a valid file");
    return 0;
}
