#pragma once

#include <bendy/converter/convert.h>
#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/converter/source_format.h>
#include <bendy/format/result.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace bendy::converter {

/// An input format of `convert`.
struct Importer {
    SourceFormat format;
    std::string_view name;                          ///< with its article
    std::string_view signature;                     ///< the first bytes of such a file; empty: text without a signature
    std::array<std::string_view, 3> suffixes = {};  ///< of file names, lower case; unused entries are empty
    bool takes_scene = false;                       ///< has several scenes to choose from
    bool takes_ticks = false;                       ///< measures time in ticks
    bool takes_texture = false;                     ///< has one skin, which may be in any file
    bool takes_unit = false;                        ///< does not say how long its unit is
    /// \param file  name of the bytes; other files are looked for in its folder
    Result<Scene, ImportError> (*import)(std::vector<std::byte> bytes, const std::filesystem::path& file,
                                         const ConvertOptions& options, Report& report);
};

/// All formats that this build reads.
std::span<const Importer> importers();

/// The first entry for a format that this build reads.
const Importer& importer_of(SourceFormat format);

}  // namespace bendy::converter
