#include "clip_frames.h"

#include "scene/evaluate.h"
#include "scene/frame_shapes.h"
#include "scene/rest_frames.h"

#include <algorithm>
#include <cstddef>

namespace bendy::converter {
namespace {

/// The pose of a clip at a time; properties that are not animated rest.
std::vector<Transform> pose_at(const Scene& scene, const Clip& clip, double seconds) {
    std::vector<Transform> locals = rest_of(scene);
    std::vector<double> value;
    for (const Track& track : clip.tracks) {
        if (track.path == TrackPath::weights || track.target >= locals.size()) continue;
        evaluate_track(track, seconds, value);
        Transform& local = locals[track.target];
        const auto number = [&](std::size_t k) { return static_cast<float>(value[k]); };
        if (track.path == TrackPath::rotation) {
            local.rotation = {number(0), number(1), number(2), number(3)};
        } else {
            (track.path == TrackPath::translation ? local.translation : local.scale) = {number(0), number(1),
                                                                                        number(2)};
        }
    }
    return locals;
}

}  // namespace

void visit_frames(const Scene& scene, const std::function<void(std::vector<Transform>)>& visit) {
    constexpr std::size_t kMostFrames = 240;
    constexpr std::size_t kMostOfClip = 24;
    constexpr std::size_t kMostJoints = 2'000'000;  // in all frames together
    std::size_t frames = std::min(kMostFrames, kMostJoints / std::max<std::size_t>(scene.joints.size(), 1));
    for (const Clip& clip : scene.clips) {
        if (clip.tracks.empty() || !clip.packed.empty()) continue;  // packed tracks are not in `tracks`
        const ClipSpan span = span_of(clip);
        const std::size_t steps = span.end > span.start ? kMostOfClip : 1;
        for (std::size_t step = 0; step < steps && frames > 0; ++step, --frames) {
            const double share = steps == 1 ? 0.0 : static_cast<double>(step) / static_cast<double>(steps - 1);
            visit(pose_at(scene, clip, span.at(share)));
        }
    }
}

}  // namespace bendy::converter
