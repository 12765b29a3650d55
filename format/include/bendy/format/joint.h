#pragma once

#include <bendy/format/constraint.h>
#include <bendy/format/error.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

// SKIN: a joint; joints are nested as the skeleton is. PIVO: data of the joint itself. POLY: its submeshes.
namespace BENDY_PUBLIC bendy {

/// A range of a mesh's index list that belongs to a joint.
struct SubmeshView {
    std::uint32_t chunk = 0;
    std::uint32_t joint = 0;
    std::uint32_t mesh = 0;
    std::uint32_t material = kNone;  ///< as in the file: see SubmeshRecord
    Topology topology = Topology::triangles;
    std::uint32_t first = 0;  ///< index into the mesh's INDX
    std::uint32_t count = 0;
};

/// The weight of a joint in an IK chain (not yet checked against the chains).
struct ChainWeightView : ChainWeightRecord {
    std::uint32_t chunk = 0;
    std::uint32_t joint = 0;
};

struct JointView {
    std::uint32_t chunk = 0;
    std::uint32_t parent = kNone;  ///< smaller than the joint's own number; kNone: a root
    std::string_view name;
    RestRecord rest;
    std::string_view extras;
    std::string_view extensions;  ///< JSON
    std::string_view more;        ///< JSON object, or empty
};

/// The joints of an OBJE in pre-order, which is joint order, with their data, ordered by joint; submesh ranges are not
/// yet checked against the meshes.
struct SkeletonView {
    std::vector<JointView> joints;
    std::uint32_t table = kNone;  ///< JNTS
    std::vector<SubmeshView> submeshes;
    std::vector<ConstraintView> constraints;
    std::vector<ChainWeightView> chain_weights;
    std::vector<std::uint32_t> local_materials;       ///< MATE chunks inside SKIN, in file order
    std::vector<std::uint32_t> first_local_material;  ///< for each joint, index into local_materials
};

/// Reads the SKIN tree of an OBJE chunk, without recursion.
SkeletonView read_skeleton(const ChunkTree& tree, std::uint32_t object, Faults& faults);

/// Returns for each joint the number of joints above it.
std::vector<std::uint32_t> depths_of(std::span<const JointView> joints);

/// Adds faults of content: rest transforms that are not finite, rotations that are not unit quaternions, invalid
/// constraints (check_constraint) and invalid weights in IK chains.
void check_skeleton_values(const ChunkTree& tree, const SkeletonView& skeleton, Faults& faults);

}  // namespace bendy
