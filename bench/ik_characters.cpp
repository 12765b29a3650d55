#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <random>
#include <string>
#include <vector>

// bendy_bench_ik_characters [--targets N] [--free] [--limbs] [--mirror] FILE.bendy...: how many targets each IK solver
// reaches with the chains of characters; 1000 targets per chain by default. Targets are made by posing the chain at
// random inside its constraints; every solve starts from the rest pose. A solver misses a target if it stops outside
// its tolerance. `alone` counts the misses that another solver reaches, and `farthest` is the largest distance among
// those.
//     --free    ignores constraints
//     --limbs   prints one row per chain, for its default solver, and counts every miss
//     --mirror  reaches with each chain "Left..." and its "Right..." for targets mirrored in X, and counts the poses
//     that
//               are not mirrored: those with a joint off by more than a thousandth of the chain's length. Every other
//               target is moved by up to 0.2 m along each axis, so that some are out of reach
namespace {

using namespace bendy;

struct Row {
    Solver solver;
    const char* name;
};
constexpr std::array<Row, 4> kRows{{{Solver::any, "any"},
                                    {Solver::pull, "pull, 200 frames"},
                                    {Solver::two_bone, "two-bone"},
                                    {Solver::least_squares, "least squares"}}};

glm::vec3 tip_of(const Chain& chain, Pose& pose) {
    const auto& offset = chain.record.tip_offset;
    return {pose.model_space()[chain.record.effector] * glm::vec4(offset[0], offset[1], offset[2], 1.0f)};
}

/// Returns the joints that the chain turns, from the effector up.
std::vector<std::uint32_t> joints_of(const Model& model, const Chain& chain) {
    std::vector<std::uint32_t> joints;
    for (std::uint32_t joint = chain.record.effector;; joint = model.joints()[joint].parent) {
        const auto weights = model.chain_weights(chain);
        const bool is_fixed = std::any_of(weights.begin(), weights.end(), [&](const ChainWeightView& chain_weight) {
            return chain_weight.joint == joint && chain_weight.weight == 0.0f;
        });
        if (!is_fixed) joints.push_back(joint);
        if (joint == chain.record.start) break;
    }
    return joints;
}

void pose_at_random(const Model& model, const Chain& chain, bool is_free, Pose& pose, std::mt19937& random) {
    std::uniform_real_distribution<double> angle(-2.0, 2.0);
    pose.set_rest();
    for (const std::uint32_t joint : joints_of(model, chain)) {
        const glm::dvec3 turn(angle(random), angle(random), angle(random));
        const glm::dquat R = glm::angleAxis(glm::length(turn), glm::normalize(turn));
        const Constraint* constraint = is_free ? nullptr : model.ik_constraint(joint);
        const glm::quat rest = model.joints()[joint].rest.rotation;
        JointTransform local = pose.local(joint);
        local.rotation = constraint == nullptr
                             ? glm::quat(glm::dquat(rest) * R)
                             : from_constraint_space(*constraint, rest, clamp_rotation(*constraint, R));
        pose.set_local(joint, local);
    }
}

struct Tally {
    std::size_t reached = 0;
    std::size_t alone = 0;
    double farthest = 0.0;
    glm::vec3 where{0.0f};
    double microseconds = 0.0;
};

void run(const std::string& file, const Model& model, const Chain& chain, std::size_t targets, bool is_free,
         bool only_default) {
    Pose pose(model);
    std::mt19937 random(static_cast<std::uint32_t>(&chain - model.chains().data()) + 1);
    std::array<Tally, kRows.size()> tallies;
    for (std::size_t n = 0; n < targets; ++n) {
        pose_at_random(model, chain, is_free, pose, random);
        const glm::vec3 target = tip_of(chain, pose);
        std::array<bool, kRows.size()> reached{};
        std::array<double, kRows.size()> left{};
        for (std::size_t row = 0; row < (only_default ? 1 : kRows.size()); ++row) {
            pose.set_rest();
            ReachOptions options;
            options.solver = kRows[row].solver;
            options.obey_constraints = !is_free;
            if (options.solver == Solver::pull) options.iterations = 200;
            const auto begin = std::chrono::steady_clock::now();
            const ReachResult result = *reach(pose, &chain, target, options);
            const auto end = std::chrono::steady_clock::now();
            tallies[row].microseconds += std::chrono::duration<double, std::micro>(end - begin).count();
            reached[row] = result.status == ReachStatus::reached;
            left[row] = glm::length(tip_of(chain, pose) - target);
            tallies[row].reached += reached[row] ? 1 : 0;
        }
        const bool any = std::find(reached.begin(), reached.end(), true) != reached.end();
        for (std::size_t row = 0; row < kRows.size() && (any || only_default); ++row) {
            if (only_default && row > 0) break;
            if (reached[row]) continue;
            ++tallies[row].alone;
            if (left[row] <= tallies[row].farthest) continue;
            tallies[row].farthest = left[row];
            tallies[row].where = target;
        }
    }
    const std::size_t slash = file.find_last_of('/');
    const std::string stem = slash == std::string::npos ? file : file.substr(slash + 1);
    for (std::size_t row = 0; row < (only_default ? 1 : kRows.size()); ++row) {
        const Tally& t = tallies[row];
        std::printf("| %-24s | %-16s | %3u | %-16s | %6.2f %% | %5zu | %8.4f | %8.2f | %g,%g,%g\n", stem.c_str(),
                    std::string(chain.name).c_str(), chain.links, kRows[row].name,
                    100.0 * static_cast<double>(t.reached) / static_cast<double>(targets), t.alone, t.farthest,
                    t.microseconds / static_cast<double>(targets), t.where.x, t.where.y, t.where.z);
    }
}

std::string mirrored_name(std::string name) {
    for (const auto& [one, other] : {std::pair("Left", "Right"), std::pair("left", "right"), std::pair("_L", "_R"),
                                     std::pair(".L", ".R"), std::pair("_l", "_r"), std::pair(".l", ".r")}) {
        const std::size_t at = name.find(one);
        if (at != std::string::npos) return name.replace(at, std::strlen(one), other);
    }
    return {};
}

glm::vec3 mirrored(const glm::vec3& v) {
    return {-v.x, v.y, v.z};
}

void run_mirrored(const std::string& file, const Model& model, const Chain& left, std::size_t targets, bool is_free) {
    const Chain* right = model.chain(mirrored_name(std::string(left.name)));
    if (right == nullptr || right->links != left.links) return;
    Pose one(model);
    Pose other(model);
    const std::vector<std::uint32_t> left_joints = joints_of(model, left);
    const std::vector<std::uint32_t> right_joints = joints_of(model, *right);
    for (const Row& row : kRows) {
        std::mt19937 random(static_cast<std::uint32_t>(&left - model.chains().data()) + 1);
        std::uniform_real_distribution<float> aside(-0.2f, 0.2f);
        std::size_t unlike = 0;
        std::size_t unlike_end = 0;
        double worst = 0.0;
        glm::vec3 where{0.0f};
        for (std::size_t n = 0; n < targets; ++n) {
            pose_at_random(model, left, is_free, one, random);
            glm::vec3 target = tip_of(left, one);
            if (n % 2 == 1) target += glm::vec3(aside(random), aside(random), aside(random));
            ReachOptions options;
            options.solver = row.solver;
            options.obey_constraints = !is_free;
            if (options.solver == Solver::pull) options.iterations = 200;
            one.set_rest();
            other.set_rest();
            const ReachResult a = *reach(one, &left, target, options);
            const ReachResult b = *reach(other, right, mirrored(target), options);
            const glm::vec3 tip = tip_of(left, one);
            double off = glm::length(tip - mirrored(tip_of(*right, other)));
            double length = glm::length(tip - glm::vec3(one.model_space()[left_joints.front()][3]));
            for (std::size_t i = 0; i < left_joints.size(); ++i) {
                const glm::vec3 p(one.model_space()[left_joints[i]][3]);
                const glm::vec3 q(other.model_space()[right_joints[i]][3]);
                off = std::max(off, double{glm::length(p - mirrored(q))});
                if (i > 0) length += glm::length(p - glm::vec3(one.model_space()[left_joints[i - 1]][3]));
            }
            unlike_end += a.status != b.status ? 1 : 0;
            unlike += off > 1e-3 * length ? 1 : 0;
            if (off <= worst) continue;
            worst = off;
            where = target;
        }
        const std::size_t slash = file.find_last_of('/');
        std::printf("| %-24s | %-16s | %3u | %-16s | unlike %5zu | other end %5zu | worst, m %8.4f | %g,%g,%g\n",
                    file.substr(slash == std::string::npos ? 0 : slash + 1).c_str(), std::string(left.name).c_str(),
                    left.links, row.name, unlike, unlike_end, worst, where.x, where.y, where.z);
    }
}

}  // namespace

int main(int argc, char** argv) {
    std::size_t targets = 1000;
    bool is_free = false;
    bool only_default = false;
    bool is_mirrored = false;
    std::puts("| file | chain | links | solver | reached | alone | farthest, m | us, mean | where");
    std::puts("|---|---|---|---|---|---|---|---|---|");
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--targets" && i + 1 < argc) {
            targets = std::strtoul(argv[++i], nullptr, 10);
        } else if (argument == "--free") {
            is_free = true;
        } else if (argument == "--limbs") {
            only_default = true;
        } else if (argument == "--mirror") {
            is_mirrored = true;
        } else {
            const Result<Model> model = Model::open(argument);
            if (!model) {
                std::fprintf(stderr, "%s: %s\n", argv[i], describe(model.error()).c_str());
                return 1;
            }
            for (const Chain& chain : model->chains()) {
                if (chain.solver() == Solver::aim) continue;
                if (is_mirrored) {
                    run_mirrored(argument, *model, chain, targets, is_free);
                } else {
                    run(argument, *model, chain, targets, is_free, only_default);
                }
            }
        }
    }
    return 0;
}
