#pragma once

#include <bendy/format/codec.h>
#include <bendy/format/document.h>
#include <bendy/format/file.h>
#include <bendy/runtime/model.h>

#include "plan/pose_plan.h"
#include "plan/skin_plan.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace bendy {

/// What moves the vertices of a rigid mesh.
struct RigidMovers {
    std::uint32_t joint = kNone;            ///< of every vertex, if per_vertex is empty: the mesh's own
    std::vector<std::uint32_t> per_vertex;  ///< only for a mesh with polygons of other joints
};

/// A joint's constraints.
struct JointConstraints {
    std::uint32_t in_poses = kNone;  ///< into ModelData::constraints
    std::uint32_t in_ik = kNone;
};

/// What a Model and its copies share.
struct ModelData {
    static const ModelData& of(const Model& model) { return *model.data_; }
    static Result<Model> read(MappedFile file, Bytes bytes, const OpenOptions& options);

    /// Makes what posing and skinning need beside the file's own streams, if it is not there yet.
    void make_plans() const;
    /// Of a clip among the model's; as many as there are, if it is not one of them.
    [[nodiscard]] std::size_t number_of(const Clip& clip) const;
    [[nodiscard]] std::uint32_t rigid_mover(std::uint32_t mesh, std::uint32_t vertex) const {
        const RigidMovers& of_mesh = movers[mesh];
        return of_mesh.per_vertex.empty() ? of_mesh.joint : of_mesh.per_vertex[vertex];
    }

    MappedFile file;
    Bytes bytes;           ///< the whole file: of `file`, or the caller's
    AlignedBytes decoded;  ///< what the file has encoded; the document's views lie in either
    Document document;
    ObjectView object;
    std::vector<Joint> joints;
    std::vector<std::uint32_t> parents;  ///< as joints
    bool is_sheared = false;
    std::vector<Submesh> submeshes;
    std::vector<std::uint64_t> first_vertex;        ///< one more than meshes
    std::vector<std::uint32_t> first_morph_target;  ///< one more than meshes
    std::vector<RigidMovers> movers;                ///< one per mesh
    std::uint32_t largest_palette = 0;
    std::vector<Constraint> constraints;
    std::vector<JointConstraints> joint_constraints;  ///< one per joint, if there are constraints
    std::vector<Chain> chains;
    std::vector<std::uint32_t> chain_order;
    std::vector<ChainWeightView> weights;  ///< by chain, then joint
    std::uint32_t longest_chain = 0;
    std::size_t most_targets = 0;  ///< of a mesh

    mutable std::mutex making_plans;  ///< the first Pose makes them
    mutable std::unique_ptr<const PosePlan> pose_plan;
    mutable std::vector<SkinPlan> skin_plans;  ///< one per mesh
};

}  // namespace bendy
