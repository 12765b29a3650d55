#pragma once

#include "compact/stored_stream.h"

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bendy::converter {

/// FRMS: what the frames of a mesh have, for each place. Vertices that are together in every frame share one, such as
/// those on both sides of a seam.
struct StoredFrames {
    std::string names;                  ///< a zero behind each; empty if no frame has one
    std::vector<StreamBox> grid;        ///< three a frame
    std::vector<std::uint32_t> places;  ///< of each vertex, by first use
    std::uint32_t place_count = 0;
    StoredStream positions;               ///< frame after frame, a place each; plain
    std::optional<StoredStream> normals;  ///< likewise, numbers of the list
};

/// How a mesh on a grid is stored, exactly.
struct StoredShapes {
    std::vector<glm::vec3> list;                     ///< NLST
    std::optional<StoredStream> positions, normals;  ///< the mesh's own; nothing: as floats
    std::optional<StoredFrames> frames;
};

StoredShapes store_shapes(const Mesh& mesh);

}  // namespace bendy::converter
