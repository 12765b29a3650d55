#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/lod.h>
#include <bendy/runtime/palette_matrix.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/vertices.h>

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Many characters of one model, on as many threads as the caller has. There are no threads in here: a thread pool of
// the caller's splits the members into ranges and plays each range as one of `workers`, two ranges at a time never as
// the same one. With TBB:
//
//     bendy::Crowd crowd(*model, tbb::this_task_arena::max_concurrency());
//     tbb::parallel_for(tbb::blocked_range<std::size_t>(0, members.size(), 8), [&](const auto& range) {
//         crowd.play(members.subspan(range.begin(), range.size()), tbb::this_task_arena::current_thread_index());
//     });
namespace BENDY_PUBLIC bendy {

/// One character of a crowd: what it plays and where that is to be written. Members must not share what is written.
struct CrowdMember {
    const Cycle* cycle = nullptr;      ///< of the crowd's model; null: the rest pose
    float seconds = 0.0f;              ///< on the cycle's own time line, as for sample
    const Lod* lod = nullptr;          ///< vertices of that level only; members may share one; null: all
    VertexBuffer out;                  ///< all pools' vertices, as for skin_into; empty: not wanted
    std::span<PaletteMatrix> palette;  ///< Crowd::palette_size() matrices, for skinning elsewhere; empty: not wanted
};

/// The work memory of a crowd: a Pose for each worker, and nothing for each member. Playing allocates nothing. The
/// model must outlive it where it stands.
class Crowd {
public:
    /// \param workers  how many ranges are played at a time at most: the pool's threads; at least 1
    explicit Crowd(const Model& model, std::size_t workers = 1);

    [[nodiscard]] const Model& model() const { return *model_; }
    [[nodiscard]] std::size_t workers() const { return workers_.size(); }

    /// Samples, poses and skins each of the members. What comes out does not depend on how members are split or which
    /// worker plays them. False if the memory of one is too short: that is then not written, all else is.
    /// \param worker  0 to workers() - 1, and no other call's at the same time
    bool play(std::span<const CrowdMember> members, std::size_t worker = 0);

    /// The same where the caller poses: blends cycles, lets chains reach. pose_member(member, pose) sets the whole
    /// pose, which is as the worker's last member left it; the members' cycles and times are the caller's to read.
    template <class PoseMember>
    bool play(std::span<const CrowdMember> members, std::size_t worker, const PoseMember& pose_member) {
        assert(worker < workers_.size());
        Pose& pose = workers_[worker].pose;
        bool is_good = true;
        for (const CrowdMember& member : members) {
            pose_member(member, pose);
            is_good = write(member, pose) && is_good;
        }
        return is_good;
    }

    /// Matrices of all pools together, pool after pool, and where a pool's begin: its bind palette's entries, in order;
    /// of a rigid pool one, that of the joint which moves its first vertex.
    [[nodiscard]] std::size_t palette_size() const { return first_entry_.back(); }
    [[nodiscard]] std::size_t first_entry(std::uint32_t pool) const { return first_entry_[pool]; }

private:
    struct alignas(64) Worker {  // so that no two workers write to one cache line
        explicit Worker(const Model& model) : pose(model) {}
        Pose pose;
    };

    bool write(const CrowdMember& member, Pose& pose) const;
    void write_palette(Pose& pose, std::span<PaletteMatrix> palette) const;

    const Model* model_;
    std::vector<Worker> workers_;
    std::vector<std::size_t> first_entry_;  // of each pool; one more than pools
};

}  // namespace bendy
