// Writes a bendy file as glTF: whatever it holds, it is refused, or what comes out can be imported.
#include "check.h"
#include "memory_file.h"

#include <bendy/converter/export_gltf.h>
#include <bendy/converter/import_gltf.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bendy;
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    const std::vector<std::byte> aligned(bytes, bytes + size);
    converter::Report report;
    const auto asset = converter::export_gltf(aligned, {}, report);
    if (!asset) {
        fuzz::check(!asset.error().message.empty(), "what is refused is refused for a reason");
        return 0;
    }
    const auto glb = converter::make_glb(*asset);
    fuzz::check(bool{glb}, "a small file fits into a GLB file");
    const fuzz::MemoryFile file(glb->data(), glb->size());
    converter::Report unheard;
    const auto scene = converter::import_gltf(file.path(), {}, unheard);
    const bool has_nodes = asset->json.find("\"nodes\"") != std::string::npos;  // an object may be without joints
    if (!scene && has_nodes) fuzz::check(false, (scene.error().place + ": " + scene.error().message).c_str());
    return 0;
}
