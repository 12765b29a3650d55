#pragma once

#include "optimise/compact/clip_frames.h"
#include "optimise/compact/quantise_plan.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// Decides to first order whether quantising a clip moves a probe too far. Rounding changes a joint only slightly, so
/// everything below it moves by a linear function of the change. These functions are computed once; a plan then costs a
/// few multiplications per joint and frame, for several frames at a time.
class LinearErrors {
public:
    /// \param plans   of all joints: those that are tried later differ in steps, or are at rest or constant instead
    /// \param aims    per joint, in its space: the points that its rotation corrects, see QuantiseOptions
    /// \param probes  per joint, see find_probes
    LinearErrors(const ClipFrames& frames, std::span<const JointPlan> plans,
                 const std::vector<std::vector<glm::dvec3>>& aims, const std::vector<std::vector<glm::dvec3>>& probes,
                 bool corrects);
    ~LinearErrors();
    LinearErrors(const LinearErrors&) = delete;
    LinearErrors(LinearErrors&&) = delete;
    LinearErrors& operator=(const LinearErrors&) = delete;
    LinearErrors& operator=(LinearErrors&&) = delete;

    /// Quantises the joints first to end - 1, a joint and its descendants, at all frames; true if none of their probes
    /// is farther off than `metres`.
    /// \param plans  of all joints
    bool try_subtree(std::span<const JointPlan> plans, std::size_t first, std::size_t end, double metres);
    /// Call after a success: later calls build on these errors.
    void keep(std::size_t first, std::size_t end);
    /// The number of joints times frames quantised so far.
    [[nodiscard]] std::uint64_t work() const { return work_; }

private:
    struct JointFrames;
    struct Error;
    struct ProbeSet;

    bool try_block(std::span<const JointPlan> plans, std::size_t block, std::size_t first, std::size_t end);
    bool try_block_anywhere(std::span<const JointPlan> plans, std::size_t block, std::size_t first, std::size_t end);
    bool try_block_avx2(std::span<const JointPlan> plans, std::size_t block, std::size_t first, std::size_t end);
    [[nodiscard]] bool is_near(const ProbeSet& probes, const Error& error) const;
    void read_joint(const ClipFrames& frames, std::size_t frame, std::size_t lane, std::size_t joint,
                    std::span<const Affine> pose, const JointPlan& plan, const std::vector<glm::dvec3>& aims,
                    JointFrames& out) const;

    std::size_t joints_;
    std::size_t blocks_ = 0;
    bool corrects_;
    float most_ = 0.0f;                   // square metres
    std::vector<std::uint32_t> parents_;  // per joint
    std::vector<glm::vec3> shears_;       // per joint
    std::vector<ProbeSet> probes_;        // per joint
    std::vector<JointFrames> coefficients_;
    std::vector<Error> kept_, trial_;
    std::vector<std::size_t> order_;  // of blocks: those that failed come first
    std::uint64_t work_ = 0;
};

}  // namespace bendy::converter
