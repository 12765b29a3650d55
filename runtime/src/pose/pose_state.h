#pragma once

#include <bendy/runtime/palette_matrix.h>
#include <bendy/runtime/pose.h>

#include "active_target.h"
#include "ik_link.h"
#include "model/model_data.h"
#include "plan/blocks.h"
#include "plan/layout.h"
#include "plan/pose_plan.h"
#include "stale_joints.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace bendy {

struct KernelTable;

/// The work memory for skinning by dual quaternions.
struct DualMotions {
    explicit DualMotions(const Model& model);

    std::vector<glm::dvec3> places;  ///< for each palette entry, the joint's position in mesh space at bind time
    std::vector<std::uint32_t> first_place;  ///< for each mesh, index into places
    std::vector<DualMotion> motions;         ///< of the mesh that is being skinned, by palette entry
    std::vector<PaletteMatrix> stretches;    ///< before them
    double scale = 1.0;
    bool is_stretched = false;
    bool are_good = false;  ///< all of `motions` are finite
};

/// The data of a Pose. Two of them never share a cache line, since each is written by its own thread.
struct alignas(64) PoseState {
    struct alignas(64) JointMatrix {  // on its own cache line
        glm::mat4 matrix;
    };
    static_assert(sizeof(JointMatrix) == sizeof(glm::mat4));

    static PoseState& of(Pose& pose) { return *pose.state_; }
    static const PoseState& of(const Pose& pose) { return *pose.state_; }

    explicit PoseState(const Model& from);

    void set_rest() { set_start(data->pose_plan->rest); }
    /// Sets the local transforms, and the weights of morph targets to those at rest.
    void set_start(std::span<const JointBlock> from);
    [[nodiscard]] std::uint32_t joint_count() const { return static_cast<std::uint32_t>(data->joints.size()); }
    [[nodiscard]] JointTransform local_of(std::uint32_t joint) const { return joint_in(local, joint); }
    void set_local(std::uint32_t joint, const JointTransform& transform) {
        mark_stale(joint);
        set_joint_in(local, joint, transform);
    }
    void set_rotation(std::uint32_t joint, const glm::quat& rotation) {
        mark_stale(joint);
        local[joint / JointBlock::kJoints].set_rotation(joint % JointBlock::kJoints, rotation);
    }
    void mark_stale(std::uint32_t joint) { stale.mark({joint, data->pose_plan->subtree_ends[joint]}); }
    /// Computes model_space from the local transforms, parents before children, where these may have changed.
    void refresh() {
        if (!stale.is_empty()) find_model_space();
    }
    /// Returns the matrix from joint space to model space; identity for kNone.
    [[nodiscard]] glm::dmat4 fresh_matrix(std::uint32_t joint) {
        if (joint == kNone) return glm::dmat4(1.0);
        if (stale.has(joint)) find_model_space();
        return exact_matrix(joint);
    }
    /// The same for a joint that is not stale, as accurate as find_model_space computed it.
    [[nodiscard]] glm::dmat4 exact_matrix(std::uint32_t joint) const {
        return is_exact ? exact_model_space[joint] : glm::dmat4(model_space[joint].matrix);
    }
    /// Sets `palette` for a skinned mesh, unless it is set already. Returns whether all numbers are finite. The pose
    /// must not be stale.
    bool make_palette(std::uint32_t mesh);
    /// Writes the palette of a skinned mesh elsewhere, one matrix for each of its entries. The pose must not be stale.
    void write_palette(std::uint32_t mesh, std::span<PaletteMatrix> out) const;
    /// Sets `palette` for vertices moved by one joint. The pose must not be stale.
    void make_rigid_palette(std::uint32_t joint);

    Model model;
    const ModelData* data;  ///< of `model`
    std::vector<JointBlock> local;
    std::vector<JointMatrix> model_space;       ///< one per lane of `local`
    std::vector<glm::dmat4> exact_model_space;  ///< if is_exact
    std::vector<float> morph_weights;
    std::vector<TimedKeys> timed_keys;  ///< of each SamplePlan::timed, those of the last sample: where to look first
    std::vector<ActiveTarget> active_targets;  ///< of the mesh that is being skinned; room for any mesh's targets
    std::vector<IkLink> ik_links;              ///< of the chain that reaches
    std::vector<PaletteMatrix> palette;        ///< of the mesh that is being skinned; never empty
    std::uint32_t palette_mesh = kNone;        ///< whose palette is
    bool is_palette_finite = false;
    bool is_exact;      ///< in doubles, since floats would lose digits of this model's poses: see PosePlan::fits_floats
    StaleJoints stale;  ///< whose matrices in model_space do not have the local transforms' latest changes
    std::optional<DualMotions> dual;  ///< set once the pose has been skinned by dual quaternions

private:
    void find_model_space();
    void find_subtree(const StaleJoints::Subtree& subtree, const KernelTable& kernels);
    void find_exactly(const StaleJoints::Subtree& subtree);
    /// Returns whether all numbers are finite.
    bool compute_palette(std::uint32_t mesh, PaletteMatrix* out) const;
};

}  // namespace bendy
