#pragma once

#include <bendy/converter/import_gltf.h>
#include <bendy/converter/report.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace bendy::converter {

struct ConvertOptions {
    GltfOptions gltf;
    /// A rig file (spec/rig.md): constraints and chains that go before what the source says.
    std::optional<std::filesystem::path> rig;
    /// Propose IK chains and limits by the joints' names, see spec/rig.md; what is proposed is listed in the report.
    bool auto_rig = false;
    /// Compute the sequence in which vertices are collapsed (LODD), and order the vertices by it.
    bool lod = false;
};

/// Converts a glTF file to the bytes of a bendy file. The result passes bendy::validate; what it does not hold is named
/// in `report`. Throws nothing.
Result<std::vector<std::byte>, ImportError> convert(const std::filesystem::path& file, const ConvertOptions& options,
                                                    Report& report);

}  // namespace bendy::converter
