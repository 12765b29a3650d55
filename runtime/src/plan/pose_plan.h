#pragma once

#include <bendy/format/document.h>
#include <bendy/runtime/palette_matrix.h>
#include <bendy/runtime/transform.h>

#include "blocks.h"
#include "unpack_plan.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Data for posing that is the same for all frames, in the kernels' layout: built once per model.
namespace bendy {

struct Joint;

/// Tracks of one interpolation, grouped for the kernels.
struct SampleGroups {
    std::vector<TrackGroup> rotations;
    std::vector<TrackGroup> vectors;
    std::vector<VectorTrack> tracks;  ///< vectors that would leave most lanes of a group empty

    [[nodiscard]] bool is_empty() const { return rotations.empty() && vectors.empty() && tracks.empty(); }
};

/// Linear tracks of a block of joints, each with times of its own. Lanes without a track have those of another one.
struct TimedGroup {
    TrackGroup tracks;
    const float* times[kBlockJoints];
    std::uint32_t keys[kBlockJoints];  ///< two or more
    bool is_rotation;
};

/// The number of the left key of each lane of a TimedGroup.
using TimedKeys = std::array<std::uint32_t, kBlockJoints>;

/// The tracks of a clip that have the same times. Linear and cubic ones with two keys or more are grouped for the
/// kernels; `others` are sampled one by one.
struct SampleLine {
    const TrackView* clock = nullptr;  ///< any of the tracks: for its times
    SampleGroups linear;
    SampleGroups cubic;
    std::vector<const TrackView*> cubic_tracks;  ///< the same, to be sampled one by one at a key
    std::vector<const TrackView*> others;
};

/// The plan for a clip. About 13 bytes per track; 26 if each has times of its own.
struct SamplePlan {
    std::vector<JointBlock> start;  ///< the joints at rest, with the tracks that are constant; empty: PosePlan::rest
    std::vector<SampleLine> lines;
    std::vector<TimedGroup> timed;
    UnpackPlan packed;  ///< for packed clips, which start at UnpackPlan::start
};

struct PosePlan {
    std::vector<JointBlock> rest;
    std::vector<float> rest_weights;          ///< of the morph targets
    std::vector<std::uint32_t> order;         ///< the joints by depth: a joint's parent comes well before it, and so is
                                              ///< already computed
    std::vector<std::uint32_t> subtree_ends;  ///< for each joint, the number after the last joint below it
    std::vector<std::vector<PaletteMatrix>> inverse_bind;  ///< per mesh; empty if same_palette is another mesh
    std::vector<std::uint32_t> same_palette;  ///< per mesh: the first neighbouring mesh with the same palette
    std::vector<SamplePlan> clips;
    std::size_t most_timed = 0;  ///< groups of a clip
    /// True if floats are accurate enough for joint matrices: no long chains, and no large offsets that cancel.
    bool fits_floats = false;

    [[nodiscard]] bool is_at_or_below(std::uint32_t joint, std::uint32_t ancestor) const {
        return ancestor <= joint && joint < subtree_ends[ancestor];
    }
};

PosePlan make_pose_plan(const ObjectView& object, std::span<const Joint> joints);

}  // namespace bendy
