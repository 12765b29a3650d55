#pragma once

#include "commands/frames.h"

#include <bendy/runtime.h>

#include <CLI/CLI.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

// --reach and the options that go with it: chains that reach in one pose, or in one frame after another.
namespace bendy::tools {

/// The request of --constrain, --reach, --solver and --ignore-constraints: how to change a pose after sampling the
/// clip.
struct ReachRequest {
    bool constrain = false;
    std::vector<std::string> targets;  ///< CHAIN=X,Y,Z or CHAIN=X,Y,Z,QX,QY,QZ,QW
    std::string solver = "chain";      ///< "chain": the chain's own
    bool ignore_constraints = false;
};

/// Adds the four options.
void add_reach(CLI::App& command, ReachRequest& request);

/// A chain of the model, and its target.
struct ReachGoal {
    const Chain* chain = nullptr;
    ReachTarget target;
    Solver solver = Solver::any;  ///< the option's or the chain's

    /// Returns true if the tip is to point at the target, at any distance.
    [[nodiscard]] bool is_aim() const { return solver == Solver::aim; }
};

/// Empty for a chain that could not be moved because its numbers leave the range of a float.
using Reached = std::optional<ReachResult>;

/// Returns false if the tip is farther from the target, or turned further from it, than the solver tolerates.
bool has_reached(const Reached& result);

/// Lets the chains of a request reach, and records how near they come.
class Reaching {
public:
    /// CHAIN of a target is a chain's name or number, see find_by_key, or the name of the joint that it moves. If none
    /// matches, fails with a list of the chains; throws CLI::ValidationError if the text is not a target.
    Reaching(const ReachRequest& request, const std::filesystem::path& file, const Model& model);

    /// From now on, poses follow one another: no chain jumps from one to the next.
    void follow_frames() { state_.emplace(model_); }
    /// The same for frames of a clip, of which those before the range are stepped through from the clip's start on, so
    /// that a frame has the same pose in every range.
    /// \param pose_at  samples the clip
    void follow_frames(const Clip& clip, const FrameRange& range, const std::function<void(Pose&, float)>& pose_at);

    /// Clamps the pose to the joints' limits, if requested, and then lets the chains reach one after another.
    /// \param time  in the clip, seconds
    void apply(Pose& pose, float time);
    /// Counts the last pose.
    void count();
    /// Prints to standard error how near each chain came; a warning if it falls short.
    void print() const;

    [[nodiscard]] const std::vector<ReachGoal>& goals() const { return goals_; }
    /// Of the last pose, one for each goal.
    [[nodiscard]] const std::vector<Reached>& results() const { return results_; }

private:
    struct Count {
        Reached worst;
        float time = 0.0f;  // of the worst pose
        std::size_t poses = 0;
        std::size_t short_ones = 0;
    };

    const ReachRequest& request_;
    const std::filesystem::path& file_;
    const Model& model_;
    std::vector<ReachGoal> goals_;
    std::vector<Reached> results_;
    std::vector<Count> counts_;  // one per goal
    std::optional<ReachState> state_;
    std::optional<float> time_;  // of the last pose
};

}  // namespace bendy::tools
