#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace bendy::converter {

/// Finds joints of a scene by name, and tells who is above whom. The scene's joints must stay as they are.
class JointIndex {
public:
    explicit JointIndex(const Scene& scene);

    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(ends_.size()); }
    /// The joints of a name, ascending.
    [[nodiscard]] std::span<const std::uint32_t> named(std::string_view name) const;
    /// The first joint of a name at or below `top` if there is one, else the first of all; kNone if there is none.
    [[nodiscard]] std::uint32_t find(std::string_view name, std::uint32_t top = kNone) const;
    /// The joint that `#12` or a name means; kNone if there is none.
    [[nodiscard]] std::uint32_t find_key(std::string_view key) const;
    /// In pre-order a joint's descendants are [joint, end).
    [[nodiscard]] std::uint32_t end(std::uint32_t joint) const { return ends_[joint]; }
    [[nodiscard]] bool is_above(std::uint32_t joint, std::uint32_t other) const {
        return joint <= other && other < ends_[joint];
    }

private:
    std::unordered_map<std::string_view, std::vector<std::uint32_t>> by_name_;
    std::vector<std::uint32_t> ends_;
};

}  // namespace bendy::converter
