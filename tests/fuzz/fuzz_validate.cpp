// Finds everything that is wrong with a file, says where, and holds the parts of the reader against one another.
#include "check.h"

#include <bendy/format/chunk_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>
#include <bendy/runtime.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace {

using namespace bendy;

/// Words and paths for every fault; a whole path leads back to a chunk that holds the place.
void describe_all(const Faults& faults, Bytes file, const ChunkTree* tree) {
    std::size_t few = 0;
    for (const Error& fault : faults.list()) {
        if (++few > 20) return;
        fuzz::check(!describe_with_place(fault, file).empty(), "a fault has a text");
        if (tree == nullptr) continue;
        const std::uint32_t number = find_path(*tree, whole_chunk_path(file, fault.offset));
        fuzz::check(number != kNone && (*tree)[number].offset <= fault.offset,
                    "a path leads to the chunk at its offset");
    }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    const std::vector<std::byte> file(bytes, bytes + size);
    const Faults faults = validate(file);
    auto tree = read_chunk_tree(file);
    describe_all(faults, file, tree ? &*tree : nullptr);
    if (!tree) {
        fuzz::check(faults.count() == 1 && faults.list()[0].code == tree.error().code, "one fault ends the walk");
        return 0;
    }
    decode_leaves(*tree);
    Faults shape;
    const Document document = read_document(*tree, shape);
    fuzz::check(faults.count() >= shape.count(), "what the reader finds, validation finds");
    for (std::uint32_t object = 0; object < document.objects.size() && object < 4; ++object) {
        OpenOptions options;
        options.object = object;
        const auto model = Model::from_memory(file, options);
        fuzz::check(model || !faults.empty(), "what is valid opens");
    }
    return 0;
}
