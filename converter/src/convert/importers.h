#pragma once

#include <bendy/converter/convert.h>
#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/converter/source_format.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace bendy::converter {

/// How `convert` reads one format.
struct Importer {
    SourceFormat format;
    bool takes_scene = false;    ///< has several scenes to choose from
    bool takes_ticks = false;    ///< measures time in ticks
    bool takes_texture = false;  ///< has one skin, which may be in any file
    bool takes_unit = false;     ///< does not say how long its unit is
    /// \param file  name of the bytes; other files are looked for in its folder
    Result<Scene, ImportError> (*import)(std::vector<std::byte> bytes, const std::filesystem::path& file,
                                         const ConvertOptions& options, Report& report);
};

/// The importer of a format that this build reads.
const Importer& importer_of(SourceFormat format);

}  // namespace bendy::converter
