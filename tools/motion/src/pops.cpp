#include "pops.h"

#include <bendy/motion/retarget_clips.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/sample.h>
#include <bendy/runtime/turn.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace bendy::motion {
namespace {

/// Returns the largest turn of any joint of the source after one of the times, in radians.
double largest_turn(const Model& source, const Clip& clip, std::span<const float> times) {
    Pose before(source), after(source);
    double most = 0.0;
    for (const float time : times) {
        const float later = std::min(clip.end, time + static_cast<float>(kPopSeconds));
        if (!sample(before, &clip, time) || !sample(after, &clip, later)) continue;
        for (std::uint32_t joint = 0; joint < source.joints().size(); ++joint)
            most = std::max(most, turn_between(before.local(joint).rotation, after.local(joint).rotation));
    }
    return most;
}

/// Between two keys a joint turns evenly, so that the quickest moments begin or end with a key.
JointPop quickest(const UnpackedTrack& track, const Clip& clip) {
    const TrackView view = view_of(track);
    const auto at = [&](double seconds) {
        std::array<float, 4> value{};
        sample_track(view, clip, static_cast<float>(seconds), value);
        return glm::quat(value[3], value[0], value[1], value[2]);
    };
    JointPop most{track.joint, 0.0f, 0.0, 0.0};
    for (const double key : track.times) {
        for (const double start : {key - kPopSeconds, key}) {
            const double turn = turn_between(at(start), at(start + kPopSeconds));
            if (turn > most.turn) most = {track.joint, static_cast<float>(start + kPopSeconds), turn, 0.0};
        }
    }
    return most;
}

}  // namespace

TrackView view_of(const UnpackedTrack& track) {
    TrackView view;
    view.path = track.path;
    view.target = track.joint;
    view.components = track.components;
    view.keys = static_cast<std::uint32_t>(track.times.size());
    view.times = track.times;
    view.values = track.values;
    return view;
}

std::vector<JointPop> find_pops(const Model& source, const Clip& clip, std::span<const UnpackedTrack> tracks,
                                std::span<const float> times) {
    std::vector<JointPop> pops;
    for (const UnpackedTrack& track : tracks) {
        if (track.path != TrackPath::rotation) continue;
        const JointPop most = quickest(track, clip);
        if (most.turn > kPopTurn * std::numbers::pi / 180.0) pops.push_back(most);
    }
    if (pops.empty()) return pops;
    const double of_source = largest_turn(source, clip, times);
    for (JointPop& pop : pops) pop.of_source = of_source;
    std::erase_if(pops, [](const JointPop& pop) { return pop.turn <= kPopOfSource * pop.of_source; });
    return pops;
}

}  // namespace bendy::motion
