// Opens a file and does all that a game does with it.
#include "use_model.h"

#include <cstddef>
#include <cstdint>
#include <vector>

// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    const std::vector<std::byte> file(bytes, bytes + size);  // its own, on a boundary, so that reading on is seen
    bendy::OpenOptions options;
    options.sums = bendy::Sums::later;  // an attacker's sums are right
    if (const auto model = bendy::Model::from_memory(file, options))
        bendy::fuzz::use_model(*model, static_cast<unsigned>(size) + (size > 7 ? data[4] : 0u));
    return 0;
}
