#pragma once

#include <bendy/converter/export_options.h>
#include <bendy/converter/report.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace bendy::converter {

/// A glTF 2.0 asset: JSON text, and the bytes of its one buffer.
struct GltfAsset {
    std::string json;
    std::vector<std::byte> buffer;  ///< may be empty; the asset has no buffer then
};

/// Reads a bendy file and writes it as glTF 2.0: nodes with the joints' numbers, meshes, skins, morph targets,
/// animations, materials and textures; constraints and IK chains as a rig file (spec/rig.md) in the scene's extras,
/// where import_gltf's caller finds them. Floats are kept to the bit, so that the result converts to the same chunks.
/// What glTF cannot hold is named in `report`. Throws nothing.
/// \param buffer_file  where the buffer will be, relative to the JSON; empty: in the same GLB file
Result<GltfAsset, ImportError> export_gltf(const std::filesystem::path& bendy_file,
                                           const std::filesystem::path& buffer_file, Report& report,
                                           const ExportOptions& options = {});

/// The same from memory; `bytes` start on a 16-byte boundary.
Result<GltfAsset, ImportError> export_gltf(Bytes bytes, const std::filesystem::path& buffer_file, Report& report,
                                           const ExportOptions& options = {});

/// The asset as one GLB file. Fails where it would pass the container's 4 GiB.
Result<std::vector<std::byte>, ImportError> make_glb(const GltfAsset& asset);

}  // namespace bendy::converter
