#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter::md2 {

inline constexpr std::size_t kNormals = 162;

/// The directions to which a model's vertices refer by number, in Quake's axes: the corners of an icosahedron whose
/// faces are twice cut in four, in the order in which the subdivision visits them.
std::vector<glm::vec3> quake_normals();

/// Consecutive frames with consecutive numbers.
struct FrameRun {
    std::string name;
    std::size_t first = 0;
    std::size_t count = 0;
};

/// Splits frames into runs by their names: letters and a number that increases by one. Upper and lower case are the
/// same, and so are `attack` and `attak`, `death` and `deth`; the first frame names the run. Of three digits and more,
/// the last two count the frames, and the others belong to the name: pain101, pain102 are `pain1`, stand001, stand002
/// `stand`. In a model with the standard frames of Quake II's players, consecutively numbered pains and deaths (death1
/// to death20) are split where each variant begins there.
std::vector<FrameRun> find_runs(std::span<const std::string> names);

/// Whether a clip with that name loops: all do, except for actions that Quake II's players do once, such as `attack`,
/// `crpain` and `death2`.
bool is_repeated(std::string_view name);

}  // namespace bendy::converter::md2
