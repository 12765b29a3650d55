#include "frame_shapes.h"

#include <cmath>
#include <limits>

namespace bendy::converter {

Track weights_track(const Scene& scene, const Clip& clip, const Play& play) {
    const Mesh& mesh = scene.meshes[play.mesh];
    const std::size_t targets = mesh.targets.size();
    const std::uint32_t keys = play.frames + (play.closed ? 1 : 0);
    Track track;
    track.path = TrackPath::weights;
    track.target = play.mesh;
    track.components = static_cast<std::uint32_t>(targets);
    track.values.reserve(keys * targets);
    for (std::uint32_t key = 0; key < keys; ++key) {
        const auto time = static_cast<float>(clip.frame_start + key / double{clip.frame_rate});
        const bool ascends = track.times.empty() || time > track.times.back();
        track.times.push_back(ascends ? time
                                      : std::nextafter(track.times.back(), std::numeric_limits<float>::infinity()));
        for (const MorphTarget& target : mesh.targets)
            track.values.push_back(target.is_frame ? 0.0f : target.rest_weight);
        const std::uint32_t frame = play.first + key % play.frames;
        if (frame != 0) track.values[key * targets + first_frame(mesh) + frame - 1] = 1.0f;
    }
    return track;
}

}  // namespace bendy::converter
