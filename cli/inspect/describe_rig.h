#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/joint.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::cli {

/// What can be read of a record at the start of a leaf's payload; the rest, and all of it where there is no such leaf,
/// keeps its defaults. For showing files, good or bad.
template <class R>
R record_at(const ChunkTree& tree, std::uint32_t number) {
    R record;
    if (number != kNone && !tree[number].is_container()) copy_at(tree.payload(number), 0, record);
    return record;
}

/// The name of an enumeration's value; "?" for a number that it does not have.
template <std::size_t N>
std::string_view name_at(const std::array<std::string_view, N>& names, std::size_t number) {
    return number < N ? names[number] : "?";
}

/// A constraint in few words, angles in degrees: "hinge 0 to 150 deg, IK only, proposed".
std::string constraint_text(const ConstraintRecord& constraint);

/// The joints, and the names behind the numbers in IKCH, KINF and PULL. Works on any tree, whatever its records hold,
/// in time linear in it; the tree must outlive this.
class RigIndex {
public:
    explicit RigIndex(const ChunkTree& tree);

    /// Of an IKCH: its links with the weights that they have, its solver, and what it reaches for: "hip (0.5) > spine >
    /// head, two-bone, target ball". Of a long chain the middle is left out.
    [[nodiscard]] std::string chain_text(std::uint32_t chunk) const;
    /// Of a KINF: the same, and every number that is not its default.
    [[nodiscard]] std::string chain_info_text(std::uint32_t chunk) const;
    /// A SKIN as it is read, with what JNAM and JNTS say of it; null if there is none.
    [[nodiscard]] const JointView* joint_of(std::uint32_t chunk) const;
    /// Whether anything says where a SKIN rests.
    [[nodiscard]] bool has_rest(std::uint32_t chunk) const;
    /// A SKIN's submeshes, wherever they are stored.
    [[nodiscard]] std::span<const SubmeshView> submeshes_of(std::uint32_t chunk) const;
    /// Of a PULL: "0.5 in LeftArm".
    [[nodiscard]] std::string chain_weight_text(std::uint32_t chunk) const;

private:
    struct Object {
        std::uint32_t chunk = 0;
        SkeletonView skeleton;
        std::vector<std::uint32_t> depths;           ///< of each joint; a root has 0
        std::vector<std::uint32_t> chains;           ///< the IKCH chunks
        std::vector<ChainWeightView> chain_weights;  ///< by chain, then joint
    };

    [[nodiscard]] const Object* object_of(std::uint32_t chunk) const;
    [[nodiscard]] std::string links_text(const Object& object, std::uint32_t chain, const ChainRecord& record) const;

    const ChunkTree* tree_;
    std::vector<Object> objects_;
};

}  // namespace bendy::cli
