#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// The vertices of a skinned mesh by the bones that they follow. A kernel skins eight neighbours at a time, and reads
/// each matrix that they need once.
class BoneOrder {
public:
    explicit BoneOrder(const Mesh& mesh);

    /// Sorts by the ascending list of bones; vertices with the same bones keep the order of `places`.
    /// \param places  a number for each vertex, each once; what is returned has the same form
    [[nodiscard]] std::vector<std::uint32_t> sorted(std::span<const std::uint32_t> places) const;

    /// The number of different bones that eight neighbours follow, on average.
    [[nodiscard]] double bones_of_eight(std::span<const std::uint32_t> places) const;

private:
    std::vector<std::vector<std::uint32_t>> sets_;  // each an ascending list of bones; ascending
    std::vector<std::uint32_t> set_of_;             // by vertex
};

/// Places vertices that follow the same bones next to each other, where that saves enough to be worth another order;
/// fills Mesh::source_numbers. Rigid meshes are unchanged. Vertices of a mesh with a collapse sequence stay between the
/// same two levels, see places_in_levels, and get no source numbers: their order was another one before.
void sort_by_bones(Scene& scene);

}  // namespace bendy::converter
