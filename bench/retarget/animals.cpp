#include "bodies.h"

#include <bendy/runtime.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// bendy_bench_retarget_animals [--clips=PART] FILE...: puts each clip of each file, or those with PART in their names,
// on each file, and prints what three kinds of retargeting do: directions only, with limits, with limits and feet.
// Judged by the runtime's joint matrices; contacts are found here, by the height and speed of the source's ankles. All
// files need roles (spec/chunks/ROLE.md). run.py has three.js judge humans.
namespace {

using namespace bendy;

constexpr double kDegrees = 180.0 / M_PI;
constexpr double kRate = 60.0;    // frames a second
constexpr int kMostFrames = 600;  // of a clip
constexpr double kLow = 0.04;     // leg lengths: an ankle on the ground is at most that much above its rest
constexpr double kSlow = 0.3;     // leg lengths a second

/// Joints from hip or shoulder to foot or hand.
using Limb = std::vector<std::uint32_t>;
constexpr std::size_t kLegs = 2;  // the first limbs; of an animal, its front legs follow

Limb joints_of(const Model& model, Role role) {
    std::vector<JointRole> found;
    for (const JointRole& one : model.roles()) {
        if (static_cast<Role>(one.role) == role) found.push_back(one);
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.place < b.place; });
    Limb joints;
    for (const JointRole& one : found) joints.push_back(one.joint);
    return joints;
}

/// A character as the judge sees it: Y is up, and it faces along the nearest axis of model space.
class Rig {
public:
    explicit Rig(Model model) : model_(std::move(model)), pose_(model_) {
        for (const glm::mat4& matrix : pose_.model_space()) rest_.emplace_back(matrix);
        find_limbs();
        for (std::size_t leg = 0; leg < kLegs; ++leg) {
            for (std::size_t k = 0; k + 1 < limbs_[leg].size(); ++k)
                leg_ += 0.5 * glm::length(rest_place(limbs_[leg][k + 1]) - rest_place(limbs_[leg][k]));
        }
    }

    [[nodiscard]] const Model& model() const { return model_; }
    Pose& pose() { return pose_; }
    [[nodiscard]] double leg() const { return leg_; }
    [[nodiscard]] const std::vector<Limb>& limbs() const { return limbs_; }
    /// The limbs that have feet.
    [[nodiscard]] std::size_t feet() const { return is_animal_ ? limbs_.size() : kLegs; }
    [[nodiscard]] glm::dvec3 rest_place(std::uint32_t joint) const { return back_ * glm::dvec3(rest_[joint][3]); }
    glm::dvec3 place(std::uint32_t joint) { return back_ * glm::dvec3(pose_.model_space()[joint][3]); }
    glm::dvec3 way(const Limb& limb, std::size_t bone) {
        return glm::normalize(place(limb[bone + 1]) - place(limb[bone]));
    }
    [[nodiscard]] glm::dvec3 rest_way(const Limb& limb, std::size_t bone) const {
        return glm::normalize(rest_place(limb[bone + 1]) - rest_place(limb[bone]));
    }
    /// Since rest.
    glm::dquat turn(std::uint32_t joint) {
        const glm::dmat3 now(pose_.model_space()[joint]);
        const glm::dmat3 turn = now * glm::inverse(glm::dmat3(rest_[joint]));
        return back_ * glm::normalize(glm::quat_cast(turn)) * glm::conjugate(back_);
    }

private:
    void find_limbs() {
        using List = std::initializer_list<Role>;
        for (const List& roles : {List{Role::left_upper_leg, Role::left_lower_leg, Role::left_foot},
                                  List{Role::right_upper_leg, Role::right_lower_leg, Role::right_foot},
                                  List{Role::left_upper_arm, Role::left_lower_arm, Role::left_hand},
                                  List{Role::right_upper_arm, Role::right_lower_arm, Role::right_hand}}) {
            Limb limb;
            for (const Role role : roles) {
                for (const std::uint32_t joint : joints_of(model_, role)) limb.push_back(joint);
            }
            if (limb.size() == 3) limbs_.push_back(limb);
        }
        is_animal_ = limbs_.size() < 4;
        if (is_animal_) limbs_.clear();
        for (const Role role :
             {Role::left_hind_leg, Role::right_hind_leg, Role::left_front_leg, Role::right_front_leg}) {
            if (is_animal_ && !joints_of(model_, role).empty()) limbs_.push_back(joints_of(model_, role));
        }
        const glm::dvec3 across = rest_place(limbs_[0][0]) - rest_place(limbs_[1][0]);
        const double quarter = std::round(std::atan2(-across.z, across.x) / (0.5 * M_PI));
        back_ = glm::angleAxis(-quarter * 0.5 * M_PI, glm::dvec3(0, 1, 0));
        for (std::size_t k = 0; is_animal_ && k < limbs_.size(); ++k) cut(limbs_[k], k < kLegs);
    }

    /// Leaves out what carries a leg of an animal, and its paw.
    void cut(Limb& leg, bool is_hind) const {
        const glm::dvec3 first = glm::normalize(rest_place(leg[1]) - rest_place(leg[0]));
        if (leg.size() > 3 && (is_hind ? -first.z : first.z) > 0.3) leg.erase(leg.begin());
        std::size_t foot = 2;
        const double ground = rest_place(leg.back()).y;
        const auto height = [&](std::size_t k) { return rest_place(leg[k]).y - ground; };
        while (foot + 1 < leg.size() && height(foot) > 0.25 * height(0)) ++foot;
        leg.resize(foot + 1);
    }

    Model model_;
    Pose pose_;
    std::vector<glm::dmat4> rest_;
    glm::dquat back_{1, 0, 0, 0};
    double leg_ = 0.0;
    std::vector<Limb> limbs_;
    bool is_animal_ = false;
};

double angle_of(const glm::dquat& a, const glm::dquat& b) {
    const glm::dquat d = glm::conjugate(a) * b;
    return 2.0 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::abs(d.w)) * kDegrees;
}

double angle_of(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * kDegrees;
}

glm::dquat swing(const glm::dvec3& from, const glm::dvec3& to) {
    return glm::normalize(glm::dquat(1.0 + glm::dot(from, to), glm::cross(from, to)));
}

/// Adds up numbers of many frames.
struct Sum {
    double total = 0.0, most = 0.0;
    std::size_t count = 0;
    void add(double number) {
        total += number;
        most = std::max(most, number);
        ++count;
    }
    void add(const Sum& other) {
        total += other.total;
        most = std::max(most, other.most);
        count += other.count;
    }
    [[nodiscard]] double mean() const { return count == 0 ? 0.0 : total / static_cast<double>(count); }
};

struct Figures {
    Sum direction, twist;     // degrees
    Sum height;               // percent of the leg, of planted ankles
    Sum slide, source_slide;  // percent of the leg a frame
    Sum limited;              // 1 for a frame in which a limit acts
    Sum violated;             // 1 for a frame with a violated constraint
    Sum missed;               // percent of the leg
    Sum flips;                // of knees and elbows: largest step as a multiple of the source's
    Sum back;                 // degrees squared, there and back
    Sum microseconds;

    void add(const Figures& other) {
        for (Sum Figures::*sum : {&Figures::direction, &Figures::twist, &Figures::height, &Figures::slide,
                                  &Figures::source_slide, &Figures::limited, &Figures::violated, &Figures::missed,
                                  &Figures::flips, &Figures::back, &Figures::microseconds})
            (this->*sum).add(other.*sum);
    }
    void print(const std::string& what) const {
        std::printf("%-44s %6.2f %6.2f  %6.2f %6.2f  %5.1f %5.1f  %6.3f %6.3f %6.2f  %5.2f  %5.2f  %6.2f  %5.2f\n",
                    what.c_str(), direction.mean(), direction.most, twist.mean(), twist.most, 100.0 * limited.mean(),
                    100.0 * violated.mean(), source_slide.mean(), slide.mean(), height.most, missed.most, flips.most,
                    std::sqrt(back.mean()), microseconds.mean());
    }
};

bool is_violated(const Model& model, const Pose& pose) {
    return std::any_of(model.constraints().begin(), model.constraints().end(), [&](const Constraint& constraint) {
        if (model.constraint(constraint.joint) != &constraint) return false;
        const glm::quat rest = model.joints()[constraint.joint].rest.rotation;
        return violation(constraint, to_constraint_space(constraint, rest, pose.local(constraint.joint).rotation)) >
               1e-4;
    });
}

class Run {
public:
    Run(Rig& source, Rig& target, const RetargetOptions& options)
        : source_(source),
          target_(target),
          there_(*Retarget::make(source.model(), target.model(), options)),
          back_(*Retarget::make(target.model(), source.model(), {RestPoses::measured, false, false})),
          returned_(source.model()) {}

    Figures play(const Clip& clip) {
        figures_ = {};
        const int frames = std::clamp(static_cast<int>((clip.end - clip.start) * kRate), 1, kMostFrames);
        RetargetState state;
        Sum source_steps, steps;
        for (int frame = 0; frame < frames; ++frame) {
            if (!sample(source_.pose(), &clip, clip.start + static_cast<float>(frame / kRate))) continue;
            (void)source_.pose().model_space();
            const auto done = time_retarget(state);
            if (!done) continue;
            figures_.limited.add(done->turned > 0.0f ? 1.0 : 0.0);
            figures_.violated.add(is_violated(target_.model(), target_.pose()) ? 1.0 : 0.0);
            figures_.missed.add(100.0 * done->missed / target_.leg());
            judge_bones();
            judge_feet(frame > 0);
            judge_bends(frame > 0, source_steps, steps);
            judge_return();
        }
        if (steps.most > 1.0) figures_.flips.add(steps.most / std::max(source_steps.most, 1.0));
        return figures_;
    }

private:
    /// Notes the least time of several calls with the same state.
    Result<Retargeted, CallError> time_retarget(RetargetState& state) {
        const RetargetState before = state;
        double least = std::numeric_limits<double>::infinity();
        Result<Retargeted, CallError> done = CallError::missing;
        for (int k = 0; k < 4; ++k) {
            state = before;
            const auto begin = std::chrono::steady_clock::now();
            done = retarget(target_.pose(), there_, source_.pose(), state);
            const auto end = std::chrono::steady_clock::now();
            least = std::min(least, std::chrono::duration<double, std::micro>(end - begin).count());
        }
        figures_.microseconds.add(least);
        return done;
    }

    void judge_bones() {
        for (std::size_t k = 0; k < target_.limbs().size(); ++k) {
            const Limb& from = source_.limbs()[k];
            const Limb& to = target_.limbs()[k];
            for (std::size_t bone = 0; bone + 1 < std::min(from.size(), to.size()); ++bone) {
                figures_.direction.add(angle_of(source_.way(from, bone), target_.way(to, bone)));
                const glm::dquat align = swing(target_.rest_way(to, bone), source_.rest_way(from, bone));
                const glm::dquat off =
                    glm::conjugate(source_.turn(from[bone])) * target_.turn(to[bone]) * glm::conjugate(align);
                const glm::dvec3 axis = source_.rest_way(from, bone);
                figures_.twist.add(2.0 * std::abs(std::atan(glm::dot(glm::dvec3(off.x, off.y, off.z), axis) / off.w)) *
                                   kDegrees);
            }
        }
    }

    void judge_feet(bool has_last) {
        for (std::size_t k = 0; k < target_.feet(); ++k) {
            const std::uint32_t source_foot = source_.limbs()[k].back(), foot = target_.limbs()[k].back();
            const glm::dvec3 from = source_.place(source_foot) / source_.leg();
            const glm::dvec3 to = target_.place(foot) / target_.leg();
            const double height = from.y - source_.rest_place(source_foot).y / source_.leg();
            const auto flat = [](const glm::dvec3& way) { return std::hypot(way.x, way.z); };
            const double slide = flat(from - from_[k]);
            if (has_last && height < kLow && slide * kRate < kSlow) {
                figures_.source_slide.add(100.0 * slide);
                figures_.slide.add(100.0 * flat(to - to_[k]));
                figures_.height.add(100.0 * std::abs(to.y - target_.rest_place(foot).y / target_.leg() - height));
            }
            from_[k] = from;
            to_[k] = to;
        }
    }

    void judge_bends(bool has_last, Sum& source_steps, Sum& steps) {
        for (std::size_t k = 0; k < target_.limbs().size(); ++k) {
            const glm::dquat from(source_.pose().local(source_.limbs()[k][1]).rotation);
            const glm::dquat to(target_.pose().local(target_.limbs()[k][1]).rotation);
            if (has_last) source_steps.add(angle_of(from, bend_from_[k]));
            if (has_last) steps.add(angle_of(to, bend_to_[k]));
            bend_from_[k] = from;
            bend_to_[k] = to;
        }
    }

    void judge_return() {
        RetargetState state;
        if (!retarget(returned_, back_, target_.pose(), state)) return;
        for (std::size_t k = 0; k < target_.limbs().size(); ++k) {
            const Limb& limb = source_.limbs()[k];
            for (std::size_t bone = 0; bone + 1 < std::min(limb.size(), target_.limbs()[k].size()); ++bone) {
                const double angle = angle_of(glm::dquat(source_.pose().local(limb[bone]).rotation),
                                              glm::dquat(returned_.local(limb[bone]).rotation));
                figures_.back.add(angle * angle);
            }
        }
    }

    Rig& source_;
    Rig& target_;
    Retarget there_, back_;
    Pose returned_;
    Figures figures_;
    std::array<glm::dvec3, 4> from_{}, to_{};
    std::array<glm::dquat, 4> bend_from_{}, bend_to_{};
};

void compare(std::vector<std::pair<std::string, Rig>>& rigs, const std::string& part) {
    struct Kind {
        const char* name;
        RetargetOptions options;
    };
    const Kind kinds[] = {{"directions", {RestPoses::measured, false, false}},
                          {"limits", {RestPoses::measured, true, false}},
                          {"feet", {RestPoses::measured, false, true}},
                          {"limits and feet", {RestPoses::measured, true, true}}};
    std::printf("%-44s %6s %6s  %6s %6s  %5s %5s  %6s %6s %6s  %5s  %5s  %6s  %5s\n", "", "dir", "most", "twist",
                "most", "lim %", "viol", "slide0", "slide", "height", "miss", "flips", "back", "us");
    for (const Kind& kind : kinds) {
        Figures all;
        for (auto& [from_name, from] : rigs) {
            if (from.model().clips().empty()) continue;
            for (auto& [to_name, to] : rigs) {
                if (&from == &to || !Retarget::make(from.model(), to.model())) continue;
                Figures pair;
                Run run(from, to, kind.options);
                for (const Clip& clip : from.model().clips()) {
                    if (clip.name.find(part) != std::string_view::npos) pair.add(run.play(clip));
                }
                pair.print(std::string(kind.name).append(" ").append(from_name).append(" > ").append(to_name));
                all.add(pair);
            }
        }
        all.print(std::string(kind.name) + ", all");
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::string_view option = "--clips=";
    std::string part;
    std::vector<const char*> paths;
    for (int k = 1; k < argc; ++k) {
        if (std::string_view(argv[k]).starts_with(option)) {
            part = std::string_view(argv[k]).substr(option.size());
        } else {
            paths.push_back(argv[k]);
        }
    }
    const auto bodies = bench::open_bodies(paths);
    if (!bodies) return 1;
    std::vector<std::pair<std::string, Rig>> rigs;
    for (const auto& [path, model] : *bodies)
        rigs.emplace_back(std::filesystem::path(path).stem().string(), Rig(model));
    compare(rigs, part);
    return 0;
}
