#include "joints.h"

#include "failure.h"
#include "mirror.h"
#include "rig/attach_rig.h"
#include "rig/joint_index.h"
#include "rig/names.h"
#include "source/transform.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bendy::converter::x {
namespace {

void check_affine(const Matrix& matrix, const std::string& place) {
    constexpr double kTolerance = 1e-5;
    const bool is_affine = std::abs(matrix[3]) <= kTolerance && std::abs(matrix[7]) <= kTolerance &&
                           std::abs(matrix[11]) <= kTolerance && std::abs(matrix[15] - 1.0) <= kTolerance;
    if (!is_affine) fail(place, "the last column of its matrix is not 0 0 0 1: no affine transform");
}

bool is_finite(const Transform& rest) {
    for (const glm::vec3& vector : {rest.translation, rest.scale, rest.shear}) {
        if (!std::isfinite(vector.x) || !std::isfinite(vector.y) || !std::isfinite(vector.z)) return false;
    }
    return true;
}

/// A joint by its number, as rigs name it.
JointKey key_of(std::uint32_t joint) {
    JointKey key;
    key.kind = JointKey::Kind::number;
    key.number = joint;
    key.name = '#' + std::to_string(joint);
    return key;
}

RigChain to_rig(const IkChain& source, const FrameIndex& frames) {
    const auto find = [&](const std::string& identifier) {
        return identifier.empty() ? std::string()
                                  : key_of(frames.expect(identifier, "BendyIkChain", source.place)).name;
    };
    RigChain chain;
    chain.name = source.name;
    chain.place = source.place;
    if (source.start.empty() || source.effector.empty())
        fail(source.place, "an IK chain needs a start and an effector");
    chain.start = find(source.start);
    chain.effector = find(source.effector);
    chain.target = find(source.target);
    chain.pole = find(source.pole);
    chain.record = source.record;
    for (const auto& [identifier, weight] : source.weights)
        chain.weights.emplace_back(key_of(frames.expect(identifier, "BendyIkChain", source.place)), weight);
    chain.extras = source.extras;
    return chain;
}

void add_constraint(const Constraint& constraint, std::vector<RigEntry>& entries,
                    std::unordered_map<std::uint32_t, std::size_t>& entry_of) {
    const auto [known, is_new] = entry_of.try_emplace(constraint.frame, entries.size());
    if (is_new) entries.push_back({key_of(constraint.frame), constraint.place, {}});
    std::vector<LimitRecord>& limits = entries[known->second].limits;
    const bool has_one = std::any_of(limits.begin(), limits.end(),
                                     [&](const LimitRecord& limit) { return limit.scope == constraint.record.scope; });
    if (has_one) {
        fail(constraint.place,
             "there is a second constraint of scope " + std::string(kScopeNames[constraint.record.scope]));
    }
    limits.push_back(constraint.record);
}

}  // namespace

FrameIndex::FrameIndex(const XFile& file) {
    for (std::uint32_t i = 0; i < file.frames.size(); ++i) joint_of_.try_emplace(file.frames[i].identifier, i);
}

std::uint32_t FrameIndex::find(std::string_view identifier) const {
    const auto found = joint_of_.find(identifier);
    return found == joint_of_.end() || identifier.empty() ? kNone : found->second;
}

std::uint32_t FrameIndex::expect(std::string_view identifier, const char* what, const std::string& place) const {
    const std::uint32_t joint = find(identifier);
    if (joint == kNone) fail(place, std::string(what) + " names a frame " + quote(identifier) + " that does not exist");
    return joint;
}

void import_joints(const XFile& file, Scene& scene, Report& report) {
    scene.joints.reserve(file.frames.size());
    for (const Frame& frame : file.frames) {
        check_affine(frame.matrix, frame.place);
        Joint& joint = scene.joints.emplace_back();
        joint.name = frame.name;
        joint.parent = frame.parent;
        joint.rest = decompose(mirrored(frame.matrix));
        if (!is_finite(joint.rest)) fail(frame.place, "the numbers of its matrix are too large");
    }
    std::unordered_map<std::string_view, std::uint32_t> count;
    for (const Frame& frame : file.frames) {
        if (!frame.identifier.empty() && ++count[frame.identifier] == 2)
            report.warn("several frames have one name: the first is meant by it", frame.place);
    }
}

void import_rig(const XFile& file, const FrameIndex& frames, Scene& scene, Report& report) {
    Rig rig;
    std::unordered_map<std::uint32_t, std::size_t> entry_of;
    for (const Constraint& constraint : file.constraints) add_constraint(constraint, rig.joints, entry_of);
    for (const IkChain& chain : file.chains) rig.chains.push_back(to_rig(chain, frames));
    const JointIndex index(scene);
    Claims claims{std::vector<bool>(scene.joints.size()), {}};
    attach_rig(scene, rig, index, claims, report);
}

glm::mat4 to_floats(const Matrix& matrix, const std::string& place) {
    glm::mat4 floats(1.0f);
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        const auto number = static_cast<float>(matrix[i]);
        if (!std::isfinite(number)) fail(place, "the numbers of its matrix are too large");
        floats[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = number;
    }
    return floats;
}

}  // namespace bendy::converter::x
