#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/lod.h>
#include <bendy/runtime/palette_matrix.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/transform.h>
#include <bendy/runtime/vertices.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Many characters of one model, played on the caller's threads. Crowd starts no threads: the caller's thread pool
// splits the members into ranges and plays each range as one of `workers`, never two ranges as the same worker at the
// same time. With TBB:
//
//     bendy::Crowd crowd(*model, tbb::this_task_arena::max_concurrency());
//     tbb::parallel_for(tbb::blocked_range<std::size_t>(0, members.size(), 32), [&](const auto& range) {
//         const auto part = members.subspan(range.begin(), range.size());
//         if (!crowd.play(part, tbb::this_task_arena::current_thread_index())) is_too_short = true;
//     });
namespace BENDY_PUBLIC bendy {

/// One character of a crowd: what it plays and where the output goes. Members must not share outputs.
struct CrowdMember {
    const Clip* clip = nullptr;        ///< of the crowd's model; null: the rest pose
    float seconds = 0.0f;              ///< on the clip's time line, as for sample
    const Lod* lod = nullptr;          ///< writes only the vertices of that level; members may share one; null: all
    VertexBuffer out;                  ///< vertices of all meshes, as for skin; empty: not wanted
    std::span<PaletteMatrix> palette;  ///< Crowd::palette_size() matrices, for skinning elsewhere; empty: not wanted
};

/// The work memory of a crowd: the size of some ten poses per worker, and nothing per member. Playing allocates
/// nothing.
class Crowd {
public:
    /// Number of members whose palettes are computed together, a SIMD lane for each. Ranges of multiples are fastest.
    static constexpr std::size_t kAtOnce = 8;

    /// \param workers  maximum number of ranges played at the same time: the size of the thread pool; at least 1
    explicit Crowd(const Model& model, std::size_t workers = 1);

    [[nodiscard]] const Model& model() const { return model_; }
    [[nodiscard]] std::size_t workers() const { return poses_.size(); }

    /// Samples, poses and skins each of the members. The output does not depend on how members are split or which
    /// worker plays them. Where an output of a member is too short, that output is not written, but all others are. Of
    /// a member with a clip or a level of another model, or with NaN seconds, nothing is written. The first such error
    /// is returned. \param worker  0 to workers() - 1, not in use by another call at the same time; otherwise
    /// out_of_range is returned
    [[nodiscard]] Result<void, CallError> play(std::span<const CrowdMember> members, std::size_t worker = 0);

    /// As above, but the caller sets the pose: blends clips, solves IK chains. pose_member(member, pose) must set the
    /// whole pose, which holds values of other members, and leave it a pose of the crowd's model; the members' clips
    /// and times are not used.
    template <class PoseMember>
    [[nodiscard]] Result<void, CallError> play(std::span<const CrowdMember> members, std::size_t worker,
                                               const PoseMember& pose_member) {
        return play_each(members, worker, [&](const CrowdMember& member, Pose& pose) -> Result<void, CallError> {
            pose_member(member, pose);
            if (pose.model() == model_) return {};
            pose = Pose(model_);  // the caller has put another one there
            return CallError::other_model;
        });
    }

    /// Number of matrices of all meshes together, and the index of a mesh's first one. A skinned mesh has one for each
    /// entry of its bind palette, in order; neighbouring meshes with the same bind palette share them. A rigid mesh has
    /// one, of the joint that moves its first vertex. For a mesh that does not exist, the index is palette_size().
    [[nodiscard]] std::size_t palette_size() const { return first_entry_.back(); }
    [[nodiscard]] std::size_t first_entry(std::uint32_t mesh) const {
        return mesh < first_entry_.size() ? first_entry_[mesh] : palette_size();
    }

private:
    /// Posed members whose palettes are still to be computed.
    struct Batch {
        std::array<PaletteMatrix*, kAtOnce> palettes{};
        std::size_t count = 0;
    };
    /// A joint's, of the members of a batch.
    struct alignas(64) JointMatrices {
        std::array<float, 12 * kAtOnce> numbers;
    };

    /// As `play`; pose_member returns an error for a member that is not to be written.
    template <class PoseMember>
    Result<void, CallError> play_each(std::span<const CrowdMember> members, std::size_t worker,
                                      const PoseMember& pose_member) {
        if (worker >= poses_.size()) return CallError::out_of_range;
        Result<void, CallError> result;
        batches_[worker].count = 0;
        for (const CrowdMember& member : members) {
            Result<void, CallError> written = pose_member(member, poses_[worker]);
            if (written) written = write(member, worker);
            if (result && !written) result = written;
        }
        write_batch(worker);
        return result;
    }

    Result<void, CallError> write(const CrowdMember& member, std::size_t worker);
    void write_batch(std::size_t worker);
    void write_palette(Pose& pose, PaletteMatrix* palette) const;

    Model model_;
    std::vector<Pose> poses_;     // one per worker
    std::vector<Batch> batches_;  // one per worker
    // Both for each worker in turn, and empty if members are computed one by one.
    std::vector<std::vector<JointBlock>> locals_;  // of the members of the batches
    std::vector<JointMatrices> model_space_;
    std::vector<std::size_t> first_entry_;  // one per mesh, and the total
};

}  // namespace bendy
