#pragma once

#include <bendy/format/mesh.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bendy {

/// A mesh's influences in the kernels' layout. Neighbouring vertices mostly have the same bones, so for each group of
/// eight there is a list of all their bones, each with eight weights: a matrix is then read once for eight vertices.
/// Groups with too many bones have no list.
struct SkinPlan {
    static constexpr std::size_t kGroup = 8;
    static constexpr std::size_t kMostBones = 8;  // with more bones, eight vertices cost the same one by one

    struct alignas(32) Weights {
        float of[kGroup];  // an array, since kernels read it
    };

    std::vector<std::uint32_t> first;  ///< for each group, index into bones; one more than groups. Empty: no plan
    std::vector<std::uint16_t> bones;  ///< indices into the palette
    std::vector<Weights> weights;      ///< one per entry of bones
    bool is_complete = false;          ///< every group has a list
};

/// Returns an empty plan for a rigid mesh. Linear in the mesh's influences; at most 35 bytes per vertex.
SkinPlan make_skin_plan(const MeshView& mesh);

}  // namespace bendy
