#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bendy::converter {

/// Turns an affine column-major matrix into T * R * U (see Transform), computed in double. A mirrored matrix gets a
/// negative first row of U. Works for matrices without volume.
Transform decompose(const std::array<double, 16>& matrix);

/// x y z w of length 1. A quaternion that is one already, but for float rounding, keeps its bits; zero has no direction
/// and gives the identity.
struct UnitQuaternion {
    glm::vec4 value{0.0f, 0.0f, 0.0f, 1.0f};
    double length = 1.0;  ///< before
};
UnitQuaternion make_unit(const std::array<double, 4>& quaternion);

/// Lengths further from 1 than this are the source's fault, not rounding, and worth a warning.
inline constexpr double kUnitTolerance = 1e-3;

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
/// by their sum (computed in double), vertices without weight follow their first bone. Influences of one bone become
/// one. Then moves influences without weight to the back, as bone 0. Fails at `place` on a weight that is clearly
/// negative.
LargestBone normalise_influences(Influences& influences, const std::string& place, Report& report);

/// Makes one influence of all that a vertex of the mesh has of one bone, with the sum of their weights, in the place of
/// the first; glTF and X-files allow no others. A mesh without such vertices stays as it is. A warning counts them.
void merge_influences(Mesh& mesh, const std::string& place, Report& report);

/// Cuts a mesh's influences per vertex to the most that any vertex uses, at least 1.
void trim_influences(Mesh& mesh);

}  // namespace bendy::converter
