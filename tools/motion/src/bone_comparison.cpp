#include "bone_comparison.h"

#include <bendy/format/role.h>
#include <bendy/motion/retarget_clips.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace bendy::motion {
namespace {

/// Bones of an animal's leg that are compared. Below them the foot begins, in one family higher than in another; it is
/// only held level.
constexpr std::size_t kUpperBones = 2;

struct HumanBone {
    Role from, to;
    double far = kFarOfLimb;  ///< degrees
};

constexpr std::array kHumanBones{
    HumanBone{Role::hips, Role::neck, kFarOfOthers},
    HumanBone{Role::neck, Role::head, kFarOfOthers},
    HumanBone{Role::left_shoulder, Role::left_upper_arm, kFarOfOthers},
    HumanBone{Role::right_shoulder, Role::right_upper_arm, kFarOfOthers},
    HumanBone{Role::left_upper_arm, Role::left_lower_arm},
    HumanBone{Role::right_upper_arm, Role::right_lower_arm},
    HumanBone{Role::left_lower_arm, Role::left_hand},
    HumanBone{Role::right_lower_arm, Role::right_hand},
    HumanBone{Role::left_upper_leg, Role::left_lower_leg},
    HumanBone{Role::right_upper_leg, Role::right_lower_leg},
    HumanBone{Role::left_lower_leg, Role::left_foot},
    HumanBone{Role::right_lower_leg, Role::right_foot},
    HumanBone{Role::left_foot, Role::left_toes, kFarOfOthers},
    HumanBone{Role::right_foot, Role::right_toes, kFarOfOthers},
};

std::uint32_t joint_of(const Model& model, Role role, std::size_t place = 0) {
    const auto at = std::find_if(model.roles().begin(), model.roles().end(), [&](const JointRole& one) {
        return static_cast<Role>(one.role) == role && one.place == place;
    });
    return at == model.roles().end() ? kNone : at->joint;
}

bool is_whole(const SharedBone::Ends& ends) {
    return ends.from != kNone && ends.to != kNone && ends.from != ends.to;
}

glm::dvec3 way_of(const SharedBone::Ends& ends, Pose& pose) {
    const auto places = pose.model_space();
    return glm::dvec3(places[ends.to][3]) - glm::dvec3(places[ends.from][3]);
}

std::vector<SharedBone> list_shared_bones(const Retarget& retarget) {
    std::vector<SharedBone> bones;
    const Model &source = retarget.source(), &target = retarget.target();
    const auto add = [&](const SharedBone& bone) {
        if (is_whole(bone.source) && is_whole(bone.target)) bones.push_back(bone);
    };
    for (const HumanBone& bone : kHumanBones) {
        add({{joint_of(source, bone.from), joint_of(source, bone.to)},
             {joint_of(target, bone.from), joint_of(target, bone.to)},
             glm::radians(bone.far)});
    }
    const auto source_of = [&](std::uint32_t joint) { return joint == kNone ? kNone : retarget.joints()[joint]; };
    for (const Role leg : {Role::left_hind_leg, Role::right_hind_leg, Role::left_front_leg, Role::right_front_leg}) {
        for (std::size_t place = 0; place < kUpperBones; ++place) {
            const SharedBone::Ends ends{joint_of(target, leg, place), joint_of(target, leg, place + 1)};
            if (is_whole(ends)) add({{source_of(ends.from), source_of(ends.to)}, ends, glm::radians(kFarOfOthers)});
        }
    }
    return bones;
}

}  // namespace

BoneComparison::BoneComparison(const Retarget& retarget, const RetargetOptions& options)
    : retarget_(retarget), options_(options), bones_(list_shared_bones(retarget)) {}

double BoneComparison::angle(const SharedBone& bone, Pose& source, Pose& target) const {
    const glm::dvec3 a = retarget_.turn() * way_of(bone.source, source), b = way_of(bone.target, target);
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

Cause BoneComparison::find_cause(const SharedBone& bone, Pose& source, Pose& target) {
    if (is_far(bone, source, target, false)) return Cause::rests;
    return options_.limits != Limits::off && is_far(bone, source, target, true) ? Cause::limits : Cause::ground;
}

bool BoneComparison::is_far(const SharedBone& bone, Pose& source, Pose& target, bool obeys_constraints) {
    std::optional<Retarget>& other = without_ground_[obeys_constraints ? 1 : 0];
    if (!other) {
        RetargetOptions options = options_;
        options.limits = obeys_constraints ? options_.limits : Limits::off;
        options.plants_feet = false;
        auto made = Retarget::make(retarget_.source(), retarget_.target(), options);
        if (!made) return false;
        other = *std::move(made);
    }
    RetargetState state;
    return retarget(target, *other, source, state) && angle(bone, source, target) > bone.far;
}

}  // namespace bendy::motion
