#pragma once

#include <bendy/runtime/ik.h>
#include <bendy/runtime/reach_state.h>

#include <glm/gtc/quaternion.hpp>

#include <cstdint>
#include <optional>
#include <span>

// A chain that reaches in frame after frame: see ReachState.
namespace bendy {

/// What a ReachState holds of a chain of its model.
struct ReachMemory {
    using Link = ReachState::Link;

    /// Nothing without a state, or if the solver itself takes several frames.
    ReachMemory(const Chain& of, const ReachOptions& options);

    ReachState::ChainMemory* chain = nullptr;
    std::span<Link> links;
};

/// A pose of a chain to begin with, or to have.
struct ReachStart {
    std::span<const ReachMemory::Link> links;
    glm::quat ReachMemory::Link::*rotation = nullptr;
    enum class Use : std::uint8_t {
        start,      ///< what the target leaves open stays near the pose that came in
        stay_near,  ///< and near this pose
        finish,     ///< is not solved
    } use = Use::start;

    [[nodiscard]] const glm::quat& at(std::size_t link) const { return links[link].*rotation; }
};

/// One call of reach with a state: what is to be done before and after the call without one.
class ReachOverTime {
public:
    /// Remembers the pose that comes in.
    ReachOverTime(const Chain& chain, const ReachTarget& target, Pose& pose, const ReachOptions& options);

    /// The options of the call without a state.
    [[nodiscard]] const ReachOptions& options() const { return stateless_; }
    /// Changes what that call found to what follows from the state.
    std::optional<ReachResult> follow(const std::optional<ReachResult>& found);

private:
    using Link = ReachMemory::Link;
    using Turn = glm::quat Link::*;

    void read_pose();
    bool choose(const ReachResult& found);
    bool approach();
    std::optional<ReachResult> begin_with(Turn rotation, ReachStart::Use use, const ReachOptions& options);
    void keep(Turn to, Turn from);
    void read_rotations(Turn to);
    void restore();
    [[nodiscard]] double turn_between(Turn a, Turn b) const;
    [[nodiscard]] double turn_from_posed(Turn to) const;
    [[nodiscard]] double miss_of(const ReachResult& result) const;

    const Chain& chain_;
    const ReachTarget& target_;
    Pose& pose_;
    const ReachOptions& options_;
    ReachOptions stateless_;
    ReachMemory memory_;
    double seconds_ = 0.0;
    double allowed_ = 0.0;  ///< radians by which the pose may turn
    double length_ = 0.0;   ///< metres
};

}  // namespace bendy
