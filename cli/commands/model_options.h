#pragma once

#include "convert/convert_options.h"

#include <bendy/runtime.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Options that several commands have, and what they ask of a model.
namespace bendy::cli {

/// Adds FILE of a command that takes a character of any kind.
CLI::Option* add_character(CLI::App& command, std::filesystem::path& file);
/// Adds --root, of a command that reads the files that its input names.
CLI::Option* add_root(CLI::App& command, std::filesystem::path& root);

/// Adds --clip, of a command that shows the rest pose without it.
CLI::Option* add_clip(CLI::App& command, std::string& clip);
/// A clip by its name or number, see find_by_key. Fails with the clips that there are if it is none.
const Clip& find_clip(const std::string& clip, const std::filesystem::path& file, const Model& model);

/// Adds --format. \param formats  the first is that of standard output
void add_format(CLI::App& command, std::string& format, const std::vector<std::string>& formats);

/// Numbers between commas; none if the text is anything else.
std::vector<float> read_numbers(std::string_view text);

/// Adds --lod; the share is from 0 to 1.
void add_lod(CLI::App& command, float& share);
/// Warns where a level is asked for of a file that has none.
void warn_without_levels(const std::filesystem::path& file, const Model& model, float share);
/// That level of the file's model; full detail, and a warning, if the file has no levels.
Lod level_of(const std::filesystem::path& file, const Model& model, float share);

/// What --constrain, --reach, --solver and --ignore-constraints ask for: what is done to a pose after the clip.
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
    bool is_aim = false;  ///< the tip is to point at the target, at any distance
};

/// The chains and targets that are asked for. CHAIN is a chain's name or number, see find_by_key, or the name of
/// the joint that it moves. Fails with a list of the chains if none matches; throws CLI::ValidationError if the text
/// is not a target.
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
    void add(const std::vector<ReachGoal>& goals, const std::vector<Reached>& results, float time);
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
