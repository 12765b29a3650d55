#include "reach_request.h"

#include "problem.h"

#include <bendy/edit/names.h>

#include <CLI/Error.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iostream>
#include <sstream>

namespace bendy::cli {
namespace {

/// Numbers between commas; nothing if the text is anything else.
std::vector<float> read_numbers(std::string_view text) {
    std::vector<float> numbers;
    while (true) {
        float number = 0.0f;
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (problem != std::errc() || !std::isfinite(number)) return {};
        numbers.push_back(number);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        if (text.empty()) return numbers;
        if (text.front() != ',') return {};
        text.remove_prefix(1);
    }
}

std::string chain_label(const Model& model, const Chain& chain) {
    std::string label = chain.name.empty() ? "number " + std::to_string(chain.number) : printable(chain.name);
    const std::string_view effector = model.joints()[chain.effector].name;
    if (!effector.empty()) label += " (moves " + printable(effector) + ")";
    return label;
}

const Chain& find_chain(const std::filesystem::path& file, const Model& model, const std::string& name) {
    if (const Chain* chain = model.chain(name)) return *chain;
    std::size_t number = 0;
    const auto [end, problem] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (problem == std::errc() && end == name.data() + name.size() && number < model.chains().size())
        return model.chains()[number];
    const auto moves = [&](const Chain& chain) { return model.joints()[chain.effector].name == name; };
    const auto chains = model.chains();
    if (const auto found = std::find_if(chains.begin(), chains.end(), moves); found != chains.end()) return *found;
    if (chains.empty()) {
        fail(file, "there is no IK chain \"" + printable(name) +
                       "\"; there are none (`bendy convert --rig` or `--auto-rig` brings some in)");
    }
    // Chains by their own names and by those of the joints that they move: either may have been meant.
    std::vector<std::string_view> names;
    for (const Chain& chain : chains) {
        if (!chain.name.empty()) names.push_back(chain.name);
        names.push_back(model.joints()[chain.effector].name);
    }
    std::string known;
    constexpr std::size_t kShown = 8;
    for (const Chain& chain : chains.first(std::min(kShown, chains.size())))
        known += (known.empty() ? "" : ", ") + chain_label(model, chain);
    if (chains.size() > kShown) known += ", ...";
    const std::string suggestion = printable(edit::did_you_mean(names, name));
    fail(file, "there is no IK chain \"" + printable(name) + '"' + suggestion +
                   (suggestion.empty() ? "; there " : " There ") + (chains.size() == 1 ? "is " : "are ") +
                   std::to_string(chains.size()) + ": " + known);
}

Solver find_solver(const std::string& name) {
    const auto& names = solver_names();
    const auto found = std::find(names.begin(), names.end(), name);
    return static_cast<Solver>(found == names.end() ? 0 : found - names.begin());
}

std::string length_text(float metres) {
    std::ostringstream text;
    text.precision(3);
    if (metres < 1e-6f) return "less than 0.001 mm";
    if (metres < 0.001f) {
        text << metres * 1000.0f << " mm";
    } else {
        text << metres << " m";
    }
    return text.str();
}

void report(const Model& model, const Chain& chain, const ReachOptions& options, const ReachResult& result) {
    constexpr std::array<std::string_view, 5> kWords{"reached", "out of reach, points at the target", "not reached",
                                                     "aims at the target", "refused"};
    const bool is_aim = (options.solver != Solver::any ? options.solver : chain.solver) == Solver::aim;
    std::cerr << "bendy: reach: " << chain_label(model, chain) << ": ";
    if (is_aim && result.status == ReachStatus::not_reached) {
        constexpr double kDegrees = 180.0 / 3.14159265358979323846;
        std::ostringstream angle;
        angle.precision(3);
        angle << result.angle * kDegrees;
        std::cerr << "aims " << angle.str() << " degrees past the target, ";
    } else {
        std::cerr << kWords.at(static_cast<std::size_t>(result.status)) << ", ";
    }
    std::cerr << length_text(result.distance) << (is_aim ? " away, " : " left, ") << result.iterations
              << (result.iterations == 1 ? " iteration\n" : " iterations\n");
}

}  // namespace

const std::vector<std::string>& solver_names() {
    static const std::vector<std::string> names{"chain", "pull", "two_bone", "ccd", "fabrik", "aim", "least_squares"};
    return names;
}

void reach_targets(const ReachRequest& request, const std::filesystem::path& file, Pose& pose) {
    for (const std::string& text : request.targets) {
        const std::size_t equals = text.rfind('=');
        const std::vector<float> n = equals == std::string::npos
                                         ? std::vector<float>()
                                         : read_numbers(std::string_view(text).substr(equals + 1));
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
        const Chain& chain = find_chain(file, pose.model(), text.substr(0, equals));
        ReachOptions options;
        options.solver = find_solver(request.solver);
        options.obey_constraints = !request.ignore_limits;
        const ReachResult result = reach(&chain, target, pose, options);
        report(pose.model(), chain, options, result);
    }
}

}  // namespace bendy::cli
