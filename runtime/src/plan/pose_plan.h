#pragma once

#include <bendy/format/document.h>
#include <bendy/runtime/palette_matrix.h>
#include <bendy/runtime/transform.h>

#include "sample_block.h"
#include "unpack_plan.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// What posing takes that no frame changes, as kernels want it: made once for a model.
namespace bendy {

struct Joint;

/// The tracks of a clip that share their times. Linear ones of two keys or more are grouped for the kernels; `others`
/// are sampled one by one.
struct SampleLine {
    const TrackView* clock = nullptr;  ///< any of the tracks: for its times
    std::size_t rotation_tracks = 0;
    std::vector<RotationTracks> rotations;
    std::vector<VectorTrack> vectors;
    std::vector<const TrackView*> others;
};

/// Of a clip. About 12 bytes for each rotation track, 16 for each translation or scale.
struct SamplePlan {
    std::vector<SampleLine> lines;
    UnpackPlan packed;  ///< if it is packed
};

struct PosePlan {
    std::vector<JointTransform> rest;
    std::vector<float> rest_weights;   ///< of the morph targets
    std::vector<std::uint32_t> order;  ///< the joints by depth: a joint's parent is far before it, and so already there
    std::vector<std::vector<PaletteMatrix>> inverse_bind;  ///< of each mesh; empty where same_palette is another one
    std::vector<std::uint32_t> same_palette;  ///< of each mesh: the first of its neighbours with its palette
    std::vector<SamplePlan> clips;
    /// Floats are exact enough for joint matrices: no long chains, and nothing far away that cancels.
    bool fits_floats = false;
};

PosePlan make_pose_plan(const ObjectView& object, std::span<const Joint> joints);

}  // namespace bendy
