// Writes a bendy file as glTF, and a level of detail of it: whatever it holds, it is refused, or what comes out can be
// imported.
#include "check.h"

#include <bendy/converter/export.h>
#include <bendy/converter/import.h>
#include <bendy/runtime/lod.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace bendy;

void expect_importable(const converter::GltfAsset& asset) {
    const auto glb = converter::make_glb(asset);
    fuzz::check(bool{glb}, "a small file fits into a GLB file");
    converter::Report unheard;
    const auto scene = converter::import_gltf(*glb, "fuzz", {}, unheard);
    const bool has_nodes = asset.json.find("\"nodes\"") != std::string::npos;  // an object may be without joints
    if (!scene && has_nodes) fuzz::check(false, (scene.error().place + ": " + scene.error().message).c_str());
}

/// A third of the triangles, if the file has levels.
converter::ExportOptions a_level(Bytes bytes) {
    converter::ExportOptions options;
    const Result<Model> model = Model::from_memory(bytes);
    if (!model || model->collapse() == nullptr) return options;
    Lod lod(*model);
    lod.set_share(0.3f);
    for (std::uint32_t mesh = 0; mesh < model->meshes().size(); ++mesh) options.vertices.push_back(lod.vertices(mesh));
    return options;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    const std::vector<std::byte> aligned(bytes, bytes + size);
    converter::Report report;
    const auto asset = converter::export_gltf(aligned, {}, report);
    if (!asset) {
        fuzz::check(!asset.error().message.empty(), "what is refused is refused for a reason");
        return 0;
    }
    expect_importable(*asset);
    const converter::ExportOptions options = a_level(aligned);
    if (options.vertices.empty()) return 0;
    const auto level = converter::export_gltf(aligned, {}, report, options);
    fuzz::check(bool{level}, "what can be exported can be at each level");
    expect_importable(*level);
    return 0;
}
