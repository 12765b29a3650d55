#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

// bendy_bench_body_reach [TARGETS] FILE...: full-body IK, hands, feet and head at once, on humans with roles and limits
// (convert --auto-rig). Reachable targets are made by posing the human at random inside its limits: each joint by up to
// 1 radian about each axis, the hips up to half of the range in which the solver may move and turn them. Every solve
// starts at rest. Prints how many sets of five targets are reached within 1 mm times the human's height in units of 1.7
// m, violated constraints, and microseconds, the least of three tries each; and jumps: where the targets go from one
// set to the next within a second of 60 frames, the share of frames in which a joint turns by over 5 degrees more than
// three times what the targets move, in halves of the height. One core.
namespace {

using namespace bendy;

constexpr Role kEffectors[] = {Role::left_hand, Role::right_hand, Role::left_foot, Role::right_foot, Role::head};
constexpr double kHeight = 1.7;

std::uint32_t joint_of(const Model& model, Role role) {
    for (const JointRole& one : model.roles()) {
        if (static_cast<Role>(one.role) == role) return one.joint;
    }
    return kNone;
}

class Trial {
public:
    Trial(const Model& model, const std::vector<Effector>& effectors)
        : model_(model), effectors_(effectors), posed_(model), pose_(model), root_(joint_of(model, Role::hips)) {
        double low = 1e9, high = -1e9;
        for (const auto& matrix : posed_.model_space()) {
            low = std::min(low, double{matrix[3].y});
            high = std::max(high, double{matrix[3].y});
        }
        height_ = high - low;
        for (const Effector& one : effectors) {
            for (std::uint32_t joint = one.joint; joint != root_ && joint != kNone; joint = model.parents()[joint])
                moving_.push_back(joint);
        }
        std::sort(moving_.begin(), moving_.end());
        moving_.erase(std::unique(moving_.begin(), moving_.end()), moving_.end());
        options_.root = root_;
        options_.root_shift = glm::vec3(static_cast<float>(0.2 * height_));
        options_.root_turn = 0.6f;
    }

    void run(int count) {
        auto body = BodyReach::make(model_, effectors_, options_);
        if (!body) return (void)std::printf("| %s |\n", error_text(body.error()));
        int reached = 0, within = 0;
        double worst_violation = 0.0, iterations = 0.0;
        std::vector<double> times;
        for (int k = 0; k < count; ++k) {
            const std::vector<EffectorTarget> targets = random_targets();
            double least = 1e9;  // of several tries: other programs interrupt
            BodyReached result;
            for (int again = 0; again < 3; ++again) {
                pose_.set_rest();
                (void)pose_.model_space();
                const auto start = std::chrono::steady_clock::now();
                const auto tried = reach(pose_, *body, targets);
                const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
                if (!tried) std::exit(1);
                least = std::min(least, took.count());
                result = *tried;
            }
            times.push_back(least);
            reached += result.is_reached ? 1 : 0;
            iterations += result.iterations;
            double farthest = 0.0;
            for (std::size_t e = 0; e < effectors_.size(); ++e) {
                const glm::dvec3 at(pose_.model_space()[effectors_[e].joint][3]);
                farthest = std::max(farthest, glm::length(at - glm::dvec3(targets[e].position)));
            }
            within += farthest <= 1e-3 * height_ / kHeight ? 1 : 0;
            for (const std::uint32_t joint : moving_) {
                const Constraint* constraint = model_.ik_constraint(joint);
                if (constraint == nullptr) continue;
                const Constraint& one = *constraint;
                const auto R =
                    to_constraint_space(one, model_.joints()[one.joint].rest.rotation, pose_.local(one.joint).rotation);
                worst_violation = std::max(worst_violation, violation(one, R));
            }
        }
        std::sort(times.begin(), times.end());
        double sum = 0.0;
        for (const double t : times) sum += t;
        std::printf("| %.1f | %.1f | %.1e | %.1f | %.0f / %.0f / %.0f / %.0f | %.2f %% |\n", 100.0 * within / count,
                    100.0 * reached / count, worst_violation, iterations / count, sum / count, times[times.size() / 2],
                    times[times.size() * 99 / 100], times.back(), 100.0 * share_of_jumps(*body, 1 + count / 50));
    }

private:
    std::vector<EffectorTarget> random_targets() {
        pose_at_random();
        std::vector<EffectorTarget> targets;
        for (const Effector& one : effectors_) targets.push_back({glm::vec3(posed_.model_space()[one.joint][3]), {}});
        return targets;
    }

    /// The targets go from one set to the next in a second of 60 frames, some of them out of reach on the way.
    double share_of_jumps(BodyReach& body, int ways) {
        constexpr int kFrames = 60;
        constexpr double kMost = 5.0 * 3.14159265358979 / 180.0;
        int jumps = 0;
        std::vector<EffectorTarget> to = random_targets();
        for (int way = 0; way < ways; ++way) {
            const std::vector<EffectorTarget> from = std::exchange(to, random_targets());
            std::vector<glm::dquat> before;
            for (int frame = 0; frame <= kFrames; ++frame) {
                std::vector<EffectorTarget> targets = from;
                double moved = 0.0;
                for (std::size_t e = 0; e < targets.size(); ++e) {
                    const glm::vec3 all = to[e].position - from[e].position;
                    targets[e].position += all * (static_cast<float>(frame) / kFrames);
                    moved = std::max(moved, double{glm::length(all)} / kFrames);
                }
                pose_.set_rest();
                if (!reach(pose_, body, targets)) std::exit(1);
                double most = 0.0;
                for (std::size_t i = 0; i < moving_.size(); ++i) {
                    const glm::dquat now(pose_.local(moving_[i]).rotation);
                    if (frame > 0) {
                        const double same = std::min(1.0, std::abs(glm::dot(glm::normalize(now), before[i])));
                        most = std::max(most, 2.0 * std::acos(same));
                        before[i] = glm::normalize(now);
                    } else {
                        before.push_back(glm::normalize(now));
                    }
                }
                jumps += most > kMost + 3.0 * moved / (0.5 * height_) ? 1 : 0;
            }
        }
        return static_cast<double>(jumps) / (ways * kFrames);
    }

    void pose_at_random() {
        std::uniform_real_distribution<double> angle(-1.0, 1.0);
        posed_.set_rest();
        for (const std::uint32_t joint : moving_)
            turn(joint, glm::dvec3(angle(random_), angle(random_), angle(random_)));
        turn(root_, glm::dvec3(angle(random_), angle(random_), angle(random_)) * (0.5 * 0.6 / std::sqrt(3.0)));
        JointTransform local = posed_.local(root_);
        const glm::dmat3 space(
            posed_.model_space()[model_.parents()[root_] == kNone ? root_ : model_.parents()[root_]]);
        const glm::dvec3 shift = 0.1 * height_ * glm::dvec3(angle(random_), angle(random_), angle(random_));
        local.translation += glm::vec3(model_.parents()[root_] == kNone ? shift : glm::inverse(space) * shift);
        posed_.set_local(root_, local);
    }

    void turn(std::uint32_t joint, const glm::dvec3& vector) {
        const glm::dquat R = glm::angleAxis(glm::length(vector), glm::normalize(vector));
        const Constraint* constraint = model_.ik_constraint(joint);
        const glm::quat rest = model_.joints()[joint].rest.rotation;
        JointTransform local = posed_.local(joint);
        local.rotation = constraint == nullptr
                             ? glm::quat(glm::dquat(rest) * R)
                             : from_constraint_space(*constraint, rest, clamp_rotation(*constraint, R));
        posed_.set_local(joint, local);
    }

    const Model& model_;
    const std::vector<Effector>& effectors_;
    Pose posed_, pose_;
    std::uint32_t root_;
    std::vector<std::uint32_t> moving_;  ///< joints below the root
    double height_ = 1.0;
    BodyReachOptions options_;
    std::mt19937 random_{1};
};

}  // namespace

int main(int count, char** arguments) {
    int targets = 10000;
    std::printf(
        "| human | %% within 1 mm | %% reached | violation, rad | iterations | us, mean / median / 99 %% / "
        "most | jumps |\n|---|---|---|---|---|---|---|\n");
    for (int k = 1; k < count; ++k) {
        if (const int number = std::atoi(arguments[k]); number > 0) {
            targets = number;
            continue;
        }
        const auto model = Model::open(arguments[k]);
        if (!model) return 1;
        std::vector<Effector> effectors;
        for (const Role role : kEffectors) {
            const std::uint32_t joint = joint_of(*model, role);
            if (joint != kNone) effectors.push_back({joint});
        }
        std::printf("| %s (%zu) ", arguments[k], effectors.size());
        if (effectors.size() < 5) {
            std::printf("| no human |\n");
            continue;
        }
        Trial(*model, effectors).run(targets);
    }
}
