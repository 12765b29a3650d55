// All kernels of an instruction set and their table, included after lanes_*.h and read_*.h by one source for each,
// which also defines kFlushesDenormals, kTwoBones, and kHasForms: code of their own for the attributes that are usually
// wanted.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

#include "joint_lanes.h"
#include "store_lanes.h"

#include "blend_lanes.h"
#include "decode_lanes.h"
#include "displace_lanes.h"
#include "pose_lanes.h"
#include "poses_lanes.h"
#include "sample_lanes.h"
#include "skin_lanes.h"
#include "unpack_lanes.h"

#include "dual_lanes.h"

constexpr KernelTable kTable{
    .skin = kHasForms ? skin_lanes : skin_as<AnyForm>,
    .dual = kHasForms ? dual_lanes : dual_as<AnyForm>,
    .pose = pose_lanes,
    .pose_subtree = pose_subtree_lanes,
    .palette = palette_lanes,
    .poses = poses_lanes,
    .palettes = palettes_lanes,
    .sample = sample_lanes,
    .sample_timed = sample_timed_lanes,
    .sample_cubic = sample_cubic_lanes,
    .unpack = unpack_lanes,
    .decode_boxed = decode_boxed_lanes,
    .decode_directions = decode_directions_lanes,
    .displace = displace_lanes,
    .mix = blend_lanes<mix_joints>,
    .add = blend_lanes<add_joints>,
    .two_bones = kTwoBones,
    .flushes_denormals = kFlushesDenormals,
};

// NOLINTEND(misc-definitions-in-headers)
