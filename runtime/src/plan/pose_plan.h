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

// Data for posing that is the same for all frames, in the kernels' layout: built once per model.
namespace bendy {

struct Joint;

/// The plan for a clip. Linear tracks with two keys or more are for the kernels: about 18 bytes each, more where only
/// some joints of a block have one. `others` are sampled one by one, in the clip's order.
struct SamplePlan {
    std::vector<const TrackView*> clocks;  ///< for each moment, any of the tracks with its times
    std::vector<TrackGroup> rotations, vectors;
    std::vector<VectorTrack> tracks;
    std::vector<const TrackView*> others;
    UnpackPlan packed;  ///< for packed clips
};

struct PosePlan {
    std::vector<JointBlock> rest;
    std::vector<float> rest_weights;   ///< of the morph targets
    std::vector<std::uint32_t> order;  ///< the joints by depth: a joint's parent comes well before it, and so is
                                       ///< already computed
    std::vector<std::vector<PaletteMatrix>> inverse_bind;  ///< per mesh; empty if same_palette is another mesh
    std::vector<std::uint32_t> same_palette;               ///< per mesh: the first mesh with the same palette
    std::vector<std::uint32_t> first_entry;  ///< per mesh: of its palette, among the entries of all palettes
    std::uint32_t palette_entries = 0;       ///< of all palettes, each counted once
    std::vector<SamplePlan> clips;
    std::size_t most_clocks = 0;  ///< of any clip
    /// True if floats are accurate enough for joint matrices: no long chains, and no large offsets that cancel.
    bool fits_floats = false;
};

PosePlan make_pose_plan(const ObjectView& object, std::span<const Joint> joints);

}  // namespace bendy
