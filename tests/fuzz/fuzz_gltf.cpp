// Imports a glTF file and converts it: whatever the bytes are, an error or a valid bendy file.
#include "check.h"
#include "memory_file.h"
#include "use_model.h"

#include <bendy/converter/convert.h>
#include <bendy/format/document.h>

#include <cstddef>
#include <cstdint>

// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const bendy::fuzz::MemoryFile file(data, size);
    const unsigned choice = size > 32 ? static_cast<unsigned>(size) + data[size / 2] : 0;
    bendy::converter::ConvertOptions options;
    options.auto_rig = choice % 4 == 0;
    options.sort_vertices = choice % 8 == 1;
    options.lod = choice % 16 == 2;
    bendy::converter::Report report;
    const auto converted = bendy::converter::convert(file.path(), options, report);
    if (!converted) return 0;
    bendy::fuzz::check(bendy::validate(*converted).empty(), "what is converted is valid");
    if (const auto model = bendy::Model::from_memory(*converted)) bendy::fuzz::use_model(*model, choice);
    return 0;
}
