#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bendy::converter {

/// Decomposes an affine column-major matrix into T * R * U (see Transform), in double. A mirrored matrix gets a
/// negative first row of U. Also works for matrices without volume.
Transform decompose(const std::array<double, 16>& matrix);

/// x y z w of length 1. A quaternion that is unit within float rounding keeps its bits; zero has no direction and
/// becomes the identity.
struct UnitQuaternion {
    glm::vec4 value{0.0f, 0.0f, 0.0f, 1.0f};
    double length = 1.0;  ///< before normalisation
};
UnitQuaternion make_unit(const std::array<double, 4>& quaternion);

/// Larger deviations of a length from 1 are errors of the source, not rounding, and get a warning.
inline constexpr double kUnitTolerance = 1e-3;

/// JOINTS_0.., WEIGHTS_0.. of a primitive; a vertex's sets are adjacent.
struct Influences {
    std::size_t per_vertex = 0;  ///< 4 per set
    std::vector<std::uint32_t> bones;
    std::vector<float> weights;
};

/// The largest bone with weight, and its vertex: to be checked against each skin that is used with the mesh.
struct LargestBone {
    std::uint32_t bone = 0;
    std::size_t vertex = 0;
};

/// Allowed deviation of a sum of weights from 1, per weight in the sum: float rounding of decoded or stored weights.
/// The same as the Khronos validator's.
inline constexpr double kWeightRounding = 2e-7;

/// Normalises the weights of each vertex to sum 1 over all sets: sums that deviate by more than float rounding are
/// divided out (in double); vertices without weight follow their first bone. Duplicate bones are merged. Then moves
/// influences without weight to the back, as bone 0. Fails at `place` on a clearly negative weight.
LargestBone normalise_influences(Influences& influences, const std::string& place, Report& report);

/// Merges influences of a vertex with the same bone: the first gets the sum of the weights, as glTF and X-files require
/// unique bones. A mesh without duplicates is unchanged. A warning counts the affected vertices.
void merge_influences(Mesh& mesh, const std::string& place, Report& report);

/// Reduces a mesh's influences per vertex to the most that any vertex uses, at least 1.
void trim_influences(Mesh& mesh);

}  // namespace bendy::converter
