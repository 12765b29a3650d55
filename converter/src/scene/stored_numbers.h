#pragma once

#include <bendy/converter/scene.h>
#include <bendy/format/byte_reader.h>
#include <bendy/format/mesh.h>
#include <bendy/format/records.h>

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter {

/// Numbers in the type in which they will be stored. Unconverted numbers are not copied: their source must outlive
/// this.
struct StoredNumbers {
    StoredNumbers(ComponentType stored_as, bool fractions, Bytes as_they_are)
        : type(stored_as), normalised(fractions), bytes(as_they_are) {}
    StoredNumbers(ComponentType stored_as, bool fractions, std::vector<std::byte> made)
        : type(stored_as), normalised(fractions), own(std::move(made)), bytes(own) {}
    StoredNumbers(StoredNumbers&&) = default;  // a moved vector keeps its bytes in place
    StoredNumbers& operator=(StoredNumbers&&) = default;
    StoredNumbers(const StoredNumbers&) = delete;
    StoredNumbers& operator=(const StoredNumbers&) = delete;
    ~StoredNumbers() = default;

    ComponentType type;
    bool normalised;
    std::vector<std::byte> own;  ///< empty if the numbers are unconverted
    Bytes bytes;
};

/// The narrowest of u8 and u16 (normalised, 0 to 1) that represents all of these floats exactly; otherwise f32.
StoredNumbers smallest_exact_fractions(std::span<const float> values);

/// Indices as u8 if `count` fits and `allow_bytes`, else u16 or u32.
StoredNumbers smallest_exact_indices(std::span<const std::uint32_t> values, std::uint64_t count, bool allow_bytes);

/// A stream's integers as stored in the file.
struct StoredStream {
    ComponentType type = ComponentType::u8;
    Numbers numbers = Numbers::boxed;
    std::uint32_t components = 0;
    std::vector<StreamBox> boxes;  ///< one per component if numbers are boxed, else none
    std::vector<std::byte> bytes;  ///< elements * components integers
    bool is_octahedral = false;

    [[nodiscard]] std::size_t row() const { return std::size_t{components} * component_size(type); }
    /// The stream as a reader sees it.
    [[nodiscard]] StreamView view() const {
        StreamView view;
        view.type = type;
        view.normalised = numbers == Numbers::normalised;
        view.components = components;
        view.elements = static_cast<std::uint32_t>(bytes.size() / row());
        view.data = bytes;
        view.boxes = boxes;
        view.is_octahedral = is_octahedral;
        return view;
    }
};

/// FRMS: the frames of a mesh, per place. Vertices that coincide in every frame share a place, such as those on both
/// sides of a seam.
struct StoredFrames {
    std::string names;                  ///< NUL-terminated; empty if no frame has one
    std::vector<StreamBox> grid;        ///< three per frame
    std::vector<std::uint32_t> places;  ///< per vertex, numbered by first use
    std::uint32_t place_count = 0;
    StoredStream positions;               ///< frame after frame, one element per place; plain
    std::optional<StoredStream> normals;  ///< likewise, as indices into the list
};

/// The exact storage of a mesh on a grid.
struct StoredShapes {
    std::vector<glm::vec3> list;                     ///< NLST
    std::optional<StoredStream> positions, normals;  ///< of the mesh itself; nothing: as floats
    std::optional<StoredFrames> frames;
};

StoredShapes store_shapes(const Mesh& mesh);

}  // namespace bendy::converter
