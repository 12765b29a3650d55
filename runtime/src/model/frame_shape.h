#pragma once

#include <bendy/format/mesh.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

// Frames (FRMS) among a mesh's targets. They hold shapes, not displacements: with weights w the mesh's own streams have
// weight 1 - sum w. So a frame with full weight gives exactly what the file holds, whatever the mesh's own shape is.
namespace bendy {

/// Returns the weight that the frames leave to the mesh's own streams.
inline float rest_share(const MeshView& mesh, std::span<const float> weights) {
    double frames = 0.0;
    for (std::size_t k = mesh.first_frame; k < mesh.targets.size(); ++k) frames += double{weights[k]};
    return static_cast<float>(1.0 - frames);
}

/// Returns true if frames have the given stream.
inline bool have_frames(const MeshView& mesh, std::optional<StreamView> MorphTargetView::*stream) {
    return mesh.first_frame < mesh.targets.size() && (mesh.targets.back().*stream).has_value();
}

/// Scales the mesh's own vectors by the weight that the frames leave to them.
template <class Vector>
void lighten(float share, std::span<Vector> vectors) {
    if (share == 1.0f) return;
    for (Vector& vector : vectors) {
        vector.x *= share;
        vector.y *= share;
        vector.z *= share;
    }
}

/// Adds the frame's vectors of vertices [first, first + vectors).
template <class Vector>
void add_frame(const StreamView& places, const StreamView& shape, float weight, std::size_t first,
               std::span<Vector> vectors) {
    const auto add = [&](std::size_t at, float x, float y, float z) {
        vectors[at].x += weight * x;
        vectors[at].y += weight * y;
        vectors[at].z += weight * z;
    };
    const auto with_places = [&](const auto& visit) {
        if (places.type == ComponentType::u8) {
            visit(places.as<std::uint8_t>().subspan(first, vectors.size()));
        } else if (places.type == ComponentType::u16) {
            visit(places.as<std::uint16_t>().subspan(first, vectors.size()));
        } else {
            visit(places.as<std::uint32_t>().subspan(first, vectors.size()));
        }
    };
    with_places([&](const auto& place) {
        if (!shape.boxes.empty() && shape.type == ComponentType::u8) {  // as in Quake II
            const StreamBox x = shape.boxes[0];
            const StreamBox y = shape.boxes[1];
            const StreamBox z = shape.boxes[2];
            const std::span<const std::uint8_t> steps = shape.as<std::uint8_t>();
            for (std::size_t at = 0; at < vectors.size(); ++at) {
                const std::size_t from = std::size_t{place[at]} * 3;
                add(at, x.minimum + x.step * static_cast<float>(steps[from]),
                    y.minimum + y.step * static_cast<float>(steps[from + 1]),
                    z.minimum + z.step * static_cast<float>(steps[from + 2]));
            }
            return;
        }
        for (std::size_t at = 0; at < vectors.size(); ++at) {
            const glm::vec3 vector = shape.vec3(place[at]);
            add(at, vector.x, vector.y, vector.z);
        }
    });
}

}  // namespace bendy
