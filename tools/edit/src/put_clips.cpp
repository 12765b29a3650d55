#include "clip_tracks.h"
#include "place_clips.h"

#include <cstddef>

namespace bendy::edit {
namespace {

TrackMap map_of(const Transfer& transfer, const ClipFiles& files) {
    TrackMap map;
    map.joints = transfer.joints;
    map.joint_count = static_cast<std::uint32_t>(files.to().skeleton.joints.size());
    for (std::size_t mesh = 0; mesh < transfer.weights.size(); ++mesh) {
        const Transfer::Weights& weights = transfer.weights[mesh];
        WeightMap& pair = map.weights.emplace_back();
        if (weights.mesh == kNone) continue;
        const MeshView& here = files.to().meshes[weights.mesh];
        pair = {weights.mesh, weights.from, {}, files.from().meshes[mesh].first_frame, here.first_frame};
        for (const MorphTargetView& target : here.targets) pair.at_rest.push_back(target.rest_weight);
    }
    return map;
}

}  // namespace

Edited put_clips(Bytes file, Bytes other, const Transfer& transfer, SameName same_name, Log& log) {
    const auto files = open_clip_files(file, other, log);
    if (!files) return files.error();
    TrackMap map = map_of(transfer, *files);
    std::vector<std::uint32_t> meshes;
    for (const WeightMap& weights : map.weights) meshes.push_back(weights.mesh);
    ClipPlacer placer(*files, transfer.joints, std::move(meshes), same_name, log);
    for (const Transfer::Clip& one : transfer.clips) {
        const ClipView& clip = files->from().clips[one.number];
        for (std::size_t joint = 0; joint < map.joints.size(); ++joint)
            map.joints[joint] = one.kept[joint] ? transfer.joints[joint] : kNone;
        map.added = one.tracks;
        if (const auto counts = placer.change(clip, map); !counts) return counts.error();
        for (const Buffer& curve : one.curves) placer.add_curve(clip, curve);
        const auto placed = placer.put(clip);
        if (!placed) return placed.error();
        log.done.push_back((placed->replaces ? "replaced clip \"" : "retargeted clip \"") + placed->name +
                           "\": " + one.report);
    }
    return placer.finish();
}

}  // namespace bendy::edit
