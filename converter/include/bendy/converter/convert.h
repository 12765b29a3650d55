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
    /// Where the result will be written: links to images are made relative to its folder. Empty: beside the source.
    std::filesystem::path output;
    GltfOptions gltf;  ///< for glTF sources, embed_images and root for others too; a scene chosen in others is an error
    /// X-files only, see XOptions; 0: use the file's value. An error for other sources.
    double ticks_per_second = 0.0;
    /// Quake II models only, see Md2Options; empty: the file's own skin. An error for other sources.
    std::filesystem::path texture;
    /// Biovision files only: metres, see BvhOptions; 0: a centimetre. An error for other sources.
    double unit = 0.0;
    /// Biovision files only. An error for other sources, unless `found`.
    SourceUp up = SourceUp::found;
    /// Turn the character about Y by a multiple of 90 degrees so that it faces +Z.
    bool faces_front = false;
    /// Merge clips that move different properties, see docs/convert.md.
    bool merge_clips = false;
    /// A rig file (spec/rig.md): its constraints and chains override those of the source.
    std::optional<std::filesystem::path> rig;
    /// The rig file's text, if it has been read already; `rig` is then used only as its name.
    std::optional<std::string> rig_text;
    /// Propose IK chains and limits from the joints' names, the skeleton's shape and the clips, see spec/rig.md; the
    /// report lists the proposals.
    bool auto_rig = false;
    /// Bind each vertex of a mesh without a skin to the nearest bone, see docs/convert.md; the report notes how many
    /// vertices went to how many joints.
    bool auto_skin = false;
    /// For auto_skin, if not empty: use only this joint and its descendants as bones; a name, or `#` and a number.
    std::string skeleton;
    /// Leave out per-vertex data that no material uses, such as texture coordinates, and merge the vertices that then
    /// differ in nothing; see docs/convert.md. The report lists what was left out.
    bool drop_unused = false;
    /// The caller wants exact numbers: do not suggest --compact for a compact source.
    bool exact = false;
    /// Encode for size: no point of the skin moves further than this. Nothing: exact.
    std::optional<ErrorBound> compact;
    /// If not empty, called with the fraction done, 0 to 1, by one thread at a time. An exception from it ends
    /// `convert`.
    std::function<void(double)> progress;
    /// Compute the sequence in which vertices collapse (LODD), and order the vertices by it.
    bool lod = false;
    /// Keep the source's vertex order. Otherwise vertices that follow the same bones are stored next to each other
    /// where that makes skinning faster, with the numbers that they have in the source. Ignored with `lod` and
    /// `compact`, which order the vertices in any case.
    bool keep_order = false;
    /// Maximum number of threads for this file, including the caller's, at least 1. The bytes do not depend on it. Only
    /// `compact` uses more than one.
    unsigned threads = 1;
};

/// Converts a glTF file, a bendy file, an X-file, a Quake II model or a Biovision file (recognised by content) to the
/// bytes of a bendy file. The result passes bendy::validate; `report` lists what it does not hold and the files that
/// were read. Throws nothing. Keeps no state between calls: threads may convert concurrently.
Result<std::vector<std::byte>, ImportError> convert(const std::filesystem::path& file, const ConvertOptions& options,
                                                    Report& report);

/// As above, from the bytes of a source, for example read from a pipe.
/// \param name  name of the source; files that it refers to are looked for in its folder. Without a folder, see
///              GltfOptions::root
Result<std::vector<std::byte>, ImportError> convert(std::vector<std::byte> source, const std::filesystem::path& name,
                                                    const ConvertOptions& options, Report& report);

}  // namespace bendy::converter
