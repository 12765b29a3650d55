#pragma once

#include "rewrite.h"

#include <bendy/format/document.h>
#include <bendy/format/packed_clip.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bendy::edit {

/// How a mesh's weights tracks change.
struct WeightMap {
    std::uint32_t mesh = kNone;       ///< kNone: the tracks are removed
    std::vector<std::uint32_t> from;  ///< for each new target, the old target; kNone: none
    std::vector<float> at_rest;       ///< the weight of a target without an old one
    std::uint32_t first_frame = 0;    ///< MeshView::first_frame, old and new
    std::uint32_t first_frame_there = 0;
};

/// Where the tracks of a clip go, indexed by the joints and meshes of the object that contains it now.
struct TrackMap {
    std::vector<std::uint32_t> joints;  ///< kNone: its tracks are removed
    std::uint32_t joint_count = 0;      ///< of the destination object
    std::vector<bool> decoded;          ///< joints whose packed tracks become ordinary ones; empty: none
    std::vector<WeightMap> weights;     ///< by mesh
    std::vector<UnpackedTrack> added;   ///< of joints or, for weights, meshes of the destination
};

struct TrackCounts {
    std::uint32_t stay = 0, go = 0, decoded = 0;
};

/// Changes the clip's TRAK, PACK, PLAY, TIME and KEYV according to the map. Chunks that need no change keep their
/// bytes. Returns a problem if tracks share their values in a way that would make the file much larger.
Result<TrackCounts, Problem> remap_tracks(const ChunkTree& tree, const ObjectView& object, const ClipView& clip,
                                          const TrackMap& map, Rewrite& rewrite);

}  // namespace bendy::edit
