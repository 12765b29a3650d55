#include "reach_request.h"

#include "problem.h"

#include <bendy/runtime/local_to_model.h>

#include <CLI/Error.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

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
    std::string known;
    for (const Chain& chain : chains) known += (known.empty() ? "" : ", ") + chain_label(model, chain);
    fail(file, "there is no IK chain \"" + printable(name) + "\"; there " +
                   (chains.empty() ? "are none (`bendy convert --rig` or `--auto-rig` brings some in)"
                                   : "are " + std::to_string(chains.size()) + ": " + known));
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

void report(const Model& model, const Chain& chain, const ReachResult& result) {
    constexpr std::array<std::string_view, 4> kWords{"reached", "out of reach, points at the target", "not reached",
                                                     "refused"};
    std::cerr << "bendy: reach: " << chain_label(model, chain) << ": "
              << kWords.at(static_cast<std::size_t>(result.status)) << ", " << length_text(result.distance) << " left, "
              << result.iterations << (result.iterations == 1 ? " iteration\n" : " iterations\n");
}

bool is_at_or_below(const Model& model, std::uint32_t joint, std::uint32_t ancestor) {
    while (joint != kNone && joint != ancestor) joint = model.joints()[joint].parent;
    return joint != kNone;
}

/// Takes the joint that the chain follows along to where the tip is now, with all that hangs on it: a foot that has a
/// joint of its own beside the leg stays at the leg's end.
void carry_target(const Chain& chain, Pose& pose) {
    const Model& model = pose.model();
    if (chain.target == kNone || is_at_or_below(model, chain.target, chain.start) ||
        is_at_or_below(model, chain.start, chain.target)) {
        return;
    }
    local_to_model(pose);
    const auto& offset = chain.record.tip_offset;
    const glm::dvec4 tip =
        glm::dmat4(pose.model_space()[chain.effector]) * glm::dvec4(offset[0], offset[1], offset[2], 1.0);
    const std::uint32_t parent = model.joints()[chain.target].parent;
    const glm::dmat4 space = parent == kNone ? glm::dmat4(1.0) : glm::dmat4(pose.model_space()[parent]);
    if (std::abs(glm::determinant(space)) < 1e-30) return;
    const glm::vec3 place(glm::inverse(space) * tip);
    pose.change_local()[chain.target].translation = place;
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
        report(pose.model(), chain, reach(&chain, target, pose, options));
        carry_target(chain, pose);
    }
}

}  // namespace bendy::cli
