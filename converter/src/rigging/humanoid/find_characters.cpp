#include "find_characters.h"

#include <bendy/format/role.h>

#include <cstddef>

namespace bendy::converter {

std::vector<std::uint32_t> find_branches(const Scene& scene, const std::vector<bool>& chosen) {
    std::vector<std::uint32_t> counts(scene.joints.size());
    for (std::size_t joint = counts.size(); joint-- > 0;) {  // parents come first
        counts[joint] += chosen[joint] ? 1 : 0;
        const std::uint32_t parent = scene.joints[joint].parent;
        if (parent != kNone) counts[parent] += counts[joint];
    }
    std::vector<std::vector<std::uint32_t>> large(counts.size() + 1);  // children by parent, the roots last
    for (std::uint32_t joint = 0; joint < counts.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        if (counts[joint] >= kFewestCharacterJoints) large[parent == kNone ? counts.size() : parent].push_back(joint);
    }
    std::size_t carrier = counts.size();
    while (large[carrier].size() == 1) carrier = large[carrier].front();
    return large[carrier];
}

std::vector<bool> only_below(const Scene& scene, const std::vector<bool>& chosen, std::uint32_t top) {
    std::vector<bool> below(chosen.size());
    for (std::uint32_t joint = top; joint < below.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        below[joint] = joint == top || (parent != kNone && below[parent]);
    }
    for (std::size_t joint = 0; joint < below.size(); ++joint) below[joint] = below[joint] && chosen[joint];
    return below;
}

}  // namespace bendy::converter
