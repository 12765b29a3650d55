#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/write_rig.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace bendy::converter {

struct ExportOptions {
    /// One level of detail of a file that has a collapse sequence: how many vertices of each mesh to keep, as in
    /// Lod::vertices. Empty: all.
    std::vector<std::uint32_t> vertices;
    /// Where the result will be written: links to images are made relative to its folder. Empty: beside the bendy file.
    std::filesystem::path output = {};
};

/// A glTF 2.0 asset: JSON text, and the bytes of its one buffer.
struct GltfAsset {
    std::string json;
    std::vector<std::byte> buffer;  ///< may be empty; the asset then has no buffer
};

/// Reads a bendy file and writes it as glTF 2.0: nodes with the joints' numbers, meshes, skins, morph targets,
/// animations, materials and textures; constraints and IK chains as extensions of our own (spec/gltf.md). Floats are
/// kept bit for bit, so that the result converts to the same chunks. `report` lists everything that glTF cannot hold.
/// Throws nothing. \param buffer_file  where the buffer will be, relative to the JSON; empty: in the same GLB file
Result<GltfAsset, ImportError> export_gltf(const std::filesystem::path& bendy_file,
                                           const std::filesystem::path& buffer_file, Report& report,
                                           const ExportOptions& options = {});

/// As above, from memory; `bytes` must be 16-byte aligned.
Result<GltfAsset, ImportError> export_gltf(Bytes bytes, const std::filesystem::path& buffer_file, Report& report,
                                           const ExportOptions& options = {});

/// The asset as one GLB file. Fails if it would exceed the container's 4 GiB.
Result<std::vector<std::byte>, ImportError> make_glb(const GltfAsset& asset);

/// The text of an X-file, and the images that must be written beside it.
struct XAsset {
    struct File {
        std::string name;  ///< relative to the X-file
        std::vector<std::byte> bytes;
    };
    std::string text;
    std::vector<File> images;
};

/// Reads a bendy file and writes it as a DirectX X-file in text (`xof 0303txt 0032`): frames, meshes with SkinWeights,
/// materials, animation sets; constraints and IK chains in our own templates (spec/xfile.md). The space is mirrored
/// along Z, as X-files are left-handed. `report` lists everything that X-files cannot hold. Throws nothing.
/// \param image_stem  embedded images are named `image_stem` and a number
Result<XAsset, ImportError> export_x(const std::filesystem::path& bendy_file, const std::string& image_stem,
                                     Report& report, const ExportOptions& options = {});

/// As above, from memory; `bytes` must be 16-byte aligned.
Result<XAsset, ImportError> export_x(Bytes bytes, const std::string& image_stem, Report& report,
                                     const ExportOptions& options = {});

}  // namespace bendy::converter
