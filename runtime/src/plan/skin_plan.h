#pragma once

#include <bendy/format/mesh.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bendy {

/// A mesh's influences as kernels want them. Vertices that lie near each other follow much the same bones, so for each
/// group of eight there is a list of the bones that any of them follows, each with eight weights: a matrix then is read
/// once for eight vertices. Groups of too many bones have no list.
struct SkinPlan {
    static constexpr std::size_t kGroup = 8;
    static constexpr std::size_t kMostBones = 8;  // from there on eight vertices cost as much one by one

    struct alignas(32) Weights {
        float of[kGroup];  // an array, since kernels read it
    };

    std::vector<std::uint32_t> first;  ///< in bones, of each group; one more than groups. Empty: no plan
    std::vector<std::uint16_t> bones;  ///< into the palette
    std::vector<Weights> weights;      ///< as bones
    bool is_complete = false;          ///< every group has a list
};

/// Nothing for a rigid mesh. Linear in the mesh's influences; at most 35 bytes a vertex.
SkinPlan make_skin_plan(const MeshView& mesh);

}  // namespace bendy
