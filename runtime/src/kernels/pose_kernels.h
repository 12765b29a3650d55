#pragma once

#include "plan/pose_block.h"
#include "plan/sample_block.h"
#include "plan/unpack_block.h"

// The functions of an instruction set. Nothing but plain numbers: see skin_block.h.
namespace bendy {

struct PoseKernels {
    void (*pose)(const PoseBlock& block);        ///< local_to_model
    bool (*palette)(const PaletteBlock& block);  ///< model * inverse_bind of each entry; whether all are finite
    void (*sample)(const SampleBlock& block);    ///< slerp of rotations, the short way round; lerp of vectors
    /// Within 2e-6 of the plain decoder in each component of a rotation.
    void (*unpack)(const UnpackBlock& block);
    void (*mix)(const BlendBlock& block);  ///< towards the other, rotations normalised
    void (*add)(const BlendBlock& block);  ///< the other is a difference
};

/// Of the kernel in use; null: the plain one, in double precision.
const PoseKernels* pose_kernels();

extern const PoseKernels kPoseSse4;
extern const PoseKernels kPoseAvx2;
extern const PoseKernels kPoseNeon;
extern const PoseKernels kPoseWasm;

}  // namespace bendy
