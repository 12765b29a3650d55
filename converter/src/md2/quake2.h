#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter::md2 {

inline constexpr std::size_t kNormals = 162;

/// The directions that a model's vertices name by number, in Quake's axes: the corners of an icosahedron whose faces
/// are cut in four twice, in the order in which the cutting meets them.
std::vector<glm::vec3> quake_normals();

/// Frames that follow one another in the file and by their numbers.
struct FrameRun {
    std::string name;
    std::size_t first = 0;
    std::size_t count = 0;
};

/// Splits frames into runs by their names: letters and a number that grows by one. Of three digits and more the last
/// two count the frames, and the others belong to the name: pain101, pain102 are `pain1`, stand001, stand002 `stand`.
/// Of a model with the frames that Quake II's players have, pains and deaths that are numbered on (death1 to death20)
/// are told apart by where each begins there.
std::vector<FrameRun> find_runs(std::span<const std::string> names);

/// Whether a clip of that name goes on from its last frame to its first: all do but what Quake II's players do once,
/// such as `attack`, `crpain` and `death2`.
bool is_repeated(std::string_view name);

}  // namespace bendy::converter::md2
