// Reads an X-file: whatever the bytes are, an error or a Scene that makes a valid bendy file, which can be written as
// an X-file that is read again.
#include "check.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/export.h>
#include <bendy/converter/import.h>
#include <bendy/format/document.h>

#include <cstddef>
#include <cstdint>
#include <string_view>

// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using bendy::fuzz::check;
    bendy::converter::Report report;
    const std::string_view file(reinterpret_cast<const char*>(data), size);
    auto scene = bendy::converter::import_x(file, "fuzz.x", {.embed_images = false}, report);
    if (!scene) return 0;
    const auto bytes = bendy::converter::build_chunks(*scene, "fuzz", report);
    check(bendy::validate(bytes).empty(), "what is read makes a valid file");
    const auto asset = bendy::converter::export_x(bytes, "fuzz", report);
    check(asset.has_value(), "what is valid is written as an X-file");
    const auto again = bendy::converter::import_x(asset->text, "fuzz.x", {.embed_images = false}, report);
    check(again.has_value(), "what we write we read");
    check(again->joints.size() == scene->joints.size(), "with the same joints");
    return 0;
}
