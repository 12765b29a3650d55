#pragma once

#include "plan/blocks.h"

#include <bendy/format/processor.h>
#include <bendy/format/public.h>

#include <cstdint>

// The functions of one instruction set. Plain data only: see blocks.h.
namespace bendy {

enum class Kernel : std::uint8_t;

struct KernelTable {
    /// Within 8 units in the last place of the largest product that contributes to a number (relative to unit length,
    /// for normals and tangents that do not cancel).
    SkinKernel* skin;
    DualKernel* dual;                      ///< the same
    void (*pose)(const PoseBlock& block);  ///< local_to_model
    /// The same for some joints, whose parents are among them or have their matrices in model space; the same bits.
    void (*pose_subtree)(const PoseBlock& block, std::uint32_t first, std::uint32_t end);
    bool (*palette)(const PaletteBlock& block);  ///< model * inverse_bind of each entry; returns whether all are finite
    void (*poses)(const PosesBlock& block);      ///< the same bits as `pose`
    void (*palettes)(const PalettesBlock& block);    ///< the same bits as `palette`
    void (*sample)(const SampleBlock& block);        ///< slerp of rotations along the shorter arc; lerp of vectors
    void (*sample_timed)(const TimedBlock& block);   ///< the same, each lane between its own keys
    void (*sample_cubic)(const SampleBlock& block);  ///< cubic Hermite splines, rotations normalised
    /// Each component of a rotation is within 2e-6.
    void (*unpack)(const UnpackBlock& block);
    /// These: within four units in the last place of the largest number that goes into one.
    void (*decode_boxed)(const BoxedBlock& block);
    void (*decode_directions)(const DirectionsBlock& block);
    void (*displace)(const DisplaceBlock& block);
    void (*mix)(const BlendBlock& block);  ///< blends towards the other pose, rotations normalised
    void (*add)(const BlendBlock& block);  ///< adds the other pose, which is a difference
    /// The same bits as one limb alone; null: limbs are solved one by one.
    void (*two_bones)(TwoBoneBlock& block);
    bool flushes_denormals;  ///< treats denormal numbers as zero: see FlushDenormals
};

/// Whether any kernel has eight lanes; otherwise the code that only these use need not be built.
#if defined(BENDY_X86_64)
inline constexpr bool kHasEightLanes = true;
#else
inline constexpr bool kHasEightLanes = false;
#endif
/// Whether any kernel has two_bones.
inline constexpr bool kSolvesLimbsTogether = kHasEightLanes;

/// Solves limbs without regard to limits.
void two_bones_avx2(TwoBoneBlock& block);

/// Returns the functions of one of kernels().
const KernelTable& kernel_table(Kernel kernel);
/// Returns those of the kernel in use.
const KernelTable& kernel_table();

extern const KernelTable kPlainTable;
extern const KernelTable kSse4Table;
extern const KernelTable kAvx2Table;
extern const KernelTable kNeonTable;
extern const KernelTable kWasmTable;

}  // namespace bendy
