#include "attach_rig.h"

#include "fields.h"
#include "scene/failure.h"

#include <bendy/format/constraint.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace bendy::converter {
namespace {

constexpr std::uint64_t kStepsPerLink = 64;  // a weight needs that much more memory than a comparison needs time

/// The keys of one object, looked up joint by joint.
class Keys {
public:
    static constexpr std::size_t kNoKey = SIZE_MAX;

    /// Keys are numbered in the order of addition.
    void add(const JointKey& key) {
        const std::size_t number = count_++;
        switch (key.kind) {
            case JointKey::Kind::number:
                by_number_.try_emplace(key.number, number);
                break;
            case JointKey::Kind::name:
                by_name_.try_emplace(key.name, number);
                break;
            case JointKey::Kind::glob:
                globs_.emplace_back(&key.glob, number);
                break;
        }
    }

    /// The number of the key that applies to a joint.
    std::size_t find(std::uint32_t joint, std::string_view name, WorkBudget& budget) const {
        budget.take(1);
        if (const auto found = by_number_.find(joint); found != by_number_.end()) return found->second;
        if (const auto found = by_name_.find(name); found != by_name_.end()) return found->second;
        if (globs_.empty()) return kNoKey;
        budget.take(name.size());
        const std::u32string characters = characters_of(name);
        const auto fitting = std::find_if(globs_.rbegin(), globs_.rend(),
                                          [&](const auto& glob) { return fits(*glob.first, characters, budget); });
        return fitting == globs_.rend() ? kNoKey : fitting->second;
    }

private:
    std::size_t count_ = 0;
    std::unordered_map<std::uint64_t, std::size_t> by_number_;
    std::unordered_map<std::string_view, std::size_t> by_name_;
    std::vector<std::pair<const std::vector<JointKey::Step>*, std::size_t>> globs_;
};

std::uint32_t find_joint(const RigChain& chain, const char* role, const std::string& key, const JointIndex& index) {
    const std::uint32_t joint = index.find_key(key);
    if (joint == kNone)
        fail(chain.place + '.' + role, "there is no joint " + quote(key) + index.suggest(name_of_key(key)));
    return joint;
}

std::vector<Chain::Weight> resolve_weights(const RigChain& source, const ChainRecord& record, const Scene& scene,
                                           WorkBudget& budget) {
    std::vector<Chain::Weight> weights;
    if (source.weights.empty()) return weights;
    Keys keys;
    for (const auto& [key, weight] : source.weights) keys.add(key);
    std::vector<bool> is_taken(source.weights.size());
    for (std::uint32_t joint = record.effector;; joint = scene.joints[joint].parent) {
        budget.take(kStepsPerLink);
        if (const std::size_t key = keys.find(joint, scene.joints[joint].name, budget); key != Keys::kNoKey) {
            weights.push_back({joint, source.weights[key].second});
            is_taken[key] = true;
        }
        if (joint == record.start) break;
    }
    for (std::size_t i = 0; i < is_taken.size(); ++i) {
        const JointKey& key = source.weights[i].first;
        if (!is_taken[i] && key.kind != JointKey::Kind::glob)
            fail(member(source.place + ".weights", key.name), "the chain has no such joint");
    }
    return weights;
}

/// Reports entries that match no joint: the first few one by one.
void report_untaken(const Rig& rig, const std::vector<bool>& is_taken, const JointIndex& index, Report& report) {
    constexpr std::size_t kNamed = 20;
    std::size_t count = 0;
    for (std::size_t i = 0; i < is_taken.size(); ++i) {
        if (is_taken[i]) continue;
        const std::string place = rig.source + rig.joints[i].place;
        if (count++ < kNamed) {
            const JointKey& key = rig.joints[i].key;
            const bool is_first = count == 1;  // a hostile file has many, and each search takes time
            report.warn("no joint takes " + quote(key.name) +
                            (is_first && key.kind == JointKey::Kind::name ? index.suggest(key.name) : ""),
                        place);
        } else {
            report.warn("no joint takes this entry either", place);
        }
    }
}

}  // namespace

void flag_rest_outside(ConstraintRecord& constraint, const std::string& joint, const std::string& place,
                       Report& report) {
    if (holds_rest(constraint) || (constraint.flags & kRestOutside) != 0) return;
    constraint.flags |= kRestOutside;
    report.warn("the rest pose of joint " + quote(joint) + " is outside its limits", place);
}

Chain resolve_chain(const RigChain& source, const Scene& scene, const JointIndex& index, WorkBudget& budget) {
    Chain chain;
    chain.name = source.name;
    chain.record = source.record;
    chain.extras = source.extras;
    ChainRecord& record = chain.record;
    record.start = find_joint(source, "start", source.start, index);
    record.effector = find_joint(source, "effector", source.effector, index);
    if (!source.target.empty()) record.target = find_joint(source, "target", source.target, index);
    if (!source.pole.empty()) record.pole = find_joint(source, "pole", source.pole, index);
    if (!index.is_above(record.start, record.effector)) {
        fail(source.place + ".start",
             "joint " + quote(source.start) + " is neither " + quote(source.effector) + " itself nor above it");
    }
    chain.weights = resolve_weights(source, record, scene, budget);
    return chain;
}

void attach_roles(Scene& scene, const Rig& rig, const JointIndex& index) {
    if (!rig.roles) return;
    constexpr std::size_t kMost = 0x10000;  // joints of a chain
    std::vector<RoleRecord> roles;
    std::vector<bool> is_named(scene.joints.size());
    std::vector<bool> is_said(kRoles);
    for (const RigRole& role : *rig.roles) {
        is_said[static_cast<std::size_t>(role.role)] = true;
        if (role.joints.size() > kMost) fail(role.place, "a chain has " + std::to_string(kMost) + " joints at most");
        for (std::size_t place = 0; place < role.joints.size(); ++place) {
            const std::string& key = role.joints[place];
            const std::string where = role.role < kFirstChainRole ? role.place : at(role.place, place);
            const std::uint32_t joint = index.find_key(key);
            if (joint == kNone) fail(where, "there is no joint " + quote(key) + index.suggest(name_of_key(key)));
            if (is_named[joint]) fail(where, "joint " + quote(key) + " has another role here");
            is_named[joint] = true;
            roles.push_back({joint, static_cast<std::uint16_t>(role.role), static_cast<std::uint16_t>(place)});
        }
    }
    std::copy_if(scene.roles.begin(), scene.roles.end(), std::back_inserter(roles),
                 [&](const RoleRecord& record) { return !is_named[record.joint] && !is_said[record.role]; });
    std::sort(roles.begin(), roles.end(), [](const RoleRecord& a, const RoleRecord& b) { return a.joint < b.joint; });
    scene.roles = std::move(roles);
}

void attach_standing_pose(Scene& scene, const Rig& rig, const JointIndex& index) {
    if (!rig.has_standing_pose) return;
    if (!rig.standing_pose) {
        scene.standing_pose.reset();
        return;
    }
    StandingPose standing{rig.standing_pose->pose, {}};
    for (const auto& [key, rotation] : rig.standing_pose->rotations) {
        const std::string where = member("standing_pose.rotations", key);
        const std::uint32_t joint = index.find_key(key);
        if (joint == kNone) fail(where, "there is no joint " + quote(key) + index.suggest(name_of_key(key)));
        standing.rotations.push_back({joint, rotation});
    }
    sort_rotations(standing.rotations, "standing_pose.rotations");
    scene.standing_pose = std::move(standing);
}

void sort_rotations(std::vector<StandingRotationRecord>& rotations, const std::string& place) {
    std::sort(rotations.begin(), rotations.end(),
              [](const StandingRotationRecord& a, const StandingRotationRecord& b) { return a.joint < b.joint; });
    const auto twice = std::adjacent_find(rotations.begin(), rotations.end(),
                                          [](const auto& a, const auto& b) { return a.joint == b.joint; });
    if (twice != rotations.end()) fail(place, "joint #" + std::to_string(twice->joint) + " has two rotations");
}

std::uint32_t find_hips(const Rig& rig, const JointIndex& index) {
    if (!rig.roles) return kNone;
    const auto hips = std::find_if(rig.roles->begin(), rig.roles->end(),
                                   [](const RigRole& role) { return role.role == Role::hips && !role.joints.empty(); });
    return hips == rig.roles->end() ? kNone : index.find_key(hips->joints.front());
}

void attach_rig(Scene& scene, const Rig& rig, const JointIndex& index, Claims& claims, Report& report) {
    WorkBudget budget;
    std::vector<Chain> chains;
    for (const RigChain& chain : rig.chains) {
        if (!claims.chains.contains(chain.name)) chains.push_back(resolve_chain(chain, scene, index, budget));
    }
    Keys keys;
    for (const RigEntry& entry : rig.joints) keys.add(entry.key);
    std::vector<std::size_t> key_of(index.size());
    for (std::uint32_t joint = 0; joint < index.size(); ++joint)
        key_of[joint] = keys.find(joint, scene.joints[joint].name, budget);

    // Nothing fails from here on.
    std::vector<bool> is_taken(rig.joints.size());
    for (std::uint32_t joint = 0; joint < index.size(); ++joint) {
        if (key_of[joint] == Keys::kNoKey) continue;
        const RigEntry& entry = rig.joints[key_of[joint]];
        is_taken[key_of[joint]] = true;
        if (claims.joints[joint]) continue;
        claims.joints[joint] = true;
        scene.joints[joint].constraints = entry.constraints;
        for (ConstraintRecord& constraint : scene.joints[joint].constraints)
            flag_rest_outside(constraint, scene.joints[joint].name, rig.source + entry.place, report);
    }
    for (Chain& chain : chains) {
        claims.chains.insert(chain.name);
        scene.chains.push_back(std::move(chain));
    }
    report_untaken(rig, is_taken, index, report);
}

}  // namespace bendy::converter
