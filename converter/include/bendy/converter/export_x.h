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

/// An X-file's text, and the images that must lie beside it.
struct XAsset {
    struct File {
        std::string name;  ///< relative to the X-file
        std::vector<std::byte> bytes;
    };
    std::string text;
    std::vector<File> images;
};

/// Reads a bendy file and writes it as a DirectX X-file in text (`xof 0303txt 0032`): frames, meshes with SkinWeights,
/// materials, animation sets; constraints and IK chains in templates of our own (spec/xfile.md). The space is mirrored
/// along Z, as X-files are left-handed. What X-files cannot hold is named in `report`. Throws nothing.
/// \param image_stem  images that the file embeds are called `image_stem` and a number
Result<XAsset, ImportError> export_x(const std::filesystem::path& bendy_file, const std::string& image_stem,
                                     Report& report, const ExportOptions& options = {});

/// The same from memory; `bytes` start on a 16-byte boundary.
Result<XAsset, ImportError> export_x(Bytes bytes, const std::string& image_stem, Report& report,
                                     const ExportOptions& options = {});

}  // namespace bendy::converter
