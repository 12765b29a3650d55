#pragma once

#include <bendy/runtime/palette_matrix.h>
#include <bendy/runtime/pose.h>

#include "active_target.h"
#include "ik_link.h"
#include "math/joint_blocks.h"
#include "model/model_data.h"
#include "plan/sample_block.h"
#include "plan/skin_block.h"
#include "plan/stretched_motion.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace bendy {

/// The work memory for skinning by dual quaternions.
struct DualMotions {
    explicit DualMotions(const Model& model);

    std::vector<glm::dvec3> places;  ///< for each palette entry, the joint's position in mesh space at bind time
    std::vector<std::uint32_t> first_place;  ///< for each mesh, index into places
    std::vector<StretchedMotion> motions;    ///< of the mesh that is being skinned, by palette entry
    std::vector<DualMotion> kernel_motions;
    std::vector<PaletteMatrix> kernel_stretches;
    double scale = 1.0;
    bool is_stretched = false;
    bool are_good = false;    ///< all of `motions` are finite
    bool has_kernel = false;  ///< kernel_motions correspond to `motions`
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

    void set_rest();
    [[nodiscard]] std::uint32_t joint_count() const { return static_cast<std::uint32_t>(data->joints.size()); }
    [[nodiscard]] JointTransform local_of(std::uint32_t joint) const { return joint_in(local, joint); }
    void set_local(std::uint32_t joint, const JointTransform& transform) {
        is_stale = true;
        set_joint_in(local, joint, transform);
    }
    void set_rotation(std::uint32_t joint, const glm::quat& rotation) {
        is_stale = true;
        local[joint / JointBlock::kJoints].set_rotation(joint % JointBlock::kJoints, rotation);
    }
    /// Computes model_space from the local transforms, parents before children, if these may have changed.
    void refresh() {
        if (is_stale) find_model_space();
    }
    void find_model_space();
    /// Returns the matrix from joint space to model space, as accurate as find_model_space computed it.
    [[nodiscard]] glm::dmat4 exact_matrix(std::uint32_t joint) const {
        return is_exact ? exact_model_space[joint] : glm::dmat4(model_space[joint].matrix);
    }
    /// Makes the palette of a skinned mesh, unless it is made already. Returns whether all numbers are finite. The pose
    /// must not be stale.
    bool make_palette(std::uint32_t mesh);
    [[nodiscard]] std::span<const PaletteMatrix> palette_of(std::uint32_t mesh) const {
        return std::span(palettes).subspan(data->pose_plan->first_entry[mesh],
                                           data->object.meshes[mesh].palette.joints.size());
    }
    /// Sets rigid_palette for vertices moved by one joint. Returns whether all numbers are finite. The pose must not be
    /// stale.
    bool make_rigid_palette(std::uint32_t joint);

    Model model;
    const ModelData* data;  ///< of `model`
    std::vector<JointBlock> local;
    std::vector<JointMatrix> model_space;       ///< one per lane of `local`
    std::vector<glm::dmat4> exact_model_space;  ///< if is_exact
    std::vector<float> morph_weights;
    std::vector<SampleMoment> moments;         ///< of the clip that is being sampled
    std::vector<ActiveTarget> active_targets;  ///< of the mesh that is being skinned; room for any mesh's targets
    std::vector<IkLink> ik_links;              ///< of the chain that reaches
    enum class PaletteStatus : std::uint8_t { stale, finite, not_finite };
    std::vector<PaletteMatrix> palettes;          ///< one after another: see PosePlan::first_entry
    std::vector<PaletteStatus> palette_statuses;  ///< per mesh; used of the first with the same palette
    PaletteMatrix rigid_palette{};
    bool is_exact = true;             ///< in doubles, so that rounding does not accumulate along deep chains
    bool is_stale = true;             ///< a local transform may have changed since find_model_space
    std::optional<DualMotions> dual;  ///< set once the pose has been skinned by dual quaternions
};

}  // namespace bendy
