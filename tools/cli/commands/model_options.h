#pragma once

#include "reports/convert_options.h"

#include <bendy/runtime.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Options that several commands share, and what they ask of a model.
namespace bendy::tools {

/// Adds FILE, for a command that takes a character of any kind.
CLI::Option* add_character(CLI::App& command, std::filesystem::path& file);
/// Adds --root, for a command that reads the files that its input names.
CLI::Option* add_root(CLI::App& command, std::filesystem::path& root);

/// Adds --clip, for a command that shows the rest pose without it.
CLI::Option* add_clip(CLI::App& command, std::string& clip);
/// Returns a clip by its name or number, see find_by_key. If there is none, fails with a list of the clips.
const Clip& find_clip(const std::string& clip, const std::filesystem::path& file, const Model& model);

/// Adds --format. \param formats  the first is the default for standard output
void add_format(CLI::App& command, std::string& format, const std::vector<std::string>& formats);

/// Parses numbers separated by commas; empty if the text is anything else.
std::vector<float> read_numbers(std::string_view text);

/// Adds --lod; the fraction is from 0 to 1.
void add_lod(CLI::App& command, float& share);
/// Warns if a level of detail is requested but the file has none.
void warn_without_levels(const std::filesystem::path& file, const Model& model, float share);
/// Returns that level of the file's model; full detail, with a warning, if the file has no levels.
Lod level_of(const std::filesystem::path& file, const Model& model, float share);

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

/// Returns the requested chains and targets. CHAIN is a chain's name or number, see find_by_key, or the name of the
/// joint that it moves. If none matches, fails with a list of the chains; throws CLI::ValidationError if the text is
/// not a target.
std::vector<ReachGoal> find_goals(const ReachRequest& request, const std::filesystem::path& file, const Model& model);

/// Empty for a chain that could not be moved because its numbers leave the range of a float.
using Reached = std::optional<ReachResult>;

/// Clamps the pose to the joints' limits, if requested, and then lets the chains reach one after another. One result
/// per goal.
std::vector<Reached> reach_goals(const ReachRequest& request, const std::vector<ReachGoal>& goals, Pose& pose);

/// How well a chain reached its target in one pose or several.
class ReachTally {
public:
    /// \param time  in the clip, seconds
    void add(const std::vector<ReachGoal>& goals, const std::vector<Reached>& results, float time);
    /// Prints to standard error how near each chain came; a warning if it falls short.
    void print(const std::filesystem::path& file, const Model& model, const std::vector<ReachGoal>& goals) const;

private:
    struct Count {
        Reached worst;
        float time = 0.0f;  // of the worst pose
        std::size_t poses = 0;
        std::size_t short_ones = 0;
    };
    std::vector<Count> counts_;  // one per goal
};

/// Returns false if the tip is farther from the target, or turned further from it, than the solver tolerates.
bool has_reached(const Reached& result);

}  // namespace bendy::tools
