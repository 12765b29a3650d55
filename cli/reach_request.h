#pragma once

#include <bendy/runtime.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bendy::cli {

/// What `--reach` and its companions ask for.
struct ReachRequest {
    std::vector<std::string> targets;  ///< CHAIN=X,Y,Z or CHAIN=X,Y,Z,QX,QY,QZ,QW
    std::string solver = "chain";      ///< the chain's own
    bool ignore_limits = false;
};

/// The names that --solver takes.
const std::vector<std::string>& solver_names();

/// Runs IK on the pose, one target after another, and says on standard error how near each came. CHAIN is a chain's
/// name, its number, or the name of the joint that it moves. Fails with the chains that there are if it is none; throws
/// CLI::ValidationError where the text is no target.
void reach_targets(const ReachRequest& request, const std::filesystem::path& file, Pose& pose);

}  // namespace bendy::cli
