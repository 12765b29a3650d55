#include "check_json.h"
#include "document.h"
#include "extensions.h"
#include "parts.h"
#include "scene/failure.h"
#include "scene/source/source_file.h"
#include "source_generator.h"
#include "tinygltf.h"

#include <bendy/converter/import.h>

#include <exception>
#include <new>
#include <string>
#include <utility>

namespace bendy::converter {

namespace gltf {
namespace {

/// An element of a root array may be three bytes of JSON, but takes several hundred bytes in memory.
void charge_elements(const Json& root, Budget& budget) {
    constexpr std::uint64_t kElement = 1024;  // bytes, about
    for (const auto& [name, member] : root.items()) {
        if (member.is_array()) budget.take(member.size(), kElement, name);
    }
}

Scene import(std::vector<std::byte> bytes, ReadableFolders folders, const GltfOptions& options, Report& report) {
    const Container container = open_container(std::move(bytes));
    Json root = parse_json(container.json, options.instances, report);
    Budget budget;
    budget.add_source(container.bytes.size());
    charge_elements(root, budget);
    NamedFiles files(std::move(folders), budget, report);
    Buffers buffers(root, container, files);
    const tinygltf::Model model = read_structure(root);
    const Document document{files, root, model, buffers, budget, report};

    Scene scene;
    report_extensions(root, report);
    const Skeleton skeleton = import_skeleton(document, options, scene);
    import_rig_extensions(document, skeleton, scene);
    report_left_out(document, skeleton);
    import_images(document, options.embed_images, scene);
    import_materials(document, scene);
    const MeshesOfNode meshes = import_meshes(document, skeleton, scene);
    keep_extensions(document, skeleton, meshes, scene);
    import_animations(document, skeleton, meshes, scene);
    keep_members(document, skeleton, scene);
    scene.source_extras = extras_text(root);
    Json asset = root["asset"];
    if (asset["version"] != "2.0") {
        report.warn("glTF " + quote(asset["version"].text()) +
                        " is read as glTF 2.0: what only the later version has is kept as JSON, not interpreted",
                    "asset.version");
    }
    const bool is_ours = restore_source_generator(asset);
    if (!is_ours || asset.size() > 1) scene.asset = asset.dump();
    return scene;
}

/// Makes text that contains names from the source a single line.
std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
    return text;
}

/// \param read  returns the file's bytes, or fails
template <class Read>
Result<Scene, ImportError> import_from(const Read& read, ReadableFolders folders, const GltfOptions& options,
                                       Report& report) {
    try {
        return import(read(), std::move(folders), options, report);
    } catch (const Failure& failure) {
        return ImportError{one_line(failure.error.place), one_line(failure.error.message)};
    } catch (const std::bad_alloc&) {
        return ImportError{{}, std::string(kNotEnoughMemory)};
    } catch (const std::exception& error) {
        return ImportError{{}, one_line(std::string("unexpected: ") + error.what())};
    }
}

}  // namespace
}  // namespace gltf

Result<Scene, ImportError> import_gltf(const std::filesystem::path& file, const GltfOptions& options, Report& report) {
    return gltf::import_from([&] { return read_file(file, {}); }, ReadableFolders::of(file, options.root), options,
                             report);
}

Result<Scene, ImportError> import_gltf(std::vector<std::byte> bytes, const std::filesystem::path& file,
                                       const GltfOptions& options, Report& report) {
    return gltf::import_from([&] { return std::move(bytes); }, folders_of_bytes(file, options.root), options, report);
}

}  // namespace bendy::converter
