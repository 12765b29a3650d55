#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bendy::converter {

/// JOINTS_0.., WEIGHTS_0.. of a primitive, the sets of a vertex one after the other.
struct Influences {
    std::size_t per_vertex = 0;  ///< 4 per set
    std::vector<std::uint32_t> bones;
    std::vector<float> weights;
};

/// The largest bone that has weight, and where: to be held against each skin that the mesh is used with.
struct LargestBone {
    std::uint32_t bone = 0;
    std::size_t vertex = 0;
};

/// Brings the weights of each vertex to sum 1 over all sets: those that miss it by more than float rounding are divided
/// by their sum (computed in double), vertices without weight follow their first bone. Then moves influences without
/// weight to the back, as bone 0. Fails at `place` on a weight that is clearly negative.
LargestBone normalise_influences(Influences& influences, const std::string& place, Report& report);

/// Cuts a mesh's influences per vertex to the most that any vertex uses, at least 1.
void trim_influences(Mesh& mesh);

}  // namespace bendy::converter
