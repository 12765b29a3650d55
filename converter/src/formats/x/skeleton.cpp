#include "conventions.h"
#include "parts.h"
#include "rigging/rig/attach_rig.h"
#include "rigging/rig/fields.h"
#include "rigging/rig/joint_key.h"
#include "scene/failure.h"
#include "scene/source/normalise.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace bendy::converter::x {
namespace {

void check_affine(const Matrix& matrix, const std::string& place) {
    constexpr double kTolerance = 1e-5;
    const bool is_affine = std::abs(matrix[3]) <= kTolerance && std::abs(matrix[7]) <= kTolerance &&
                           std::abs(matrix[11]) <= kTolerance && std::abs(matrix[15] - 1.0) <= kTolerance;
    if (!is_affine) fail(place, "the last column of its matrix is not 0 0 0 1: not an affine transform");
}

bool is_finite(const Transform& rest) {
    for (const glm::vec3& vector : {rest.translation, rest.scale, rest.shear}) {
        if (!std::isfinite(vector.x) || !std::isfinite(vector.y) || !std::isfinite(vector.z)) return false;
    }
    return true;
}

/// The key for a joint by number, as in rigs.
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
    std::vector<ConstraintRecord>& constraints = entries[known->second].constraints;
    const bool has_one = std::any_of(constraints.begin(), constraints.end(), [&](const ConstraintRecord& other) {
        return other.scope == constraint.record.scope;
    });
    if (has_one) {
        fail(constraint.place, "there is a second constraint of scope " +
                                   std::string(kValueNames<ConstraintScope>[constraint.record.scope]));
    }
    constraints.push_back(constraint.record);
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
            report.warn("several frames have the same name: it refers to the first of them", frame.place);
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

namespace {

constexpr std::size_t kRotation = 0;
constexpr std::size_t kScale = 1;
constexpr std::size_t kPosition = 2;
constexpr std::size_t kMatrix = 3;

/// Ticks as seconds, and the keys to keep: of several at one time the last one.
struct Times {
    std::vector<float> seconds;
    std::vector<std::size_t> keys;
};

class ClipImporter {
public:
    ClipImporter(const XFile& file, const FrameIndex& frames, Scene& scene, Report& report)
        : file_(file), frames_(frames), scene_(scene), report_(report) {
        for (const auto& [set, name] : file.clip_names) names_.try_emplace(set, name);
    }

    void import(const AnimationSet& set) {
        Clip clip;
        const auto known = names_.find(set.identifier);
        clip.name = known == names_.end() || set.identifier.empty() ? set.name : known->second;
        clip.loop = set.loops;
        track_of_.clear();
        for (const Animation& animation : set.animations) add(animation, clip);
        drop_resting(clip);
        scene_.clips.push_back(std::move(clip));
    }

private:
    void add(const Animation& animation, Clip& clip) {
        const auto has_keys = [](const Keys& keys) { return !keys.times.empty(); };
        if (std::none_of(animation.keys.begin(), animation.keys.end(), has_keys)) {
            report_.warn("animation without keys left out", animation.place);
            return;
        }
        if (animation.frame.empty()) {
            report_.warn("animation without a frame left out", animation.place);
            return;
        }
        const std::uint32_t joint = frames_.find(animation.frame);
        if (joint == kNone) {
            report_.warn("animation left out: its frame " + quote(animation.frame) + " does not exist",
                         animation.place);
            return;
        }
        const auto add_kind = [&](std::size_t kind, TrackPath path, std::uint32_t components) {
            const Keys& keys = animation.keys[kind];
            if (keys.times.empty()) return;
            const Times times = read_times(keys, animation.place);
            Track track;
            track.path = path;
            track.target = joint;
            track.components = components;
            for (std::size_t k = 0; k < times.keys.size(); ++k) {
                if (add_value(kind, keys.values.data() + times.keys[k] * components, animation, track))
                    track.times.push_back(times.seconds[k]);
            }
            if (!track.times.empty()) keep(std::move(track), animation.place, clip);
        };
        add_kind(kPosition, TrackPath::translation, 3);
        add_kind(kRotation, TrackPath::rotation, 4);
        add_kind(kScale, TrackPath::scale, 3);
        if (!animation.keys[kMatrix].times.empty()) add_matrices(animation, joint, clip);
    }

    Times read_times(const Keys& keys, const std::string& place) {
        Times times;
        std::uint64_t doubled = 0;
        for (std::size_t key = 0; key < keys.times.size(); ++key) {
            const auto seconds = static_cast<float>(keys.times[key] / file_.ticks_per_second);
            if (!std::isfinite(seconds)) fail(place, "a key's time is too large");
            if (!times.seconds.empty() && seconds < times.seconds.back())
                fail(place, "key " + std::to_string(key) + ": key times must increase");
            if (!times.seconds.empty() && seconds == times.seconds.back()) {
                times.keys.back() = key;
                ++doubled;
                continue;
            }
            times.seconds.push_back(seconds);
            times.keys.push_back(key);
        }
        if (doubled != 0) report_.warn("keys at the same time: the last one is taken", place, doubled);
        return times;
    }

    /// Rotations in X-files have the opposite sense: w is negated, and the mirror negates x and y. Negating all four
    /// gives the same rotation.
    /// \return false for four zeros, which are not a rotation
    bool add_value(std::size_t kind, const float* value, const Animation& animation, Track& track) {
        if (kind == kScale) {
            track.values.insert(track.values.end(), value, value + 3);
        } else if (kind == kPosition) {
            track.values.insert(track.values.end(), {value[0], value[1], 0.0f - value[2]});
        } else {
            const UnitQuaternion unit =
                make_unit({double{value[1]}, double{value[2]}, -double{value[3]}, double{value[0]}});
            if (unit.length == 0.0) {
                report_.warn("rotation key is (0, 0, 0, 0), left out", animation.place);
                return false;
            }
            if (std::abs(unit.length - 1.0) > kUnitTolerance)
                report_.warn("rotation key is not a unit quaternion, normalised", animation.place);
            for (int i = 0; i < 4; ++i) track.values.push_back(unit.value[i]);
        }
        return true;
    }

    /// Converts matrix keys to three tracks.
    void add_matrices(const Animation& animation, std::uint32_t joint, Clip& clip) {
        const Keys& keys = animation.keys[kMatrix];
        const Times times = read_times(keys, animation.place);
        Track moved{TrackPath::translation, Interpolation::linear, joint, 3, times.seconds, {}};
        Track turned{TrackPath::rotation, Interpolation::linear, joint, 4, times.seconds, {}};
        Track scaled{TrackPath::scale, Interpolation::linear, joint, 3, times.seconds, {}};
        std::uint64_t sheared = 0;
        for (const std::size_t key : times.keys) {
            Matrix matrix{};
            std::copy_n(keys.values.begin() + static_cast<std::ptrdiff_t>(key * 16), 16, matrix.begin());
            const Transform transform = decompose(mirrored(matrix));
            for (int i = 0; i < 3; ++i) moved.values.push_back(transform.translation[i]);
            for (int i = 0; i < 4; ++i) turned.values.push_back(transform.rotation[i]);
            for (int i = 0; i < 3; ++i) scaled.values.push_back(transform.scale[i]);
            const float most =
                std::max({std::abs(transform.scale.x), std::abs(transform.scale.y), std::abs(transform.scale.z)});
            if (!std::isfinite(most)) fail(animation.place, "the numbers of a matrix key are too large");
            sheared += glm::length(transform.shear) > 1e-4f * most ? 1 : 0;
        }
        if (sheared != 0) report_.warn("shear of a matrix key left out", animation.place, sheared);
        for (Track* track : {&moved, &turned, &scaled}) keep(std::move(*track), animation.place, clip);
    }

    void keep(Track track, const std::string& place, Clip& clip) {
        const auto [known, is_new] = track_of_.try_emplace({track.path, track.target}, clip.tracks.size());
        if (is_new) {
            clip.tracks.push_back(std::move(track));
        } else {
            report_.warn("second animation of a frame in a set: the last is taken", place);
            clip.tracks[known->second] = std::move(track);
        }
    }

    /// Drops tracks that equal the rest pose: many writers, including ours, write all three kinds of keys where only
    /// one moves.
    void drop_resting(Clip& clip) const {
        std::vector<bool> moves(scene_.joints.size());
        for (const Track& track : clip.tracks) moves[track.target] = moves[track.target] || !rests(track);
        std::erase_if(clip.tracks, [&](const Track& track) { return moves[track.target] && rests(track); });
    }

    [[nodiscard]] bool rests(const Track& track) const {
        constexpr float kSame = 1e-6f;
        if (track.times.size() != 1) return false;
        const Transform& rest = scene_.joints[track.target].rest;
        if (track.path == TrackPath::rotation) {
            const glm::vec4 value(track.values[0], track.values[1], track.values[2], track.values[3]);
            return glm::length(value - rest.rotation) <= kSame || glm::length(value + rest.rotation) <= kSame;
        }
        const glm::vec3 value(track.values[0], track.values[1], track.values[2]);
        const glm::vec3& due = track.path == TrackPath::scale ? rest.scale : rest.translation;
        return glm::length(value - due) <= kSame * glm::length(due);
    }

    const XFile& file_;
    const FrameIndex& frames_;
    Scene& scene_;
    Report& report_;
    std::unordered_map<std::string_view, std::string_view> names_;
    std::map<std::pair<TrackPath, std::uint32_t>, std::size_t> track_of_;
};

}  // namespace

void import_clips(const XFile& file, const FrameIndex& frames, Scene& scene, Report& report) {
    ClipImporter importer(file, frames, scene, report);
    for (const AnimationSet& set : file.sets) importer.import(set);
}

}  // namespace bendy::converter::x
