#include "passes/collapse_vertices.h"

#include "collapse/find_shapes.h"
#include "collapse/level_table.h"
#include "collapse/lock_shared_borders.h"
#include "collapse/order_vertices.h"
#include "collapse/sequence.h"
#include "collapse/surface.h"

#include <cstddef>
#include <vector>

namespace bendy::converter {

void collapse_vertices(Scene& scene) {
    const std::vector<std::vector<Shape>> shapes = find_shapes(scene);
    std::vector<Surface> surfaces;
    surfaces.reserve(scene.meshes.size());
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        surfaces.push_back(make_surface(scene.meshes[mesh], shapes[mesh]));
        // One for all that are alike: else triangles between doubles would stay when they have no area any more.
        for (Part& part : scene.meshes[mesh].parts) {
            for (std::uint32_t& index : part.indices) index = surfaces.back().alike[index];
        }
    }
    lock_shared_borders(shapes, surfaces);
    std::vector<Sequence> sequences;
    sequences.reserve(surfaces.size());
    for (std::size_t mesh = 0; mesh < surfaces.size(); ++mesh) {
        sequences.push_back(find_sequence(scene.meshes[mesh], shapes[mesh], std::move(surfaces[mesh])));
    }
    for (std::size_t mesh = 0; mesh < sequences.size(); ++mesh) order_vertices(scene.meshes[mesh], sequences[mesh]);
    scene.levels = make_levels(scene.meshes, sequences);
}

}  // namespace bendy::converter
