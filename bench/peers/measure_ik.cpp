#include "made_models.h"
#include "sections.h"

#include <ozz/animation/runtime/ik_aim_job.h>
#include <ozz/animation/runtime/ik_two_bone_job.h>
#include <ozz/base/maths/simd_quaternion.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <random>

namespace bendy::bench {
namespace {

using ozz::math::SimdQuaternion;
using ozz::math::SoaTransform;

/// Multiplies a joint's local rotation by a correction, as ozz's samples do.
void apply(int joint, const SimdQuaternion& correction, std::vector<SoaTransform>& locals) {
    SoaTransform& soa = locals[static_cast<std::size_t>(joint / 4)];
    SimdQuaternion rotations[4];
    ozz::math::Transpose4x4(&soa.rotation.x, &rotations->xyzw);
    SimdQuaternion& rotation = rotations[joint & 3];
    rotation = rotation * correction;
    ozz::math::Transpose4x4(&rotations->xyzw, &soa.rotation.x);
}

glm::vec3 place_of(const OzzState& state, int joint) {
    float place[4];
    ozz::math::StorePtrU(state.models[static_cast<std::size_t>(joint)].cols[3], place);
    return {place[0], place[1], place[2]};
}

glm::vec3 place_of(Pose& pose, std::uint32_t joint) {
    return {pose.model_space()[joint][3]};
}

std::string short_text(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", number);
    return text;
}

// --- a chain alone

std::vector<glm::vec3> make_targets() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    std::vector<glm::vec3> targets;
    for (int k = 0; k < 64; ++k)
        targets.emplace_back(0.2f * number(random), 0.7f + 0.15f * number(random), 0.35f + 0.2f * number(random));
    return targets;
}

/// ozz's job for make_chain's chain.
class OzzChain {
public:
    OzzChain(OzzState& state, bool is_aim) : state_(state), rest_(state.locals), is_aim_(is_aim) {
        state_.local_to_model();
    }

    void set_rest() { state_.locals = rest_; }

    void solve(const glm::vec3& target) {
        if (is_aim_) {
            ozz::animation::IKAimJob job;
            job.target = simd_of(target);
            job.forward = ozz::math::simd_float4::z_axis();
            job.up = ozz::math::simd_float4::y_axis();
            job.pole_vector = ozz::math::simd_float4::z_axis();
            job.joint = state_.models.data();
            job.joint_correction = &start_;
            job.reached = &is_reached_;
            check(job.Run(), "ozz's IKAimJob");
            return;
        }
        ozz::animation::IKTwoBoneJob job;
        job.target = simd_of(target);
        job.mid_axis = ozz::math::simd_float4::x_axis();
        job.pole_vector = ozz::math::simd_float4::z_axis();
        job.start_joint = state_.models.data();
        job.mid_joint = state_.models.data() + 1;
        job.end_joint = state_.models.data() + 2;
        job.start_joint_correction = &start_;
        job.mid_joint_correction = &middle_;
        job.reached = &is_reached_;
        check(job.Run(), "ozz's IKTwoBoneJob");
    }

    void apply_corrections() {
        apply(0, start_, state_.locals);
        if (!is_aim_) apply(1, middle_, state_.locals);
    }

private:
    OzzState& state_;
    std::vector<SoaTransform> rest_;
    SimdQuaternion start_, middle_;
    bool is_aim_;
    bool is_reached_ = true;
};

/// How far both sides' tips are from their targets.
void note_distances(Table& table, const char* name, const Model& model, OzzState& state, OzzChain& chain,
                    const std::vector<glm::vec3>& targets) {
    constexpr std::uint32_t kTip = 2;
    Pose pose(model);
    float ours = 0.0f, theirs = 0.0f;
    for (const glm::vec3& target : targets) {
        check(reach(pose, &model.chains().front(), target).has_value(), "reach");
        ours = std::max(ours, glm::distance(place_of(pose, kTip), target));
        chain.set_rest();
        state.local_to_model();
        chain.solve(target);
        chain.apply_corrections();
        state.local_to_model();
        theirs = std::max(theirs, glm::distance(place_of(state, kTip), target));
    }
    table.add_note(std::string(name) + ": at most " + short_text(ours) + " m from the target, ozz " +
                   short_text(theirs) + " m");
}

// --- limbs of a character

struct Limb {
    const Chain* chain = nullptr;
    std::uint32_t middle = 0;                        ///< our joint
    int ozz_start = 0, ozz_middle = 0, ozz_end = 0;  ///< ozz's joints
    glm::vec3 middle_axis{1.0f, 0.0f, 0.0f};         ///< of the middle joint, in its own space: opens the limb
};

/// The axis about which a limb opens at rest; x if it is straight.
glm::vec3 find_axis(Pose& rest, const Chain& chain, std::uint32_t middle) {
    const glm::vec3 place = place_of(rest, middle);
    const glm::vec3 axis =
        glm::cross(place_of(rest, chain.record.start) - place, place_of(rest, chain.record.effector) - place);
    const glm::vec3 local = glm::inverse(glm::mat3(rest.model_space()[middle])) * axis;
    const float length = glm::length(local);
    return length > 0.0f ? local / length : glm::vec3(1.0f, 0.0f, 0.0f);
}

std::vector<Limb> find_limbs(const Character& character) {
    constexpr std::uint32_t kLinks = 3;
    Pose rest(character.model);
    std::vector<Limb> limbs;
    for (const Chain& chain : character.model.chains()) {
        if (chain.links != kLinks || (chain.solver() != Solver::two_bone && chain.solver() != Solver::any)) continue;
        const bool is_known = std::any_of(limbs.begin(), limbs.end(), [&](const Limb& limb) {
            return limb.chain->record.start == chain.record.start &&
                   limb.chain->record.effector == chain.record.effector;
        });
        if (is_known) continue;  // proposed by --auto-rig for a character that has one already
        Limb limb;
        limb.chain = &chain;
        limb.middle = character.model.joints()[chain.record.effector].parent;
        const auto ozz = [&](std::uint32_t joint) { return static_cast<int>(character.ozz.theirs_of[joint]); };
        limb.ozz_start = ozz(chain.record.start);
        limb.ozz_middle = ozz(limb.middle);
        limb.ozz_end = ozz(chain.record.effector);
        limb.middle_axis = find_axis(rest, chain, limb.middle);
        limbs.push_back(limb);
    }
    return limbs;
}

const glm::vec3 kBeside(0.01f, 0.02f, -0.015f);  // metres from the effector in the clip to its target

/// A frame on our side, with all limbs or none.
class OurFrame {
public:
    OurFrame(const Character& character, const std::vector<Limb>& limbs)
        : clip_(character.model.clips().front()),
          limbs_(limbs),
          pose_(character.model),
          times_{clip_.end - clip_.start},
          requests_(limbs.size()),
          results_(limbs.size()) {
        for (std::size_t k = 0; k < limbs.size(); ++k) requests_[k].chain = limbs[k].chain;
    }

    void run(bool reaches, bool obeys) {
        sample_at(pose_, clip_, clip_.start + times_.next());
        if (reaches) {
            find_targets();
            for (ReachRequest& request : requests_) request.options.obey_constraints = obeys;
            check(reach(pose_, requests_, results_).has_value(), "reach");
            for (const ReachResult& result : results_) reached_ += result.status == ReachStatus::reached ? 1 : 0;
            solved_ += static_cast<long>(results_.size());
        }
        (void)pose_.model_space();
        make_palettes(pose_);
    }

    /// Percent of the solves since the last call.
    double take_reached() {
        const double percent = 100.0 * static_cast<double>(reached_) / static_cast<double>(std::max(solved_, 1L));
        reached_ = solved_ = 0;
        return percent;
    }

private:
    /// All before any limb moves.
    void find_targets() {
        for (std::size_t k = 0; k < limbs_.size(); ++k) {
            const glm::vec3 start = place_of(pose_, limbs_[k].chain->record.start);
            const glm::vec3 middle = place_of(pose_, limbs_[k].middle);
            ReachRequest& request = requests_[k];
            request.target = place_of(pose_, limbs_[k].chain->record.effector) + kBeside;
            request.options.pole = middle + (middle - 0.5f * (start + request.target.position));
        }
    }

    const Clip& clip_;
    const std::vector<Limb>& limbs_;
    Pose pose_;
    FrameTimes times_;
    std::vector<ReachRequest> requests_;
    std::vector<ReachResult> results_;
    long reached_ = 0, solved_ = 0;
};

/// The same on ozz's.
class OzzFrame {
public:
    OzzFrame(const Character& character, const std::vector<Limb>& limbs)
        : clip_(*character.ozz.clips.front().plain),
          limbs_(limbs),
          state_(character.ozz),
          times_{character.model.clips().front().end - character.model.clips().front().start} {}

    void run(bool reaches) {
        state_.sample(clip_, times_.next());
        state_.local_to_model();
        for (std::size_t k = 0; reaches && k < limbs_.size(); ++k) solve(limbs_[k]);
        state_.make_palettes();
    }

    /// The farthest that a limb stays from its target in a frame, in metres.
    float distance_left() {
        state_.sample(clip_, times_.next());
        state_.local_to_model();
        float worst = 0.0f;
        for (const Limb& limb : limbs_) {
            const glm::vec3 target = place_of(state_, limb.ozz_end) + kBeside;
            solve(limb);
            worst = std::max(worst, glm::distance(place_of(state_, limb.ozz_end), target));
        }
        return worst;
    }

private:
    void solve(const Limb& limb) {
        const auto matrix = [&](int joint) { return &state_.models[static_cast<std::size_t>(joint)]; };
        SimdQuaternion start, middle;
        bool is_reached = true;
        ozz::animation::IKTwoBoneJob job;
        job.target = matrix(limb.ozz_end)->cols[3] + simd_of(kBeside);
        job.mid_axis = simd_of(limb.middle_axis);
        job.pole_vector = matrix(limb.ozz_middle)->cols[3] - matrix(limb.ozz_start)->cols[3];
        job.start_joint = matrix(limb.ozz_start);
        job.mid_joint = matrix(limb.ozz_middle);
        job.end_joint = matrix(limb.ozz_end);
        job.start_joint_correction = &start;
        job.mid_joint_correction = &middle;
        job.reached = &is_reached;
        check(job.Run(), "ozz's IKTwoBoneJob");
        apply(limb.ozz_start, start, state_.locals);
        apply(limb.ozz_middle, middle, state_.locals);
        state_.local_to_model(limb.ozz_start);
    }

    const ozz::animation::Animation& clip_;
    const std::vector<Limb>& limbs_;
    OzzState state_;
    FrameTimes times_;
};

}  // namespace

void measure_chain(Table& table, Solver solver) {
    const bool is_aim = solver == Solver::aim;
    const auto made = make_chain(solver, false);
    const OzzCharacter character = make_ozz(made->model);
    OzzState state(character);
    OzzChain theirs(state, is_aim);
    const std::vector<glm::vec3> targets = make_targets();
    const char* const name = is_aim ? "aim, pole" : "two bones, pole";
    const auto all = [&](bool makes_matrices, bool applies) {
        return [&, makes_matrices, applies] {
            if (applies) theirs.set_rest();
            for (const glm::vec3& target : targets) {
                if (makes_matrices) state.local_to_model();
                theirs.solve(target);
                if (applies) theirs.apply_corrections();
            }
        };
    };
    const auto race = [&](const char* subject, const Model& model) {
        Pose pose(model);
        const auto ours = [&] {
            for (const glm::vec3& target : targets)
                check(reach(pose, &model.chains().front(), target).has_value(), "reach");
        };
        table.compare({subject, name, "solve", static_cast<double>(targets.size())},
                      {{"ours", ours},
                       {"ozz, job alone", all(false, false)},
                       {"ozz, job, corrections applied", all(false, true)},
                       {"ozz, matrices, job, corrections applied", all(true, true)}});
    };
    race("chain", made->model);
    if (is_aim) return;
    race("chain, hinge's limits", make_chain(solver, true)->model);
    theirs.set_rest();
    note_distances(table, name, made->model, state, theirs, targets);
}

void measure_reaching(Table& table, const Character& character) {
    const std::vector<Limb> limbs = find_limbs(character);
    if (limbs.empty()) return;
    OurFrame ours(character, limbs);
    OzzFrame theirs(character, limbs);
    const auto race = [&](const std::string& what, bool reaches, bool obeys, const char* beside) {
        table.compare({character.name, what, "frame", 1.0},
                      {{"ours", [&, reaches, obeys] { ours.run(reaches, obeys); }},
                       {beside, [&, reaches] { theirs.run(reaches); }}});
    };
    const std::string name = "frame with " + std::to_string(limbs.size()) + " limbs";
    race("frame without IK", false, false, "ozz");
    race(name + ", free", true, false, "ozz");
    const double reached_free = ours.take_reached();
    race(name + ", limits obeyed", true, true, "ozz, no limits");
    const double reached = ours.take_reached();
    float left = 0.0f;
    for (int k = 0; k < 60; ++k) left = std::max(left, theirs.distance_left());
    table.add_note(character.name + ": targets reached " + short_text(reached_free) + " % free, " +
                   short_text(reached) + " % with limits; ozz at most " + short_text(left) + " m from them");
}

}  // namespace bendy::bench
