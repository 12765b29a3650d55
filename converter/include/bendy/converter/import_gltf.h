#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace bendy::converter {

struct GltfOptions {
    /// Scene to take: its name or its index in decimal digits; empty: the file's default scene, else the first, else
    /// all root nodes.
    std::optional<std::string> scene;
    /// false: images that the source keeps in files of their own stay there and are referred to by URI.
    bool embed_images = true;
    /// Make a joint, with meshes of its own, of every instance of EXT_mesh_gpu_instancing. Else their numbers are kept
    /// as data, and a node draws its mesh once.
    bool instances = false;
};

/// Reads a .gltf or .glb file (told apart by content) with the files that it refers to, checks all of it, and fills a
/// Scene. What the Scene cannot hold is named in `report`. Throws nothing; every number in the result is finite and
/// every index in range.
Result<Scene, ImportError> import_gltf(const std::filesystem::path& file, const GltfOptions& options, Report& report);

/// The same of a file's bytes. \param file  beside which other files are looked for
Result<Scene, ImportError> import_gltf(std::vector<std::byte> bytes, const std::filesystem::path& file,
                                       const GltfOptions& options, Report& report);

}  // namespace bendy::converter
