#pragma once

#include <bendy/converter/scene.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace bendy::converter::md2 {

/// Frames that follow one another in the file and by their numbers.
struct FrameRun {
    std::string name;
    std::size_t first = 0;
    std::size_t count = 0;
};

/// Splits frames into runs by their names: letters and a number that grows by one. Of three digits and more the last
/// two count the frames, and the others belong to the name: pain101, pain102 are `pain1`, stand001, stand002 `stand`.
std::vector<FrameRun> find_runs(std::span<const std::string> names);

}  // namespace bendy::converter::md2
