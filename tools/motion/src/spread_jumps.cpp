#include "spread_jumps.h"

#include <bendy/runtime/turn.h>

#include <glm/gtc/quaternion.hpp>

#include <cstddef>

namespace bendy::motion {
namespace {

/// One joint over all frames.
class Joint {
public:
    Joint(const Model& model, std::span<std::vector<JointTransform>> frames, std::span<const double> allowed,
          std::uint32_t joint)
        : frames_(frames),
          allowed_(allowed),
          joint_(joint),
          limit_(model.constraint(joint)),
          rest_(model.joints()[joint].rest.rotation) {}

    [[nodiscard]] bool jumps() const {
        for (std::size_t k = 1; k < frames_.size(); ++k) {
            if (turn_between(rotation(k - 1), rotation(k)) > allowed_[k]) return true;
        }
        return false;
    }

    /// Sets the rotations to the mean of those that follow the clip forwards and backwards, as quickly as is allowed.
    void spread(bool repeats, std::vector<bool>& changed) {
        std::vector<glm::quat> found;
        for (std::size_t k = 0; k < frames_.size(); ++k) found.push_back(rotation(k));
        const std::vector<glm::quat> forwards = follow(found, false, repeats), backwards = follow(found, true, repeats);
        std::vector<glm::quat> mean;
        mean.reserve(found.size());
        for (std::size_t k = 0; k < found.size(); ++k) {
            const bool is_found = forwards[k] == backwards[k];
            mean.push_back(is_found ? found[k] : turn_part_way(limit_, rest_, forwards[k], backwards[k], 0.5));
        }
        mean = follow(mean, false, repeats);  // where the two are half a turn apart, so that their mean jumps
        for (std::size_t k = 0; k < found.size(); ++k) {
            if (mean[k] == found[k]) continue;
            frames_[k][joint_].rotation = mean[k];
            changed[k] = true;
        }
    }

private:
    [[nodiscard]] const glm::quat& rotation(std::size_t frame) const { return frames_[frame][joint_].rotation; }

    [[nodiscard]] std::vector<glm::quat> follow(const std::vector<glm::quat>& wanted, bool is_backwards,
                                                bool repeats) const {
        const std::size_t count = wanted.size();
        std::vector<glm::quat> followed(wanted);
        const auto at = [&](std::size_t k) { return is_backwards ? count - 1 - k : k; };
        for (int round = 0; round < (repeats ? 2 : 1); ++round) {
            if (round == 1) followed[at(0)] = followed[at(count - 1)];
            for (std::size_t k = 1; k < count; ++k) {
                const double allowed = allowed_[is_backwards ? at(k) + 1 : k];
                followed[at(k)] = turn_towards(limit_, rest_, followed[at(k - 1)], wanted[at(k)], allowed);
            }
        }
        return followed;
    }

    std::span<std::vector<JointTransform>> frames_;
    std::span<const double> allowed_;
    std::uint32_t joint_;
    const Constraint* limit_;
    glm::quat rest_;
};

}  // namespace

std::vector<bool> spread_jumps(const Model& model, std::span<std::vector<JointTransform>> frames,
                               std::span<const double> allowed, std::span<const std::uint32_t> joints, bool repeats) {
    std::vector<bool> changed(frames.size());
    for (const std::uint32_t number : joints) {
        Joint joint(model, frames, allowed, number);
        if (joint.jumps()) joint.spread(repeats, changed);
    }
    return changed;
}

}  // namespace bendy::motion
