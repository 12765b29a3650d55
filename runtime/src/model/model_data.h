#pragma once

#include <bendy/format/codec.h>
#include <bendy/format/document.h>
#include <bendy/format/file.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/model.h>

#include "plan/pose_plan.h"
#include "plan/skin_plan.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace bendy {

/// The joints that move the vertices of a rigid mesh.
struct RigidMovers {
    std::uint32_t joint = kNone;            ///< for all vertices, if per_vertex is empty: the joint that carries the
                                            ///< mesh
    std::vector<std::uint32_t> per_vertex;  ///< only for a mesh with submeshes of other joints
};

/// A joint's constraints.
struct JointConstraints {
    std::uint32_t in_poses = kNone;  ///< index into ModelData::constraints
    std::uint32_t in_ik = kNone;
};

/// The data that a Model and its copies share.
struct ModelData {
    static const ModelData& of(const Model& model) { return *model.data_; }
    static Result<Model> read(MappedFile file, Bytes bytes, const OpenOptions& options);

    /// Builds the data that posing and skinning need in addition to the file's streams, if that has not been done yet.
    void make_plans() const;
    /// Returns the index of a clip among the model's clips; their number if it is not one of them. Like `check`,
    /// compares addresses only: a clip of a destroyed model does not belong to another one.
    [[nodiscard]] std::size_t number_of(const Clip* clip) const;
    /// Returns an error unless the model has this very clip or chain: `missing` if it is null, otherwise `other_model`.
    [[nodiscard]] Result<void, CallError> check(const Clip* clip) const;
    [[nodiscard]] Result<void, CallError> check(const Chain* chain) const;
    [[nodiscard]] std::uint32_t rigid_mover(std::uint32_t mesh, std::uint32_t vertex) const {
        const RigidMovers& of_mesh = movers[mesh];
        return of_mesh.per_vertex.empty() ? of_mesh.joint : of_mesh.per_vertex[vertex];
    }

    /// Returns the number of the constraint that IK obeys at a joint; kNone if there is none.
    [[nodiscard]] std::uint32_t ik_constraint(std::uint32_t joint) const {
        return joint_constraints.empty() ? kNone : joint_constraints[joint].in_ik;
    }

    MappedFile file;
    Bytes bytes;           ///< the whole file: of `file`, or the caller's
    AlignedBytes decoded;  ///< decoded leaves; the document's views refer to this or to `bytes`
    Document document;
    ObjectView object;  ///< chain weights ordered by chain, then joint
    std::vector<Joint> joints;
    std::vector<std::uint32_t> parents;  ///< same order as joints
    bool is_sheared = false;
    std::vector<Submesh> submeshes;
    std::vector<std::uint64_t> first_vertex;        ///< one more than meshes
    std::vector<std::uint32_t> first_morph_target;  ///< one more than meshes
    std::vector<RigidMovers> movers;                ///< one per mesh
    std::uint32_t largest_palette = 0;
    std::vector<Constraint> constraints;
    std::vector<glm::dquat> rest_frames;  ///< of each constraint: its joint's rotation at rest, times its frame
    std::vector<JointConstraints> joint_constraints;  ///< one per joint, if there are constraints
    std::vector<std::uint32_t> chain_order;
    std::uint32_t longest_chain = 0;
    std::size_t most_targets = 0;  ///< of a mesh

    mutable std::mutex making_plans;  ///< held while the first Pose builds the plans
    mutable std::unique_ptr<const PosePlan> pose_plan;
    mutable std::vector<SkinPlan> skin_plans;  ///< one per mesh
};

}  // namespace bendy
