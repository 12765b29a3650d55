#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/palette_matrix.h>

#include <cstddef>
#include <cstdint>

// Input and output of the kernels. Plain data only, since kernels are compiled for other processors than the rest of
// the program: they must not emit inline functions of a shared header.
namespace bendy {

// ---- Blocks of joints

// Where a JointBlock has its numbers, in floats.
inline constexpr std::uint32_t kBlockJoints = 8;  ///< of a block; one number of all of them
inline constexpr std::uint32_t kRotation = 0;
inline constexpr std::uint32_t kTranslation = 4 * kBlockJoints;
inline constexpr std::uint32_t kScale = 7 * kBlockJoints;
inline constexpr std::uint32_t kBlockFloats = 10 * kBlockJoints;

inline constexpr std::uint32_t kAllBits = 0xffff'ffff;  ///< of a mask

/// Tracks that animate one property of the joints of a block, a lane for each joint.
struct TrackGroup {
    const float* keys[kBlockJoints];        ///< of a lane without a track, those of another one; see SampleBlock
    std::uint32_t has_track[kBlockJoints];  ///< kAllBits, or 0
    std::uint32_t count;                    ///< tracks
    std::uint32_t place;                    ///< floats from the first block to the property
};

/// A track of translations or scales.
struct VectorTrack {
    const float* keys;    ///< see SampleBlock
    std::uint32_t place;  ///< floats from the first block to the joint's first number
};

/// Tracks of one interpolation between key `left` and the next one; all of them have both keys. A key is four numbers
/// for a rotation and three for a vector; of a cubic track an in-tangent, a value and an out-tangent.
struct SampleBlock {
    const TrackGroup* rotations;
    std::size_t rotation_groups;
    const TrackGroup* vectors;
    std::size_t vector_groups;
    const VectorTrack* tracks;  ///< more vectors, one by one
    std::size_t track_count;
    std::size_t left;
    float fraction;  ///< 0 to 1
    float seconds;   ///< from `left` to the next key; for cubic tracks only
    float* local;    ///< blocks of joints
};

/// Tracks with times of their own, at one moment.
struct TimedBlock {
    const TrackGroup* group;          ///< but for its keys
    const float* keys[kBlockJoints];  ///< of each lane, the left key, which the right one follows
    float left[kBlockJoints];         ///< their times
    float right[kBlockJoints];
    float seconds;  ///< before `left`, the left key counts; after `right`, the right one
    bool is_rotation;
    float* local;  ///< blocks of joints
};

/// Blends transforms into others, joint by joint.
struct BlendBlock {
    std::size_t joints;
    float* local;        ///< blocks of joints
    const float* other;  ///< as local
    float weight;
    const float* mask;  ///< one per joint; null: 1
};

// ---- Packed clips

/// Up to eight animated tracks that are stored together in each frame, one per lane. Lanes beyond `count` decode to
/// arbitrary values.
struct UnpackGroup {
    static constexpr std::uint32_t kLanes = 8;
    float rest[4][kLanes]{};         ///< rotation: x y z w, unit; otherwise three numbers
    float steps[3][kLanes]{};        ///< by component; 0 beyond `count`
    std::uint32_t places[kLanes]{};  ///< floats from the first block of joints to the property's first number
    bool is_rotation = true;
    std::uint32_t count = 0;       ///< tracks
    std::uint32_t components = 3;  ///< 1 or 3
    std::uint32_t bases = 0;       ///< bytes from the segment's tables to the first component's first base
    std::uint32_t stride = 0;      ///< bytes from there to the next component's
    std::uint32_t base_bytes = 2;  ///< 2 or 4
    std::uint32_t parts = 0;       ///< blocks of joints that the tracks animate
};

/// The tracks of a group that animate joints of one block.
struct UnpackPart {
    std::int32_t lanes[UnpackGroup::kLanes];       ///< for each joint of the block, the group's lane with its track
    std::uint32_t has_track[UnpackGroup::kLanes];  ///< kAllBits, or 0
    std::uint32_t place;                           ///< floats from the first block to the property
};

/// The location of one component of a group in the frames of a segment: four numbers in each of two windows of sixteen
/// bytes. In each lane the number is the 32 bits from byte `bytes` of its window on, shifted left and then right.
struct UnpackWindows {
    std::uint32_t low = 0;  ///< bytes from the frame's start to the window of lanes 0 to 3
    std::uint32_t high = 0;
    std::uint8_t bytes[UnpackGroup::kLanes]{};
    std::uint8_t left[UnpackGroup::kLanes]{};
    std::uint8_t right[UnpackGroup::kLanes]{};  ///< 32: the number has no bits
};

/// A packed clip at one moment.
struct UnpackBlock {
    const UnpackGroup* groups;
    std::size_t group_count;
    const UnpackPart* parts;       ///< by group
    const UnpackWindows* windows;  ///< by group, then component
    const unsigned char* tables;
    const unsigned char* left;   ///< the left frame
    const unsigned char* right;  ///< the right frame; at the end, the same as left
    const unsigned char* end;    ///< of the payload
    float fraction;
    bool is_near_end;  ///< reading kReadPast bytes beyond a frame or a table could leave the payload
    float* local;      ///< blocks of joints; at rest where a track animates
    static constexpr std::size_t kReadPast = 32;
    static constexpr float kMaxHalfTurnSquare = 10.89f;  ///< of a rotation vector
};

// ---- Joint matrices and palettes

struct PoseBlock {
    std::size_t joints;
    const float* local;            ///< blocks of joints; no shear
    const std::uint32_t* parents;  ///< of each joint; 2^32 - 1: a root
    const std::uint32_t* order;    ///< all joints, parents before children; neighbours are not ancestors of one another
    float* model;                  ///< sixteen per joint, column-major: joint space to model space; for whole blocks
};

/// Poses of one model, a lane for each.
struct PosesBlock {
    static constexpr std::size_t kPoses = 8;

    std::size_t joints;
    const float* local[kPoses];  ///< as in PoseBlock; may be the same one several times
    const std::uint32_t* parents;
    float* model;  ///< kMatrixLanes per joint: the upper three rows of joint space to model space, number by number
};

inline constexpr std::size_t kMatrixLanes = 12 * PosesBlock::kPoses;  ///< numbers of one joint in PosesBlock::model

struct PaletteBlock {
    std::size_t entries;
    const float* model;           ///< as above
    const std::uint32_t* joints;  ///< of each entry
    const PaletteMatrix* inverse_bind;
    PaletteMatrix* palette;
};

/// The palettes of the poses in a PosesBlock.
struct PalettesBlock {
    std::size_t entries;
    const float* model;                          ///< of a PosesBlock
    const std::uint32_t* joints;                 ///< of each entry
    const PaletteMatrix* inverse_bind;           ///< null: the joints' own matrices
    PaletteMatrix* palette[PosesBlock::kPoses];  ///< of each pose; the same one where the poses are the same
};

// ---- Limbs that reach

/// Limbs of two bones and their targets: of each number, one for each limb. Flags are 0 or 1.
template <std::size_t limbs>
struct alignas(8 * limbs) TwoBoneLimbs {
    double base_x[3][limbs], base_y[3][limbs], base_z[3][limbs];  ///< axes of the start's parent, in model space
    double base_origin[3][limbs];
    double target[3][limbs];       ///< in model space
    double pole[3][limbs];         ///< in model space if is_pole_point, otherwise a direction in the parent's space
    double upper[4][limbs];        ///< local rotation of the start: x y z w
    double lower[4][limbs];        ///< of the middle joint
    double origin[3][limbs];       ///< local translation of the start
    double middle[3][limbs];       ///< of the middle joint
    double tip[3][limbs];          ///< of the tip
    double upper_scale[3][limbs];  ///< local scale of the start
    double lower_scale[3][limbs];  ///< of the middle joint
    double axis[3][limbs];  ///< if is_fixed: the only axis about which the middle joint bends, in the start's space
    double same_scale[1][limbs];  ///< how far the scales of a joint's axes may differ, as a share of them
    double tolerance[1][limbs];   ///< metres; 0: a share of the limb's length
    double softness[1][limbs];    ///< share of the limb's length over which it slows near full reach
    double roll[2][limbs];        ///< cosine and sine of the angle from the pole to the bend
    double has_pole[1][limbs], is_pole_point[1][limbs], is_rolled[1][limbs];
    double has_limits[1][limbs];
    double is_fixed[1][limbs];
    double prefers_back[1][limbs];  ///< bends against the axis, where both ways are the same turn
};

struct TwoBoneBlock {
    static constexpr std::size_t kLimbs = 4;

    TwoBoneLimbs<kLimbs> limbs;  ///< any numbers where there is none
    double upper[4][kLimbs];     ///< solved, of nearly unit length
    double lower[4][kLimbs];
    double distance[kLimbs];      ///< metres between tip and target; negative: not solved
    double out_of_reach[kLimbs];  ///< 1: the target is farther away than the limb is long
};

// ---- Streams of compact files

struct Integers {
    const void* data;  ///< aligned to their size only
    std::uint32_t bytes;
    bool is_signed;  ///< of one or two bytes; those of four are unsigned
};

/// Numbers in boxes: minimum + step * integer.
struct BoxedBlock {
    static constexpr std::size_t kPattern = 24;  ///< a multiple of all vectors' components and all kernels' lanes

    Integers integers;
    std::size_t numbers;
    float minimum[kPattern], step[kPattern];  ///< of the first numbers, and so on
    float* to;
};

/// Successive entries of a morph target that displace successive vertices.
struct MorphRun {
    std::uint32_t entry, vertex, count;
};

/// Adds weight * displacement to vectors.
struct DisplaceBlock {
    const MorphRun* runs;
    std::size_t count;
    float weight;
    float* to;                  ///< of vertex 0
    std::size_t width;          ///< floats of a vertex: 3, or 4, of which the last one stays
    const float* floats;        ///< x y z of each entry; null: minimum + step * integer
    Integers integers;          ///< of one or two bytes
    float minimum[3], step[3];  ///< of x y z
};

/// Unit vectors from points of the unfolded octahedron: see decode_octahedral.
struct DirectionsBlock {
    Integers integers;  ///< signed, of one or two bytes
    std::size_t count;
    std::size_t width;  ///< integers of an element: 2; or 3, with a handedness
    float* to;          ///< x y z of each element, and its handedness
};

// ---- Skinning

/// The destination of one attribute: the numbers of vertex v are at data[v * stride]. Null: not wanted.
struct SkinOutput {
    float* data;
    std::size_t stride;  ///< floats, at least the number of components
};

/// A range of a mesh's vertices. All pointers are aligned to their element type only, and nothing beyond the last
/// vertex is read or written.
struct SkinBlock {
    std::size_t vertices;
    const PaletteMatrix* palette;  ///< finite
    const std::uint8_t* bones8;    ///< influences per vertex; less than the palette's size
    const std::uint16_t* bones16;  ///< used instead of bones8; both null: palette[0] moves all vertices
    const float* weights;          ///< same layout as bones
    std::size_t influences;
    /// Null, or for each group of eight vertices, the index of its first bone in plan_bones; one more than groups. A
    /// group without bones there uses the arrays above. Ignored by kernels of four lanes.
    const std::uint32_t* plan_first;
    const std::uint16_t* plan_bones;
    const float* plan_weights;    ///< eight for each of plan_bones, 32-byte aligned
    const float* positions;       ///< 3 per vertex; not null if the output is wanted
    const float* normals;         ///< 3 per vertex
    const std::int8_t* normals8;  ///< null, or used instead of normals by eight lanes: 2 per vertex, on the octahedron
    const float* tangents;        ///< 4 per vertex
    SkinOutput out_positions, out_normals, out_tangents;
    bool streams;  ///< the output is large: write past the caches where its alignment allows
};

/// A rigid motion as a unit dual quaternion; each part is x y z w.
struct DualMotion {
    float real[4], dual[4];
};

/// Vertices for skinning by dual quaternions: v -> scale * (blended motion of (blended stretch of v)).
struct DualBlock {
    SkinBlock vertices;         ///< with bones and weights; `palette`: the stretches, null if nothing is stretched
    const DualMotion* motions;  ///< finite
    float scale;
};

using SkinKernel = void(const SkinBlock& block);
using DualKernel = void(const DualBlock& block);

/// A number of vertices that exceeds the caches.
inline constexpr std::size_t kManyVertices = std::size_t{1} << 18u;

}  // namespace bendy
