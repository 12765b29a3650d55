#include "joint_index.h"

#include "joint_key.h"

#include <algorithm>

namespace bendy::converter {

JointIndex::JointIndex(const Scene& scene) : ends_(scene.joints.size()) {
    for (std::uint32_t joint = 0; joint < size(); ++joint) by_name_[scene.joints[joint].name].push_back(joint);
    for (std::uint32_t joint = size(); joint-- > 0;) {
        ends_[joint] = std::max(ends_[joint], joint + 1);
        const std::uint32_t parent = scene.joints[joint].parent;
        if (parent != kNone) ends_[parent] = std::max(ends_[parent], ends_[joint]);
    }
}

std::span<const std::uint32_t> JointIndex::named(std::string_view name) const {
    const auto found = by_name_.find(name);
    if (found == by_name_.end()) return {};
    return found->second;
}

std::uint32_t JointIndex::find(std::string_view name, std::uint32_t top) const {
    const auto joints = named(name);
    if (joints.empty()) return kNone;
    if (top != kNone) {
        const auto below = std::lower_bound(joints.begin(), joints.end(), top);
        if (below != joints.end() && *below < end(top)) return *below;
    }
    return joints.front();
}

std::uint32_t JointIndex::find_key(std::string_view key) const {
    std::uint64_t number = 0;
    if (!parse_joint_number(key, number)) return find(key);
    return number < size() ? static_cast<std::uint32_t>(number) : kNone;
}

}  // namespace bendy::converter
