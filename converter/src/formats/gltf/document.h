#pragma once

#include "check_json.h"
#include "scene/source/named_files.h"
#include "scene/source/source_file.h"
#include "tinygltf.h"

#include <bendy/converter/report.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter::gltf {

/// The two parts of a source file. `json` and `bin` refer to `bytes`.
struct Container {
    std::vector<std::byte> bytes;
    std::string_view json;
    std::span<const std::byte> bin;  ///< the BIN chunk's data
    bool is_glb = false;
    bool has_bin = false;  ///< a BIN chunk exists, possibly empty
};

/// Recognises .glb by its first bytes and splits it; anything else is .gltf. Fails with an empty place.
Container open_container(std::vector<std::byte> bytes);

/// How EXT_meshopt_compression or KHR_meshopt_compression stores a view.
struct CompressedView {
    std::size_t buffer = 0;
    std::uint64_t offset = 0;  ///< bytes
    std::uint64_t length = 0;  ///< bytes
    std::size_t stride = 0;    ///< bytes per decoded element
    std::size_t count = 0;     ///< decoded elements
    std::string mode;
    std::string filter;
    std::string place;  ///< JSON path
};

/// The data of bufferViews. Buffers are loaded immediately (BIN chunk, data URI, file beside the source) and every view
/// is checked against its buffer; compressed views are decoded on first use.
class Buffers {
public:
    /// `container` and `files` must outlive this. Fails at a faulty buffer or view; a buffer without data is an error
    /// only when read (fallback buffers of meshopt compression have none).
    Buffers(const Json& root, const Container& container, NamedFiles& files);

    /// The decoded bytes of a view; `index` must be in range.
    std::span<const std::byte> view(std::size_t index, Budget& budget);

    /// Bytes between the starts of elements, or nothing: tightly packed.
    [[nodiscard]] std::optional<std::size_t> stride(std::size_t index) const;

private:
    struct Buffer {
        std::vector<std::byte> owned;
        std::span<const std::byte> bytes;
        bool has_data = false;
    };
    struct View {
        std::size_t buffer = 0;
        std::uint64_t offset = 0;
        std::uint64_t length = 0;
        std::optional<std::size_t> stride;
        std::optional<CompressedView> compressed;
        std::vector<std::byte> decoded;
        bool is_decoded = false;
    };

    [[nodiscard]] std::span<const std::byte> slice(std::size_t buffer, std::uint64_t offset, std::uint64_t length,
                                                   const std::string& place) const;

    std::vector<Buffer> buffers_;
    std::vector<View> views_;
};

/// A source file, opened and checked; all parts of the importer read from it. The structure comes from `model`;
/// extensions, extras and images from `json`, which has the same element indices.
struct Document {
    NamedFiles& files;
    const Json& json;
    const tinygltf::Model& model;
    Buffers& buffers;
    Budget& budget;
    Report& report;
};

}  // namespace bendy::converter::gltf
