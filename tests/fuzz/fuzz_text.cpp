// Text forms: a fault with its place, or a well-formed file that comes back from its own text form.
#include "check.h"

#include <bendy/format/chunk_reader.h>
#include <bendy/text_form/text_form.h>

#include <cstddef>
#include <cstdint>
#include <string_view>

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bendy;
    const auto file = text_form::assemble({reinterpret_cast<const char*>(data), size});
    if (!file) {
        fuzz::check(file.error().line >= 1 && file.error().column >= 1 && file.error().column <= size + 1 &&
                        !file.error().what.empty(),
                    "a fault has a place and a text");
        return 0;
    }
    auto tree = read_chunk_tree(*file);
    fuzz::check(tree.has_value(), "what assembles is well-formed");
    Faults faults;
    check_sums(*tree, faults);
    fuzz::check(faults.empty(), "its sums are right");
    decode_leaves(*tree);
    const auto again = text_form::assemble(text_form::dump(*tree));
    fuzz::check(again && *again == *file, "it comes back from its text form");
    return 0;
}
