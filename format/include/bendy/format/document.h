#pragma once

#include <bendy/format/clip.h>
#include <bendy/format/ik_chain.h>
#include <bendy/format/joint.h>
#include <bendy/format/lod.h>
#include <bendy/format/material.h>
#include <bendy/format/mesh.h>
#include <bendy/format/public.h>
#include <bendy/format/role.h>
#include <bendy/format/standing_pose.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// OBJE: an object, normally the only character in the file.
struct ObjectView {
    std::uint32_t chunk = 0;
    std::string_view name;
    SkeletonView skeleton;
    std::span<const RoleRecord> roles;              ///< ROLE, in place; ascending by joint
    std::optional<StandingPoseView> standing_pose;  ///< STND; absent: the rest pose stands, or nothing is known of it
    std::vector<ChainView> chains;
    std::vector<MeshView> meshes;
    std::optional<CollapseView> collapse;  ///< LODD
    std::vector<ClipView> clips;
    std::string_view extras;
    std::string_view more;  ///< JSON object, or empty
};

/// A whole file as typed views into its bytes.
struct Document {
    std::optional<VersionRecord> version;  ///< absent only if there is a fault
    std::optional<BoundRecord> bound;      ///< of compact encodings; absent in an exact file
    std::vector<TextureView> textures;
    std::vector<MaterialView> materials;  ///< MATE chunks of HEAD, then those of the objects' joints
    std::uint32_t global_materials = 0;   ///< number of those of HEAD
    std::vector<ObjectView> objects;
    std::string_view extras;
    std::string_view extensions;  ///< JSON
    std::string_view more;        ///< JSON object, or empty
};

/// Reads every record of a well-formed tree. Adds a fault for every error in form and for everything that memory safety
/// depends on: misplaced or repeated chunks, record sizes, types, counts, every index. If it adds none, every view,
/// index and range in the result is valid.
Document read_document(const ChunkTree& tree, Faults& faults);

/// Adds the faults of content that do not affect memory safety: see the check_*_values functions.
void check_values(const ChunkTree& tree, const Document& document, Faults& faults);

/// Returns all errors of a file: in its structure (only the first, since the rest cannot be interpreted), its sums, its
/// records and its values. `bytes` must start on a 16-byte boundary.
Faults validate(Bytes bytes);

}  // namespace bendy
