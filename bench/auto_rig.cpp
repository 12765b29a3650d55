// bench_auto_rig [--targets N] [--expect] FILE...: measures the rigs that `bendy convert --auto-rig` proposes. The rig
// of a glTF file or an X-file is removed first; a bendy file is measured as it is. It prints a row of a Markdown table
// for each character:
//     constraints  the number of arms (shoulder and elbow), legs (hip and knee), spine and neck with a constraint at
//                  every joint; a constraint that allows everything does not count
//     frames       30 a second of every clip: those with every proposed joint inside its constraint to 1 degree, the
//                  tolerance for the wobble of a hinge; and how far the worst joint is outside in the worst frame
//     targets      N for each limb, made by turning its joints at random inside their constraints, with everything else
//                  at rest: those that the chain reaches from the rest pose to 0.1 % of its length; and those that it
//                  reaches with the elbow or knee bent to the side to which the clips bend it on average, or about an
//                  axis within 20 degrees of that in one of their frames, or bent by less than 10 degrees. If neither
//                  the clips nor the rest pose bend the limb by 10 degrees, reaching the target is enough
// With --expect it fails unless these are 100, 99 and 99 %.
#include "rigging/humanoid/auto_rig.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/format/diagnostics.h>
#include <bendy/runtime.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace bendy;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kTolerance = 1.0;  // degrees
constexpr double kBent = 10.0;      // degrees: a limb that is bent less is straight
constexpr float kRate = 30.0f;      // frames a second
constexpr std::array kLimbNames{"LeftArm", "RightArm", "LeftLeg", "RightLeg"};

struct Limb {
    const Chain* chain = nullptr;
    std::vector<std::uint32_t> joints;  ///< that turn, without the tip's joint: start and middle
    std::uint32_t middle = kNone;
};

/// Finds the joints of a two-bone chain that turn: those with a weight, except the one at the tip.
std::optional<Limb> find_limb(const Model& model, const char* name) {
    Limb limb;
    limb.chain = model.chain(name);
    if (limb.chain == nullptr) return std::nullopt;
    const auto& offset = limb.chain->record.tip_offset;
    const bool has_tip = offset[0] != 0.0f || offset[1] != 0.0f || offset[2] != 0.0f;
    for (std::uint32_t joint = limb.chain->record.effector; joint != kNone; joint = model.joints()[joint].parent) {
        bool is_passive = joint == limb.chain->record.effector && !has_tip;
        for (const ChainWeightView& weight : model.chain_weights(*limb.chain))
            is_passive = is_passive || (weight.joint == joint && weight.weight == 0.0f);
        if (!is_passive) limb.joints.push_back(joint);
        if (joint == limb.chain->record.start) break;
    }
    if (limb.joints.size() < 2) return std::nullopt;
    std::reverse(limb.joints.begin(), limb.joints.end());
    limb.middle = limb.joints[1];
    return limb;
}

bool is_limited(const Model& model, std::uint32_t joint) {
    const Constraint* constraint = model.constraint(joint);
    if (constraint == nullptr || constraint->model() == ConstraintModel::free) return false;
    if (constraint->model() == ConstraintModel::hinge || constraint->model() == ConstraintModel::locked) return true;
    // A swing-twist constraint that allows every direction and every twist does not limit the joint.
    const LimitShape& shape = constraint->shape;
    return shape.swing_low[0] < 1.0 || shape.swing_high[0] < 1.0 || shape.swing_low[1] < 1.0 ||
           shape.swing_high[1] < 1.0 || shape.angles[0].half < 3.14159;
}

/// Checks the joints from the chain's start to the one before its effector, or to the effector if `whole`.
bool is_column_limited(const Model& model, const Chain& chain, bool whole) {
    std::uint32_t joint = chain.record.effector;
    if (!whole && joint != chain.record.start) joint = model.joints()[joint].parent;
    for (; joint != kNone; joint = model.joints()[joint].parent) {
        if (!is_limited(model, joint)) return false;
        if (joint == chain.record.start) return true;
    }
    return false;
}

struct Share {
    std::uint64_t good = 0;
    std::uint64_t all = 0;
    void add(bool is_good) {
        good += is_good ? 1 : 0;
        ++all;
    }
    [[nodiscard]] double percent() const {
        return all == 0 ? 100.0 : 100.0 * static_cast<double>(good) / static_cast<double>(all);
    }
};

/// How a limb is bent: in which direction, in the space of the bone above the middle joint, and by how much.
struct Bend {
    glm::dvec3 axis{0.0};  ///< sine of the bend times the axis
    double degrees = 0.0;
};
Bend bend_of(Pose& pose, const Limb& limb) {
    const auto at = [&](std::uint32_t joint) { return glm::dmat4(pose.model_space()[joint]); };
    const auto& offset = limb.chain->record.tip_offset;
    const glm::dvec3 tip(at(limb.chain->record.effector) * glm::dvec4(offset[0], offset[1], offset[2], 1.0));
    const glm::dvec3 start(at(limb.chain->record.start)[3]);
    const glm::dvec3 middle(at(limb.middle)[3]);
    const glm::dvec3 upper = glm::normalize(middle - start);
    const glm::dvec3 lower = glm::normalize(tip - middle);
    const glm::dvec3 axis = glm::cross(upper, lower);
    Bend bend;
    bend.degrees = std::atan2(glm::length(axis), glm::dot(upper, lower)) / kDegree;
    const glm::dmat3 space(at(pose.model().joints()[limb.middle].parent));
    bend.axis =
        glm::inverse(glm::dmat3(glm::normalize(space[0]), glm::normalize(space[1]), glm::normalize(space[2]))) * axis;
    return bend;
}

/// Returns a random rotation inside the constraint.
glm::quat random_rotation(const Constraint& constraint, const glm::quat& rest, std::mt19937_64& random) {
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
    };
    const AngleRange& twist = constraint.shape.angles[0];
    for (int attempt = 0; attempt < 1000; ++attempt) {
        const double t = 0.5 * uniform(twist.middle - twist.half, twist.middle + twist.half);
        glm::dquat R(std::cos(t), std::sin(t), 0.0, 0.0);
        if (constraint.model() != ConstraintModel::hinge) {
            const LimitShape& s = constraint.shape;
            const double y = uniform(-std::min(s.swing_low[0], 1.0), std::min(s.swing_high[0], 1.0));
            const double z = uniform(-std::min(s.swing_low[1], 1.0), std::min(s.swing_high[1], 1.0));
            const double square = y * y + z * z;
            if (square > 1.0) continue;
            R = glm::dquat(std::sqrt(1.0 - square), 0.0, y, z) * R;
        }
        if (violation(constraint, R) > 1e-9) continue;
        return from_constraint_space(constraint, rest, R);
    }
    return rest;
}

struct Row {
    Share parts, frames, reached, bent;
    double worst = 0.0;  ///< degrees
    std::string missing;
    std::array<Share, 4> limbs{};  ///< shares of targets reached and bent as in the clips
};

class Measurement {
public:
    Measurement(const Model& model, std::size_t targets) : model_(model), targets_(targets), pose_(model) {}

    Row measure() {
        for (const char* name : kLimbNames) limbs_.push_back(find_limb(model_, name));
        count_parts();
        play_clips();
        for (std::size_t limb = 0; limb < limbs_.size(); ++limb) {
            if (limbs_[limb]) reach_targets(*limbs_[limb], limb);
        }
        return row_;
    }

private:
    void count(const std::string& name, bool is_limited) {
        row_.parts.add(is_limited);
        if (!is_limited) row_.missing += (row_.missing.empty() ? "" : ", ") + name;
    }

    void count_parts() {
        for (std::size_t limb = 0; limb < limbs_.size(); ++limb) {
            const bool all =
                limbs_[limb] && std::all_of(limbs_[limb]->joints.begin(), limbs_[limb]->joints.end(),
                                            [&](std::uint32_t joint) { return is_limited(model_, joint); });
            count(kLimbNames[limb], all);
        }
        const Chain* spine = model_.chain("Spine");
        const Chain* head = model_.chain("Head");
        count("Spine", spine != nullptr && is_column_limited(model_, *spine, false));
        // Without a neck there is no chain; the head has the constraint.
        count("Neck", head != nullptr ? is_column_limited(model_, *head, true)
                                      : spine != nullptr && is_limited(model_, spine->record.effector));
    }

    void play_clips() {
        sums_.assign(limbs_.size(), glm::dvec3(0.0));
        axes_.assign(limbs_.size(), {});
        for (const Clip& clip : model_.clips()) {
            const auto frames = static_cast<int>((clip.end - clip.start) * kRate) + 1;
            for (int frame = 0; frame < frames; ++frame) {
                (void)sample(pose_, &clip, clip.start + static_cast<float>(frame) / kRate);
                double worst = 0.0;
                for (const Constraint& constraint : model_.constraints()) {
                    const glm::quat& rest = model_.joints()[constraint.joint].rest.rotation;
                    const glm::quat local = pose_.local(constraint.joint).rotation;
                    worst =
                        std::max(worst, violation(constraint, to_constraint_space(constraint, rest, local)) / kDegree);
                }
                row_.frames.add(worst <= kTolerance);
                row_.worst = std::max(row_.worst, worst);
                add_bends();
            }
        }
        if (!model_.clips().empty()) return;
        pose_.set_rest();
        add_bends();
    }

    void add_bends() {
        for (std::size_t limb = 0; limb < limbs_.size(); ++limb) {
            if (!limbs_[limb]) continue;
            const Bend bend = bend_of(pose_, *limbs_[limb]);
            sums_[limb] += bend.axis;
            if (bend.degrees < kBent) continue;
            const glm::dvec3 axis = glm::normalize(bend.axis);
            const auto is_near = [&](const glm::dvec3& other) { return glm::dot(axis, other) > 0.996; };  // 5 degrees
            if (std::none_of(axes_[limb].begin(), axes_[limb].end(), is_near)) axes_[limb].push_back(axis);
        }
    }

    [[nodiscard]] bool is_bent_as_in_clips(std::size_t limb, const Bend& bend) const {
        constexpr double kNear = 0.94;  // cosine of 20 degrees
        if (bend.degrees < kBent || axes_[limb].empty() || glm::dot(bend.axis, sums_[limb]) > 0.0) return true;
        const glm::dvec3 axis = glm::normalize(bend.axis);
        return std::any_of(axes_[limb].begin(), axes_[limb].end(),
                           [&](const glm::dvec3& other) { return glm::dot(axis, other) > kNear; });
    }

    void reach_targets(const Limb& limb, std::size_t number) {
        std::mt19937_64 random(20240607 + number);
        pose_.set_rest();
        const auto place = [&](std::uint32_t joint) { return glm::dvec3(pose_.model_space()[joint][3]); };
        const auto& offset = limb.chain->record.tip_offset;
        const auto tip = [&] {
            return glm::vec3(pose_.model_space()[limb.chain->record.effector] *
                             glm::vec4(offset[0], offset[1], offset[2], 1));
        };
        const double length = glm::distance(place(limb.chain->record.start), place(limb.middle)) +
                              glm::distance(place(limb.middle), glm::dvec3(tip()));
        for (std::size_t target = 0; target < targets_; ++target) {
            pose_.set_rest();
            for (const std::uint32_t joint : limb.joints) {
                const glm::quat& rest = model_.joints()[joint].rest.rotation;
                const Constraint* constraint = model_.ik_constraint(joint);
                if (constraint == nullptr) continue;
                JointTransform local = pose_.local(joint);
                local.rotation = random_rotation(*constraint, rest, random);
                pose_.set_local(joint, local);
            }
            const glm::vec3 where = tip();
            pose_.set_rest();
            ReachOptions options;
            options.softness = 0.0f;
            (void)reach(pose_, limb.chain, where, options);
            const bool is_reached = glm::distance(tip(), where) <= 1e-3 * length;
            const bool is_bent_well = is_bent_as_in_clips(number, bend_of(pose_, limb));
            row_.reached.add(is_reached);
            row_.bent.add(is_reached && is_bent_well);
            row_.limbs[number].add(is_reached && is_bent_well);
        }
    }

    const Model& model_;
    std::size_t targets_;
    Pose pose_;
    std::vector<std::optional<Limb>> limbs_;
    std::vector<glm::dvec3> sums_;               ///< of the clips' bends
    std::vector<std::vector<glm::dvec3>> axes_;  ///< of the bends in the clips, 5 degrees apart or more
    Row row_;
};

/// Converts the character with an automatic rig; prints a message and returns nothing if the file cannot be read.
std::optional<std::vector<std::byte>> convert(const std::filesystem::path& file) {
    converter::Report report;
    const std::string suffix = file.extension().string();
    auto scene = suffix == ".x" || suffix == ".X" ? converter::import_x(file, {}, report)
                                                  : converter::import_gltf(file, {}, report);
    if (!scene) {
        std::fprintf(stderr, "%s: %s\n", file.string().c_str(), scene.error().message.c_str());
        return std::nullopt;
    }
    for (converter::Joint& joint : scene->joints) joint.constraints.clear();
    scene->chains.clear();
    converter::auto_rig(*scene, {}, report);
    return converter::build_chunks(*std::move(scene), "bench", report);
}

std::string row_of(const std::string& name, const Model& model, const Row& row) {
    std::array<char, 400> text{};
    const auto targets = [&](const Share& share) {
        std::array<char, 32> number{};
        if (share.all == 0) return std::string("-");
        std::snprintf(number.data(), number.size(), "%.1f %%", share.percent());
        return std::string(number.data());
    };
    std::snprintf(text.data(), text.size(), "| %s | %zu | %zu | %llu of %llu%s | %llu | %s | %.1f | %s | %s |",
                  name.c_str(), model.joints().size(), model.clips().size(),
                  static_cast<unsigned long long>(row.parts.good), static_cast<unsigned long long>(row.parts.all),
                  row.missing.empty() ? "" : (" (not " + row.missing + ")").c_str(),
                  static_cast<unsigned long long>(row.frames.all), targets(row.frames).c_str(), row.worst,
                  targets(row.reached).c_str(), targets(row.bent).c_str());
    return text.data();
}

}  // namespace

int main(int argc, char** argv) {
    std::size_t targets = 1000;
    bool is_expected = false;
    bool is_good = true;
    std::puts(
        "| character | joints | clips | limbs, spine and neck with constraints | frames | inside | "
        "worst, degrees | targets reached | and bent as in its clips |");
    std::puts("|---|---|---|---|---|---|---|---|---|");
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--targets") == 0 && i + 1 < argc) {
            targets = static_cast<std::size_t>(std::strtoull(argv[++i], nullptr, 10));
            continue;
        }
        if (std::strcmp(argv[i], "--expect") == 0) {
            is_expected = true;
            continue;
        }
        const std::filesystem::path file = argv[i];
        std::optional<std::vector<std::byte>> bytes;
        if (file.extension() != ".bendy") {
            bytes = convert(file);
            if (!bytes) return 1;
        }
        const auto model = bytes ? Model::from_memory(*bytes) : Model::open(file);
        if (!model) {
            std::fprintf(stderr, "%s: %s\n", argv[i], describe(model.error()).c_str());
            return 1;
        }
        const Row row = Measurement(*model, targets).measure();
        std::puts(row_of(file.stem().string(), *model, row).c_str());
        for (std::size_t limb = 0; limb < row.limbs.size(); ++limb) {
            const Share& share = row.limbs[limb];
            if (share.percent() >= 99.0) continue;
            std::fprintf(stderr, "%s: %s: %.1f %% reached and bent as in its clips\n", argv[i], kLimbNames[limb],
                         share.percent());
        }
        is_good =
            is_good && row.parts.good == row.parts.all && row.frames.percent() >= 99.0 && row.bent.percent() >= 99.0;
        for (const Share& limb : row.limbs) is_good = is_good && limb.percent() >= 99.0;
    }
    if (is_expected && !is_good) std::fputs("bench_auto_rig: expected 100, 99 and 99 %, of each limb\n", stderr);
    return is_expected && !is_good ? 1 : 0;
}
