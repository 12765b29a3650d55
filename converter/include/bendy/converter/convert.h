#pragma once

#include <bendy/converter/error_bound.h>
#include <bendy/converter/import.h>
#include <bendy/converter/report.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace bendy::converter {

struct ConvertOptions {
    /// Where the result will be written: links to images are relative to its folder. Empty: beside the source.
    std::filesystem::path output;
    GltfOptions gltf;  ///< for glTF sources, embed_images and root for others too; a scene chosen in others is an error
    /// For X-files, see XOptions; 0: as the file says. An error for other sources.
    double ticks_per_second = 0.0;
    /// For Quake II models, see Md2Options; empty: the file's own skin. An error for other sources.
    std::filesystem::path texture;
    /// Clips that move different properties become one, see docs/convert.md.
    bool merge_clips = false;
    /// A rig file (spec/rig.md): constraints and chains that go before what the source says.
    std::optional<std::filesystem::path> rig;
    /// The rig file's text, where it has been read already; `rig` is then only its name.
    std::optional<std::string> rig_text;
    /// Propose IK chains and limits by the joints' names, see spec/rig.md; what is proposed is listed in the report.
    bool auto_rig = false;
    /// Bind each vertex of meshes without a skin to the bone that is nearest, see docs/convert.md; how many went to how
    /// many joints is noted with the proposals.
    bool auto_skin = false;
    /// For auto_skin, where not empty: the bones are this joint and all below it; a name, or `#` and a number.
    std::string skeleton;
    /// Encode for size: no point of the skin moves further than this. Nothing: exact.
    std::optional<ErrorBound> compact;
    /// Empty, or told the share that is done, 0 to 1, by one thread at a time. What it throws ends `convert`.
    std::function<void(double)> progress;
    /// Compute the sequence in which vertices are collapsed (LODD), and order the vertices by it.
    bool lod = false;
    /// Put vertices that follow the same bones beside one another, so that skinning takes less. Ignored with `lod` and
    /// `compact`, which have orders of their own.
    bool sort_vertices = false;
    /// How many threads may work on this file, 1 at least, the caller's among them. The bytes do not depend on
    /// it. Only `compact` has work for more than one.
    unsigned threads = 1;
};

/// Converts a glTF file, a bendy file, an X-file or a Quake II model (told by its content) to the bytes of a bendy
/// file. The result passes bendy::validate; what it does not hold is named in `report`, with the files that were read.
/// Throws nothing. Keeps nothing between calls: threads may convert side by side.
Result<std::vector<std::byte>, ImportError> convert(const std::filesystem::path& file, const ConvertOptions& options,
                                                    Report& report);

/// The same of a source's bytes, as they come from a pipe. \param name  of the source, with a folder in front beside
/// which the files that it refers to are looked for; without one, the bytes have no folder, see GltfOptions::root
Result<std::vector<std::byte>, ImportError> convert(std::vector<std::byte> source, const std::filesystem::path& name,
                                                    const ConvertOptions& options, Report& report);

}  // namespace bendy::converter
