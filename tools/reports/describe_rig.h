#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/joint.h>
#include <bendy/format/records.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::tools {

/// Returns as much of the record at the start of a leaf's payload as can be read; the rest keeps its defaults, and all
/// of it if the leaf does not exist. For showing files, valid or not.
template <class R>
R record_at(const ChunkTree& tree, std::uint32_t number) {
    R record;
    if (number != kNone && !tree[number].is_container()) copy_at(tree.payload(number), 0, record);
    return record;
}

/// Returns the name of an enumeration's value; "?" for an unknown number.
template <std::size_t N>
std::string_view name_at(const std::array<std::string_view, N>& names, std::size_t number) {
    return number < N ? names[number] : "?";
}

/// Describes a constraint, with angles in degrees: "hinge 0 to 150 deg, IK only, proposed".
std::string constraint_text(const ConstraintRecord& constraint);

/// Returns the name of a joint, or "joint 12" if it has none.
std::string joint_name(const SkeletonView& skeleton, std::uint32_t joint);

/// The joints, and the names for the numbers in IKCH, KINF and PULL. Works on any tree, whatever its records hold, in
/// time linear in its size; the tree must outlive this.
class RigIndex {
public:
    explicit RigIndex(const ChunkTree& tree);

    /// Describes an IKCH: its links with their weights, its solver, and its target: "hip (0.5) > spine > head,
    /// two-bone, target ball". The middle of a long chain is left out.
    [[nodiscard]] std::string chain_text(std::uint32_t chunk) const;
    /// Describes a KINF in the same way, with every number that is not its default.
    [[nodiscard]] std::string chain_info_text(std::uint32_t chunk) const;
    /// Returns a SKIN, completed from JNAM and JNTS; null if there is none.
    [[nodiscard]] const JointView* joint_of(std::uint32_t chunk) const;
    /// Returns true if the file gives the SKIN's rest transform.
    [[nodiscard]] bool has_rest(std::uint32_t chunk) const;
    /// Returns a SKIN's submeshes, wherever they are stored.
    [[nodiscard]] std::span<const SubmeshView> submeshes_of(std::uint32_t chunk) const;
    /// Returns the role of a SKIN, "left_hand" or "tail 2"; empty if it has none.
    [[nodiscard]] std::string role_of(std::uint32_t chunk) const;
    /// Describes a PULL: "0.5 in LeftArm".
    [[nodiscard]] std::string chain_weight_text(std::uint32_t chunk) const;

private:
    struct Object {
        std::uint32_t chunk = 0;
        SkeletonView skeleton;
        std::vector<std::uint32_t> depths;           ///< by joint; a root has 0
        std::span<const RoleRecord> roles;           ///< ascending by joint
        std::vector<std::uint32_t> chains;           ///< the IKCH chunks
        std::vector<ChainWeightView> chain_weights;  ///< by chain, then joint
    };

    [[nodiscard]] const Object* object_of(std::uint32_t chunk) const;
    [[nodiscard]] std::string links_text(const Object& object, std::uint32_t chain, const ChainRecord& record) const;

    const ChunkTree* tree_;
    std::vector<Object> objects_;
};

}  // namespace bendy::tools
