// Bendy files: every one that can be walked comes back from its text form, byte for byte.
#include "check.h"

#include <bendy/format/chunk_reader.h>
#include <bendy/text_form/text_form.h>

#include <cstddef>
#include <cstdint>
#include <vector>

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bendy;
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    const std::vector<std::byte> file(bytes, bytes + size);
    auto tree = read_chunk_tree(file);
    if (!tree) return 0;
    Faults faults;
    check_sums(*tree, faults);
    decode_leaves(*tree);
    std::size_t decoded = 0;
    for (std::uint32_t number = 0; number < tree->chunks().size(); ++number) {
        if (!(*tree)[number].is_container()) decoded += tree->payload(number).size();
    }
    constexpr std::size_t kSlow = 1u << 20;  // bytes that a small file may decode to: true, but it takes long
    if (decoded > kSlow) return 0;
    const auto again = text_form::assemble(text_form::dump(*tree));
    fuzz::check(again.has_value(), "what is dumped assembles");
    fuzz::check(!faults.empty() || *again == file, "a file with right sums comes back byte for byte");
    return 0;
}
