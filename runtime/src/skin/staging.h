#pragma once

#include <bendy/runtime/model.h>

#include "plan/blocks.h"
#include "plan/skin_plan.h"
#include "pose/active_target.h"

#include <array>
#include <cstddef>
#include <span>

namespace bendy {

/// Provides a mesh's vertices in the kernels' layout: in place if the file has plain floats and no morph target moves
/// them; otherwise decoded and morphed, a few at a time, so that they are still in the L1 cache when they are skinned.
/// A kernel may unfold normals of one byte itself.
class Staging {
public:
    /// \param plan     null if the kernel does not use it
    /// \param unfolds  whether the kernel takes SkinBlock::normals8
    /// \param weights  of the mesh's targets
    /// \param room     for the active ones: as many as the mesh has targets
    /// \param wanted   only its outputs are read
    Staging(const Mesh& mesh, const SkinPlan* plan, bool unfolds, std::span<const float> weights,
            std::span<ActiveTarget> room, const SkinBlock& wanted);

    /// The maximum number of vertices per call of fill().
    [[nodiscard]] std::size_t capacity() const { return capacity_; }
    /// Points a block's sources and outputs to `block.vertices` vertices from `first` on. The pointers are valid until
    /// the next call.
    void fill(std::size_t first, const SkinBlock& wanted, SkinBlock& block);

private:
    static constexpr std::size_t kNumbers = 6144;  // 24 KiB
    static constexpr std::size_t kStreams = 3 + 3 + 4;
    static_assert(kNumbers >= kStreams + kMaxInfluences);
    static constexpr std::size_t kAligned = 64;  // vertices, after which outputs are aligned as before

    /// \param scratch  the free part of scratch_; loses what is taken
    /// \param shifted  becomes the vectors that morph targets displace, if there are any
    template <class Vector>
    const float* bring(const std::optional<StreamView>& stream, std::optional<StreamView> MorphTargetView::*shifts,
                       std::size_t first, std::size_t count, bool in_place, float*& scratch,
                       std::span<Vector>& shifted) const;

    const Mesh& mesh_;
    const SkinPlan* plan_;
    std::span<ActiveTarget> active_;
    std::optional<StreamView> positions_;
    float rest_share_ = 1.0f;  // of the mesh's own streams, beside its frames
    bool positions_in_place_ = true, normals_in_place_ = true, tangents_in_place_ = true, weights_in_place_ = true;
    bool has_normals8_ = false;
    std::size_t capacity_ = 0;
    std::array<float, kNumbers> scratch_;
};

}  // namespace bendy
