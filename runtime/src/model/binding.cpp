#include <bendy/runtime/binding.h>

#include <bendy/runtime/sample.h>

#include "model_data.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string_view>
#include <utility>

namespace bendy {
namespace {

/// Numbers by name, of a mesh or ("") of anything.
using ByName = std::map<std::pair<std::string_view, std::string_view>, std::uint32_t>;

std::uint32_t find(const ByName& numbers, std::string_view mesh, std::string_view name) {
    const auto found = numbers.find({mesh, name});
    return name.empty() || found == numbers.end() ? kNone : found->second;
}

std::vector<std::uint32_t> places_of(const std::vector<bool>& is_there) {
    std::vector<std::uint32_t> places;
    for (std::uint32_t k = 0; k < is_there.size(); ++k) {
        if (is_there[k]) places.push_back(k);
    }
    return places;
}

struct Paths {
    bool rotation = false, translation = false, scale = false;
};

void add(Paths& paths, TrackPath path) {
    paths.rotation = paths.rotation || path == TrackPath::rotation;
    paths.translation = paths.translation || path == TrackPath::translation;
    paths.scale = paths.scale || path == TrackPath::scale;
}

/// Returns the properties of each joint that a clip animates.
std::vector<Paths> find_paths(const Clip& clip, std::size_t joints) {
    std::vector<Paths> paths(joints);
    for (const TrackView& track : clip.tracks) {
        if (track.path != TrackPath::weights && track.target < joints) add(paths[track.target], track.path);
    }
    if (!clip.packed) return paths;
    for (std::uint32_t joint = 0; joint < joints && joint < clip.packed->record.joints; ++joint) {
        for (const TrackPath path : {TrackPath::rotation, TrackPath::translation, TrackPath::scale}) {
            if (clip.packed->animates(joint, path)) add(paths[joint], path);
        }
    }
    return paths;
}

}  // namespace

Binding::Binding(const Model& animated, Model posed, const BindingOptions& options)
    : animated_(animated), posed_(std::move(posed)), sampled_(animated) {
    match_joints();
    match_targets();
    const bool has_all = options.translations == BoundTranslations::all;
    const std::vector<bool> is_root = find_roots(options.root);
    std::vector<bool> missed_joints(joints_.size());
    std::vector<bool> missed_targets(targets_.size());
    clips_.reserve(animated.clips().size());
    for (const Clip& clip : animated.clips())
        bind(clip, is_root, options.root_scale, has_all, missed_joints, missed_targets);
    unmatched_joints_ = places_of(missed_joints);
    unmatched_targets_ = places_of(missed_targets);
}

void Binding::match_joints() {
    ByName numbers;
    for (std::uint32_t joint = 0; joint < posed_.joints().size(); ++joint)
        numbers.emplace(std::pair("", posed_.joints()[joint].name), joint);  // keeps the first
    std::vector<bool> is_taken(posed_.joints().size());
    joints_.reserve(animated_.joints().size());
    for (const Joint& joint : animated_.joints()) {
        std::uint32_t found = find(numbers, "", joint.name);
        if (found != kNone && is_taken[found]) found = kNone;
        if (found != kNone) is_taken[found] = true;
        joints_.push_back(found);
    }
}

void Binding::match_targets() {
    ByName anywhere, in_mesh;
    for (std::uint32_t mesh = 0; mesh < posed_.meshes().size(); ++mesh) {
        std::uint32_t number = posed_.first_morph_target(mesh);
        for (const MorphTargetView& target : posed_.meshes()[mesh].targets) {
            anywhere.emplace(std::pair("", target.name), number);
            in_mesh.emplace(std::pair(posed_.meshes()[mesh].name, target.name), number);
            ++number;
        }
    }
    for (const Mesh& mesh : animated_.meshes()) {
        for (const MorphTargetView& target : mesh.targets) {
            const std::uint32_t found = find(in_mesh, mesh.name, target.name);
            targets_.push_back(found == kNone ? find(anywhere, "", target.name) : found);
        }
    }
}

/// Returns which joints of the posed model take translations with root_only.
std::vector<bool> Binding::find_roots(std::uint32_t root) const {
    const auto parents = posed_.parents();
    std::vector<bool> is_root(parents.size());
    if (root < parents.size()) {
        for (; root != kNone; root = parents[root]) is_root[root] = true;
        return is_root;
    }
    std::vector<bool> has_matched(parents.size());  // the joint, or one of its ancestors
    for (const std::uint32_t joint : joints_) {
        if (joint != kNone) has_matched[joint] = true;
    }
    for (std::size_t joint = 0; joint < parents.size(); ++joint) {  // parents come first
        const bool is_below = parents[joint] != kNone && has_matched[parents[joint]];
        is_root[joint] = has_matched[joint] && !is_below;
        has_matched[joint] = has_matched[joint] || is_below;
    }
    return is_root;
}

void Binding::bind(const Clip& clip, const std::vector<bool>& is_root, float root_scale, bool has_all,
                   std::vector<bool>& missed_joints, std::vector<bool>& missed_targets) {
    BoundClip bound;
    const std::vector<Paths> paths = find_paths(clip, joints_.size());
    for (std::uint32_t joint = 0; joint < paths.size(); ++joint) {
        BoundJoint made{joint, joints_[joint], paths[joint].rotation, paths[joint].translation, paths[joint].scale,
                        1.0f};
        if (!made.rotation && !made.translation && !made.scale) continue;
        if (made.to == kNone) {
            missed_joints[joint] = true;
            continue;
        }
        if (!has_all) {
            made.translation = made.translation && is_root[made.to];
            made.translation_scale = root_scale;
        }
        bound.joints.push_back(made);
    }
    const auto bind_target = [&](std::uint32_t target) {
        if (targets_[target] == kNone) {
            missed_targets[target] = true;
        } else {
            bound.targets.push_back({target, targets_[target]});
        }
    };
    for (const TrackView& track : clip.tracks) {
        if (track.path != TrackPath::weights || track.target >= animated_.meshes().size()) continue;
        for (std::uint32_t k = 0; k < animated_.meshes()[track.target].targets.size(); ++k)
            bind_target(animated_.first_morph_target(track.target) + k);
    }
    for (const PlayRecord& play : clip.plays) {
        const std::uint32_t frame_1 =
            animated_.first_morph_target(play.mesh) + animated_.meshes()[play.mesh].first_frame;
        for (std::uint32_t k = std::max(play.first, 1u); k < play.first + play.frames; ++k)
            bind_target(frame_1 + k - 1);
    }
    clips_.push_back(std::move(bound));
}

Result<void, CallError> sample(Pose& pose, Binding& binding, const Clip* clip, float seconds) {
    if (pose.model() != binding.posed_) return CallError::other_model;
    pose.set_rest();
    if (const auto sampled = sample(binding.sampled_, clip, seconds); !sampled) return sampled;
    const std::size_t number = ModelData::of(binding.animated_).number_of(clip);
    for (const Binding::BoundJoint& joint : binding.clips_[number].joints) {
        const JointTransform from = binding.sampled_.local(joint.from);
        JointTransform to = pose.local(joint.to);
        if (joint.rotation) to.rotation = from.rotation;
        if (joint.translation) to.translation = joint.translation_scale * from.translation;
        if (joint.scale) to.scale = from.scale;
        pose.set_local(joint.to, to);
    }
    const std::span<float> weights = pose.change_morph_weights();
    for (const Binding::BoundMorphTarget& target : binding.clips_[number].targets)
        weights[target.to] = binding.sampled_.morph_weights()[target.from];
    return {};
}

}  // namespace bendy
