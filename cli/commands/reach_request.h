#pragma once

#include <bendy/runtime.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// The options --constrain, --reach, --solver and --ignore-constraints: what is done to a pose after the clip.
namespace bendy::cli {

/// What they ask for.
struct ReachRequest {
    bool constrain = false;
    std::vector<std::string> targets;  ///< CHAIN=X,Y,Z or CHAIN=X,Y,Z,QX,QY,QZ,QW
    std::string solver = "chain";      ///< the chain's own
    bool ignore_constraints = false;
};

/// Adds them.
void add_reach(CLI::App& command, ReachRequest& request);

/// A chain of the model, and what it is to reach.
struct ReachGoal {
    const Chain* chain = nullptr;
    ReachTarget target;
};

/// The chains and targets that are asked for. CHAIN is a chain's name, its number, or the name of the joint that it
/// moves. Fails with the chains that there are if it is none; throws CLI::ValidationError where the text is no target.
std::vector<ReachGoal> find_goals(const ReachRequest& request, const std::filesystem::path& file, const Model& model);

/// Nothing where a chain could not be moved: its numbers leave a float's range.
using Reached = std::optional<ReachResult>;

/// Brings the pose inside the joints' limits, if asked to, and then lets one chain after another reach. One result a
/// goal.
std::vector<Reached> reach_goals(const ReachRequest& request, const std::vector<ReachGoal>& goals, Pose& pose);

/// How a chain did in one pose or several.
class ReachTally {
public:
    /// \param time  of the clip, seconds
    void add(const std::vector<Reached>& results, float time);
    /// Says on standard error how near each chain came: a warning where it falls short.
    void print(const std::filesystem::path& file, const Model& model, const std::vector<ReachGoal>& goals) const;

private:
    struct Count {
        Reached worst;
        float time = 0.0f;  // of the worst
        std::size_t poses = 0;
        std::size_t short_ones = 0;
    };
    std::vector<Count> counts_;  // one a goal
};

/// False where the tip is farther from the target, or turned further, than the solver tolerates.
bool has_reached(const Reached& result);

}  // namespace bendy::cli
