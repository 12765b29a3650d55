#include <bendy/format/chunk_writer.h>
#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <random>
#include <string>
#include <vector>

// bendy_bench_ik [TARGETS] [UNREACHABLE], default 10000 1000: how many targets the IK solvers reach, how fast, and
// whether they satisfy the constraints. The chains have 2, 5, 20 and 100 joints and a total length of one metre, and
// are free or constrained. Reachable targets are made by posing the chain at random inside its limits (all joints, up
// to 2 radians about each axis); targets out of reach are 1.1 to 3 metres away. Every solve starts from the rest pose,
// which is slightly bent, and succeeds within 0.1 % of the chain's length. A chain points at a target out of reach if
// the line from start to tip is within a degree of it. One core; the time is that of bendy::reach, including reading
// and writing the pose.
namespace {

using namespace bendy;

std::vector<std::byte> make_chain_file(std::uint32_t joints, bool is_constrained) {
    const auto radians = [](double degrees) { return static_cast<float>(degrees * M_PI / 180.0); };
    const float bone = 1.0f / static_cast<float>(joints);
    ChunkWriter out;
    out.begin(FourCC("HEAD"));
    VersionRecord version;
    version.objects = 1;
    version.joints = joints + 1;
    out.leaf(FourCC("VERS"), bytes_of(version));
    out.begin(FourCC("OBJE"));
    for (std::uint32_t joint = 0; joint <= joints; ++joint) {
        out.begin(FourCC("SKIN"));
        out.begin(FourCC("PIVO"));
        RestRecord rest;
        rest.translation = {0.0f, joint == 0 ? 0.0f : bone, 0.0f};
        const float bend = joint == 0 || joint == joints ? 0.0f : radians(joint % 2 == 0 ? -5.0 : 5.0);
        rest.rotation = {std::sin(bend / 2.0f), 0.0f, 0.0f, std::cos(bend / 2.0f)};
        out.leaf(FourCC("REST"), bytes_of(rest));
        if (is_constrained && joint < joints) {
            ConstraintRecord constraint;
            constraint.frame = {0.5f, 0.5f, 0.5f, 0.5f};  // X of the frame along the bone
            const auto set = [&](ConstraintModel model, std::array<double, 3> low, std::array<double, 3> high) {
                constraint.model = static_cast<std::uint8_t>(model);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    constraint.rotation_min[axis] = radians(low[axis]);
                    constraint.rotation_max[axis] = radians(high[axis]);
                }
            };
            // In turn: a shoulder, an elbow, and the constraints of a spine or a tentacle.
            switch (joint % 4) {
                case 0:
                    set(ConstraintModel::swing_twist_ellipse, {-45, -60, -90}, {45, 90, 60});
                    break;
                case 1:
                    set(ConstraintModel::hinge, {-10, 0, 0}, {140, 0, 0});
                    constraint.frame = {0.0f, 0.0f, 0.0f, 1.0f};
                    break;
                case 2:
                    set(ConstraintModel::euler_box, {-30, -40, -40}, {30, 40, 40});
                    break;
                default:
                    set(ConstraintModel::swing_twist_pyramid, {-20, -35, -35}, {20, 35, 35});
                    break;
            }
            out.leaf(FourCC("LIMT"), bytes_of(constraint));
        }
        out.end();
    }
    for (std::uint32_t joint = 0; joint <= joints; ++joint) out.end();
    out.begin(FourCC("IKCH"));
    ChainRecord chain;
    chain.effector = joints;
    out.leaf(FourCC("KINF"), bytes_of(chain));
    out.end();
    out.end();
    out.end();
    return std::move(out).finish();
}

glm::vec3 tip_of(Pose& pose) {
    const glm::vec4& position = pose.model_space().back()[3];
    return {position.x, position.y, position.z};
}

/// Sets a random pose inside the limits.
void pose_at_random(const Model& model, Pose& pose, std::mt19937& random) {
    std::uniform_real_distribution<double> angle(-2.0, 2.0);
    pose.set_rest();
    for (std::uint32_t joint = 0; joint + 1 < model.joints().size(); ++joint) {
        const glm::dvec3 turn(angle(random), angle(random), angle(random));
        const glm::dquat R = glm::angleAxis(glm::length(turn), glm::normalize(turn));
        const Constraint* constraint = model.constraint(joint);
        const glm::quat rest = model.joints()[joint].rest.rotation;
        JointTransform local = pose.local(joint);
        local.rotation = constraint == nullptr
                             ? glm::quat(glm::dquat(rest) * R)
                             : from_constraint_space(*constraint, rest, clamp_rotation(*constraint, R));
        pose.set_local(joint, local);
    }
}

struct Outcome {
    std::uint64_t solves = 0;
    std::uint64_t successes = 0;
    std::uint64_t iterations = 0;
    std::vector<double> microseconds;
    double worst_violation = 0.0;  // radians
    double farthest = 0.0;         // metres from the target
};

void solve(const Model& model, Pose& pose, const glm::vec3& target, const ReachOptions& options, bool is_reachable,
           Outcome& outcome) {
    pose.set_rest();
    const auto begin = std::chrono::steady_clock::now();
    const ReachResult result = *reach(pose, model.chains().data(), target, options);
    const auto end = std::chrono::steady_clock::now();
    outcome.microseconds.push_back(std::chrono::duration<double, std::micro>(end - begin).count());
    ++outcome.solves;
    outcome.iterations += result.iterations;
    const double left = glm::length(tip_of(pose) - target);  // measured on the pose, not taken from the solver
    if (is_reachable) {
        outcome.successes += left <= 0.001 + 1e-6 ? 1 : 0;
    } else {
        constexpr double kOneDegree = M_PI / 180.0;
        const glm::dvec3 tip = glm::normalize(glm::dvec3(tip_of(pose)));
        const double cosine = glm::dot(tip, glm::normalize(glm::dvec3(target)));
        outcome.successes += std::acos(std::min(cosine, 1.0)) <= kOneDegree ? 1 : 0;
    }
    outcome.farthest = std::max(outcome.farthest, left);
    for (std::uint32_t joint = 0; joint < model.joints().size(); ++joint) {
        const Constraint* constraint = model.ik_constraint(joint);
        if (constraint == nullptr) continue;
        const glm::dquat R =
            to_constraint_space(*constraint, model.joints()[joint].rest.rotation, pose.local(joint).rotation);
        outcome.worst_violation = std::max(outcome.worst_violation, violation(*constraint, R));
    }
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double percentile(std::vector<double>& values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void run(std::uint32_t joints, bool is_constrained, std::size_t reachable, std::size_t unreachable) {
    const std::vector<std::byte> bytes = make_chain_file(joints, is_constrained);
    const Result<Model> model = Model::from_memory(bytes);
    if (!model) {
        std::printf("%s\n", describe_with_place(model.error(), bytes).c_str());
        std::exit(1);
    }
    Pose pose(*model);
    std::mt19937 random(joints * 2 + (is_constrained ? 1 : 0));
    std::vector<glm::vec3> targets(reachable);
    for (glm::vec3& target : targets) {
        pose_at_random(*model, pose, random);
        target = tip_of(pose);
    }
    std::vector<glm::vec3> far(unreachable);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> distance(1.1f, 3.0f);
    for (glm::vec3& target : far)
        target = glm::normalize(glm::vec3(normal(random), normal(random), normal(random))) * distance(random);

    struct Row {
        Solver solver;
        const char* name;
    };
    constexpr std::array<Row, 3> kRows{
        {{Solver::pull, "pull, 200 frames"}, {Solver::two_bone, "two-bone"}, {Solver::least_squares, "least squares"}}};
    for (const Row& row : kRows) {
        if (row.solver == Solver::two_bone && joints != 2) continue;
        ReachOptions options;
        options.solver = row.solver;
        options.tolerance = 0.001f;
        options.softness = 0.0f;
        if (row.solver == Solver::pull) options.iterations = 200;
        Outcome near;
        Outcome beyond;
        for (const glm::vec3& target : targets) solve(*model, pose, target, options, true, near);
        for (const glm::vec3& target : far) solve(*model, pose, target, options, false, beyond);
        std::printf("| %3u | %-11s | %-16s | %6.2f %% | %6.1f | %7.2f | %7.2f | %7.2f | %6.2f %% | %7.2f | %8.1e |\n",
                    joints, is_constrained ? "constrained" : "free", row.name,
                    100.0 * static_cast<double>(near.successes) / static_cast<double>(near.solves),
                    static_cast<double>(near.iterations) / static_cast<double>(near.solves),
                    percentile(near.microseconds, 0.5), mean(near.microseconds), percentile(near.microseconds, 0.99),
                    100.0 * static_cast<double>(beyond.successes) /
                        static_cast<double>(std::max<std::uint64_t>(beyond.solves, 1)),
                    beyond.microseconds.empty() ? 0.0 : percentile(beyond.microseconds, 0.5),
                    std::max(near.worst_violation, beyond.worst_violation));
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::size_t reachable = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 10'000;
    const std::size_t unreachable = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 1'000;
    std::puts(
        "| joints | limits | solver | reached | iterations | us, median | mean | 99 % | far: points | us | violation, "
        "rad |");
    std::puts("|---|---|---|---|---|---|---|---|---|---|---|");
    for (const std::uint32_t joints : {2u, 5u, 20u, 100u}) {
        run(joints, false, reachable, unreachable);
        run(joints, true, reachable, unreachable);
    }
    return 0;
}
