#pragma once

#include "plan/decode_block.h"
#include "plan/pose_block.h"
#include "plan/sample_block.h"
#include "plan/two_bone_block.h"
#include "plan/unpack_block.h"

#include <bendy/format/processor.h>
#include <bendy/format/public.h>

#include <cstdint>

// The functions of one instruction set. Plain data only: see skin_block.h.
namespace bendy {

struct PoseKernels {
    void (*pose)(const PoseBlock& block);  ///< local_to_model
    /// The same for some joints, whose parents are among them or have their matrices in model space; the same bits.
    void (*pose_subtree)(const PoseBlock& block, std::uint32_t first, std::uint32_t end);
    bool (*palette)(const PaletteBlock& block);  ///< model * inverse_bind of each entry; returns whether all are finite
    void (*poses)(const PosesBlock& block);      ///< the same bits as `pose`
    void (*palettes)(const PalettesBlock& block);    ///< the same bits as `palette`
    void (*sample)(const SampleBlock& block);        ///< slerp of rotations along the shorter arc; lerp of vectors
    void (*sample_cubic)(const SampleBlock& block);  ///< cubic Hermite splines, rotations normalised
    /// Each component of a rotation is within 2e-6 of the plain decoder's.
    void (*unpack)(const UnpackBlock& block);
    /// Both: within two units in the last place of the largest number that goes into one.
    void (*decode_boxed)(const BoxedBlock& block);
    void (*decode_directions)(const DirectionsBlock& block);
    void (*mix)(const BlendBlock& block);  ///< blends towards the other pose, rotations normalised
    void (*add)(const BlendBlock& block);  ///< adds the other pose, which is a difference
    /// The same bits as one limb alone; null: limbs are solved one by one.
    void (*two_bones)(TwoBoneBlock& block);
};

/// Whether any kernel has two_bones; otherwise nothing need be built that leads to it.
#if defined(BENDY_X86_64)
inline constexpr bool kSolvesLimbsTogether = true;
#else
inline constexpr bool kSolvesLimbsTogether = false;
#endif

/// Limbs that reach, without regard to limits.
void two_bones_avx2(TwoBoneBlock& block);

/// Returns the functions of the kernel in use; null: the plain one, in double precision.
const PoseKernels* pose_kernels();

extern const PoseKernels kPoseSse4;
extern const PoseKernels kPoseAvx2;
extern const PoseKernels kPoseNeon;
extern const PoseKernels kPoseWasm;

}  // namespace bendy
