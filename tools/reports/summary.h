#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/result.h>
#include <bendy/json/json.h>
#include <bendy/runtime/bounds.h>
#include <bendy/runtime/model.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

// A character's contents, most important first, as text or as JSON, for `bendy convert` and `bendy inspect`.
namespace bendy::tools {

/// Names are as in the file: they may be empty, repeated, or contain control characters.
struct Summary {
    struct Named {
        std::string name;
    };
    struct JointLine {
        std::string name;
        std::uint32_t parent = 0;  ///< kNone: a root
    };
    struct ChainLine {
        std::string name, start, effector;  ///< the chain's own name, and the names of two joints
        std::uint32_t links = 0;
    };
    struct MeshLine {
        std::string name;
        std::uint64_t vertices = 0, triangles = 0, lines = 0, points = 0;
        std::uint32_t influences = 0;  ///< the most of any vertex; 0: the mesh is rigid
        std::vector<std::string> morph_targets;
    };
    struct ClipLine {
        std::string name;
        float start = 0.0f, end = 0.0f;  ///< seconds
        bool repeats = false;
    };
    struct ImageLine {
        std::string type;
        std::uint64_t bytes = 0;     ///< in the file
        std::string link;            ///< the URI of an image that is not in the file
        std::uint32_t same = kNone;  ///< the texture that has the image, in the place of this one; kNone: none
    };
    struct TextureLine {
        std::string name;
        std::vector<ImageLine> images;
    };
    struct Level {
        float share = 1.0f;  ///< of the triangles, as requested; 0: as few as possible
        std::uint64_t triangles = 0, vertices = 0;
        float error = 0.0f;  ///< the deviation of the surface in metres; 0: the file does not say
    };

    std::uint64_t bytes = 0;    ///< of the file
    std::uint64_t objects = 1;  ///< in the file; everything else is about the first
    std::string name;           ///< the object's
    std::vector<JointLine> joints;
    std::uint64_t constraints = 0;
    std::vector<ChainLine> chains;
    std::vector<MeshLine> meshes;
    std::vector<Level> levels;  ///< levels of detail, if there are any
    std::vector<ClipLine> clips;
    std::vector<Named> materials;
    std::vector<TextureLine> textures;
    /// In metres, of the rest pose; of the joints if there are no vertices. Empty if there is nothing, or no finite
    /// box.
    Box bounds;
    std::vector<std::pair<std::string, std::uint64_t>> bytes_by_kind;  ///< only kinds that occur
};

/// \param file  the bytes that the model was made from
Summary summarize(const Model& model, Bytes file);

/// Summarises a file without an object: only its size.
Summary summarize_empty(Bytes file);

/// Summarises the first object, or a file without one. \return why the object cannot be opened, if it has faults
/// \param tree  the file's chunks
Result<Summary> summarize_file(const ChunkTree& tree, Bytes file);

/// Returns a kind of count_bytes in words: "POSI" is "positions".
std::string kind_in_words(const std::string& kind);

/// Returns lines for people, after the file's name and size. \param columns  longer lines are folded at commas; 0:
/// never
std::string summary_as_text(const Summary& summary, const std::string& file, std::size_t columns,
                            bool with_bytes_by_kind = true);

/// The same with all names, for programs: docs/cli.md describes it.
OrderedJson summary_as_json(const Summary& summary);

}  // namespace bendy::tools
