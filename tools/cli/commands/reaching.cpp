#include "commands/reaching.h"
#include "choices.h"
#include "commands/model_options.h"

#include "reports/messages.h"

#include <bendy/format/names.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string_view>

namespace bendy::tools {
namespace {

std::string chain_label(const Model& model, const Chain& chain) {
    std::string label =
        chain.name.empty() ? "number " + std::to_string(&chain - model.chains().data()) : printable(chain.name);
    const std::string_view effector = model.joints()[chain.record.effector].name;
    if (!effector.empty()) label += " (moves " + printable(effector) + ")";
    return label;
}

const Chain& find_chain(const std::filesystem::path& file, const Model& model, const std::string& name) {
    const auto chains = model.chains();
    std::vector<std::string_view> own;
    std::vector<std::string_view> moved;
    for (const Chain& chain : chains) {
        own.push_back(chain.name);
        moved.push_back(model.joints()[chain.record.effector].name);
    }
    const ThingKey key = read_key(name);
    const bool is_own = key.name && std::find(own.begin(), own.end(), *key.name) != own.end();
    const auto found = find_by_key(is_own ? own : moved, name, "IK chain");
    if (found) return chains[*found];
    if (found.error().is_ambiguous) fail(file, printable(found.error().message));
    if (chains.empty()) {
        fail(file, "there is no IK chain \"" + printable(name) +
                       "\"; there are none (`bendy convert --rig` or `--auto-rig` brings some in)");
    }
    // Suggests chains both by their own names and by the joints that they move: the user may have meant either.
    std::vector<std::string_view> names = own;
    names.insert(names.end(), moved.begin(), moved.end());
    std::string known;
    constexpr std::size_t kShown = 8;
    for (const Chain& chain : chains.first(std::min(kShown, chains.size())))
        known += (known.empty() ? "" : ", ") + chain_label(model, chain);
    if (chains.size() > kShown) known += ", ...";
    const std::string suggestion = printable(did_you_mean(names, name));
    fail(file, "there is no IK chain \"" + printable(name) + '"' + suggestion +
                   (suggestion.empty() ? "; there " : " There ") + (chains.size() == 1 ? "is " : "are ") +
                   std::to_string(chains.size()) + ": " + known);
}

/// Indexed by number. Solver::any is "chain" here: the solver that the chain names.
const std::vector<std::string>& solver_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all(kValueNames<Solver>.begin(), kValueNames<Solver>.end());
        all[static_cast<std::size_t>(Solver::any)] = "chain";
        return all;
    }();
    return names;
}

Solver find_solver(const std::string& name) {
    const auto& names = solver_names();
    const auto found = std::find(names.begin(), names.end(), name);
    return static_cast<Solver>(found == names.end() ? 0 : found - names.begin());
}

std::string in_millimetres(float metres) {
    const double length = 1e3 * static_cast<double>(metres);
    if (length < 1e-3) return "less than 0.001 mm";
    std::ostringstream text;
    if (length < 100.0) {
        text << std::setprecision(3) << length;
    } else {
        text << std::fixed << std::setprecision(0) << length;
    }
    return text.str() + " mm";
}

/// The remaining distance to the target, or the remaining angle if the chain aims: an aim turns the tip without moving
/// it.
std::string gap_of(const ReachGoal& goal, const ReachResult& result) {
    std::string gap = in_millimetres(result.distance);
    if (result.status == ReachStatus::aimed) return gap + " away";
    std::ostringstream angle;
    angle << std::setprecision(3) << result.angle * 57.29578f << " degrees";
    if (goal.is_aim()) return angle.str();
    return goal.target.rotation ? gap + " and " + angle.str() : gap;
}

bool is_worse(const Reached& a, const Reached& b, bool is_aim) {
    const auto rank = [](const Reached& result) { return !result ? 2 : has_reached(result) ? 0 : 1; };
    if (rank(a) != rank(b)) return rank(a) > rank(b);
    if (!a) return false;
    if (is_aim) return a->angle > b->angle;
    return a->distance != b->distance ? a->distance > b->distance : a->angle > b->angle;
}

/// Parses CHAIN=X,Y,Z or CHAIN=X,Y,Z,QX,QY,QZ,QW.
/// \param solver  from the option; Solver::any: the chain's own
ReachGoal parse_goal(const std::string& text, Solver solver, const std::filesystem::path& file, const Model& model) {
    const std::size_t equals = text.rfind('=');
    const std::vector<float> n =
        equals == std::string::npos ? std::vector<float>() : read_numbers(std::string_view(text).substr(equals + 1));
    if (n.size() != 3 && n.size() != 7) {
        throw CLI::ValidationError("--reach",
                                   "must be CHAIN=X,Y,Z in metres, or with a rotation CHAIN=X,Y,Z,QX,QY,QZ,QW");
    }
    ReachTarget target({n[0], n[1], n[2]});
    if (n.size() == 7) {
        const glm::quat rotation(n[6], n[3], n[4], n[5]);
        if (std::abs(glm::length(rotation) - 1.0f) > 1e-2f)
            throw CLI::ValidationError("--reach", "the rotation must be a unit quaternion x y z w");
        target.rotation = glm::normalize(rotation);
    }
    const Chain& chain = find_chain(file, model, text.substr(0, equals));
    return {&chain, target, solver == Solver::any ? chain.solver() : solver};
}

}  // namespace

void add_reach(CLI::App& command, ReachRequest& request) {
    command.add_flag("--constrain", request.constrain, "apply the joints' constraints to the clip's pose");
    CLI::Option* reach =
        command.add_option("--reach", request.targets,
                           "after the clip, move an IK chain's tip to a point: CHAIN=X,Y,Z in metres; or "
                           "with an orientation, CHAIN=X,Y,Z,QX,QY,QZ,QW; may be repeated. A chain that falls short of "
                           "its target is reported with what is left, and is not an error");
    command
        .add_option(
            "--solver", request.solver,
            "for --reach; chain: the solver that the file names. pull makes a single step towards the target in "
            "each pose; the others finish, ccd and fabrik as least_squares")
        ->check(one_of(solver_names()))
        ->capture_default_str()
        ->needs(reach);
    command
        .add_flag("--ignore-constraints", request.ignore_constraints, "ignore the joints' constraints while reaching")
        ->needs(reach);
}

bool has_reached(const Reached& result) {
    return result && (result->status == ReachStatus::reached || result->status == ReachStatus::aimed);
}

Reaching::Reaching(const ReachRequest& request, const std::filesystem::path& file, const Model& model)
    : request_(request), file_(file), model_(model) {
    for (const std::string& text : request.targets)
        goals_.push_back(parse_goal(text, find_solver(request.solver), file, model));
    counts_.resize(goals_.size());
}

void Reaching::follow_frames(const Clip& clip, const FrameRange& range,
                             const std::function<void(Pose&, float)>& pose_at) {
    follow_frames();
    if (goals_.empty()) return;
    constexpr std::uint32_t kMost = 100'000;  // that are not shown
    constexpr float kRest = 2.0f;             // seconds after the end until nothing moves any more
    Pose pose(model_);
    for (std::uint32_t frame = range.first - std::min(range.first, kMost); frame < range.first; ++frame) {
        const float time = range.time(frame);
        if (range.time(frame + 1) < clip.start || time > clip.end + kRest) continue;
        pose_at(pose, time);
        apply(pose, time);
    }
}

void Reaching::apply(Pose& pose, float time) {
    if (request_.constrain) constrain(pose);
    ReachOptions options;
    options.solver = find_solver(request_.solver);
    options.obey_constraints = !request_.ignore_constraints;
    if (state_) options.state = &*state_;
    options.seconds = time_ ? time - *time_ : 0.0f;
    time_ = time;
    results_.clear();
    for (const ReachGoal& goal : goals_) {
        const auto reached = reach(pose, goal.chain, goal.target, options);
        results_.push_back(reached ? Reached(*reached) : std::nullopt);
    }
}

void Reaching::count() {
    for (std::size_t k = 0; k < results_.size(); ++k) {
        Count& count = counts_[k];
        if (!has_reached(results_[k])) ++count.short_ones;
        if (count.poses++ != 0 && !is_worse(results_[k], count.worst, goals_[k].is_aim())) continue;
        count.worst = results_[k];
        count.time = time_.value_or(0.0f);
    }
}

void Reaching::print() const {
    for (std::size_t k = 0; k < counts_.size(); ++k) {
        const Count& count = counts_[k];
        const std::string chain = "reach: " + chain_label(model_, *goals_[k].chain);
        if (!count.worst) {
            warn(file_, chain + " was not moved: its numbers leave a float's range");
            continue;
        }
        const std::string gap = gap_of(goals_[k], *count.worst);
        std::ostringstream text;
        if (count.short_ones == 0) {
            const bool is_aim = count.worst->status == ReachStatus::aimed;
            std::cerr << "bendy: " << chain << (is_aim ? " aims at its target" : " reaches its target");
            if (count.poses > 1) std::cerr << " in all " << count.poses << " poses";
            std::cerr << (is_aim ? ", " : ", to ") << gap << '\n';
        } else {
            text << chain << " falls short of its target by " << (count.poses > 1 ? "up to " : "") << gap;
            if (count.poses > 1)
                text << " (at " << count.time << " s), in " << count.short_ones << " of " << count.poses << " poses";
            if (count.worst->status == ReachStatus::out_of_reach) {
                text << ": it is farther away than the chain is long";
            } else if (goals_[k].solver == Solver::pull) {
                text << ": pull makes a single step in each pose; the other solvers finish";
            }
            warn(file_, text.str());
        }
    }
}

}  // namespace bendy::tools
