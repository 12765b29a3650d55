#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/lod.h>
#include <bendy/runtime/palette_matrix.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/vertices.h>

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Many characters of one model, on as many threads as the caller has. There are no threads in here: a thread mesh of
// the caller's splits the members into ranges and plays each range as one of `workers`, two ranges at a time never as
// the same one. With TBB:
//
//     bendy::Crowd crowd(*model, tbb::this_task_arena::max_concurrency());
//     tbb::parallel_for(tbb::blocked_range<std::size_t>(0, members.size(), 8), [&](const auto& range) {
//         const auto part = members.subspan(range.begin(), range.size());
//         if (!crowd.play(part, tbb::this_task_arena::current_thread_index())) is_too_short = true;
//     });
namespace BENDY_PUBLIC bendy {

/// One character of a crowd: what it plays and where that is to be written. Members must not share what is written.
struct CrowdMember {
    const Clip* clip = nullptr;        ///< of the crowd's model; null: the rest pose
    float seconds = 0.0f;              ///< on the clip's own time line, as for sample
    const Lod* lod = nullptr;          ///< vertices of that level only; members may share one; null: all
    VertexBuffer out;                  ///< all meshes' vertices, as for skin; empty: not wanted
    std::span<PaletteMatrix> palette;  ///< Crowd::palette_size() matrices, for skinning elsewhere; empty: not wanted
};

/// The work memory of a crowd: a Pose for each worker, and nothing for each member. Playing allocates nothing.
class Crowd {
public:
    /// \param workers  how many ranges are played at a time at most: the mesh's threads; at least 1
    explicit Crowd(const Model& model, std::size_t workers = 1);

    [[nodiscard]] const Model& model() const { return model_; }
    [[nodiscard]] std::size_t workers() const { return poses_.size(); }

    /// Samples, poses and skins each of the members. What comes out does not depend on how members are split or which
    /// worker plays them. Where the memory of a member is too short, that is not written, and all else is; the first
    /// such error is returned. \param worker  0 to workers() - 1, and no other call's at the same time
    [[nodiscard]] Result<void, CallError> play(std::span<const CrowdMember> members, std::size_t worker = 0);

    /// The same where the caller poses: blends clips, lets chains reach. pose_member(member, pose) sets the whole
    /// pose, which is as the worker's last member left it; the members' clips and times are the caller's to read.
    template <class PoseMember>
    [[nodiscard]] Result<void, CallError> play(std::span<const CrowdMember> members, std::size_t worker,
                                               const PoseMember& pose_member) {
        assert(worker < poses_.size());
        Result<void, CallError> result;
        for (const CrowdMember& member : members) {
            pose_member(member, poses_[worker]);
            const Result<void, CallError> written = write(member, poses_[worker]);
            if (result && !written) result = written;
        }
        return result;
    }

    /// Matrices of all meshes together, mesh after mesh, and where a mesh's begin: its bind palette's entries, in
    /// order; of a rigid mesh one, that of the joint which moves its first vertex.
    [[nodiscard]] std::size_t palette_size() const { return first_entry_.back(); }
    [[nodiscard]] std::size_t first_entry(std::uint32_t mesh) const { return first_entry_[mesh]; }

private:
    Result<void, CallError> write(const CrowdMember& member, Pose& pose) const;
    void write_palette(Pose& pose, std::span<PaletteMatrix> palette) const;

    Model model_;
    std::vector<Pose> poses_;               // of each worker
    std::vector<std::size_t> first_entry_;  // of each mesh; one more than meshes
};

}  // namespace bendy
