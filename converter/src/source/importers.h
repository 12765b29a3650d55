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

/// A kind of file that `convert` reads.
struct Importer {
    SourceFormat format;
    std::string_view name;                          ///< with its article
    std::string_view signature;                     ///< what such a file begins with; empty: a text without one
    std::array<std::string_view, 2> suffixes = {};  ///< of file names, lower case; others are empty
    bool takes_scene = false;                       ///< has scenes to choose from
    bool takes_ticks = false;                       ///< counts its times in ticks
    bool takes_texture = false;                     ///< has one skin, which may be in any file
    /// \param file  what the bytes are called, and beside which other files are looked for
    Result<Scene, ImportError> (*import)(std::vector<std::byte> bytes, const std::filesystem::path& file,
                                         const ConvertOptions& options, Report& report);
};

/// All that this build reads, one row for each kind.
std::span<const Importer> importers();

/// The first row of a format that this build reads.
const Importer& importer_of(SourceFormat format);

}  // namespace bendy::converter
