#include "accessor.h"
#include "extensions.h"
#include "further_members.h"
#include "parts.h"
#include "pointer.h"
#include "rigging/rig/clips.h"
#include "scene/curve_property.h"
#include "scene/failure.h"
#include "scene/source/normalise.h"

#include <bendy/format/curve.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace bendy::converter::gltf {
namespace {

/// The checked keys of one channel.
struct Keys {
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times;
    std::vector<float> values;
};

Interpolation interpolation_of(const std::string& name) {
    return name == "STEP" ? Interpolation::step : name == "CUBICSPLINE" ? Interpolation::cubic : Interpolation::linear;
}

/// Two keys at one time are a jump: the value at that time is the later key's, and interpolation up to it uses the
/// earlier one's. So the earlier key is moved one float back; keys between the two have no effect. Returns how many
/// keys were affected.
std::uint64_t separate_equal_times(Keys& keys) {
    const std::size_t stride = keys.values.size() / keys.times.size();
    std::uint64_t touched = 0;
    std::size_t kept = 0;
    const auto keep = [&](std::size_t key, float time) {
        keys.times[kept] = time;
        std::copy_n(keys.values.begin() + static_cast<std::ptrdiff_t>(key * stride), stride,
                    keys.values.begin() + static_cast<std::ptrdiff_t>(kept * stride));
        ++kept;
    };
    for (std::size_t first = 0; first < keys.times.size();) {
        const float time = keys.times[first];
        std::size_t last = first;
        while (last + 1 < keys.times.size() && keys.times[last + 1] == time) ++last;
        if (last > first) {
            touched += last - first;
            const float before = std::nextafter(time, -std::numeric_limits<float>::infinity());
            if (kept == 0 || keys.times[kept - 1] < before) keep(first, before);
        }
        keep(last, time);
        first = last + 1;
    }
    keys.times.resize(kept);
    keys.values.resize(kept * stride);
    return touched;
}

/// glTF cannot mark a clip as looping; authors do so in extras: {"loop": true}, or 1 as Blender writes booleans.
bool asks_to_loop(const Json& animation) {
    const auto extras = animation.find("extras");
    if (extras == animation.end() || !extras->is_object()) return false;
    const auto loop = extras->find("loop");
    if (loop == extras->end()) return false;
    return loop->is_boolean() ? loop->get<bool>() : loop->is_number() && loop->get<double>() != 0.0;
}

/// The names of the expressions of a VRM animation, by the joint whose X is the expression's weight.
std::map<std::uint32_t, std::string> find_expressions(const Json& root, const Skeleton& skeleton) {
    std::map<std::uint32_t, std::string> names;
    const Json& all = root["extensions"][kVrmAnimation]["expressions"];
    for (const char* kind : {"preset", "custom"}) {
        if (!all[kind].is_object()) continue;
        for (const auto& [name, expression] : all[kind].items()) {
            const Json* node = expression.is_object() ? find(expression, "node") : nullptr;
            if (node == nullptr || !node->is_number_unsigned()) continue;
            const auto number = node->get<std::uint64_t>();
            if (number < skeleton.joint_of_node.size() && skeleton.joint_of_node[number] != kNone)
                names.try_emplace(skeleton.joint_of_node[number], name);
        }
    }
    return names;
}

class AnimationImporter {
public:
    AnimationImporter(const Document& document, const Skeleton& skeleton, const MeshesOfNode& meshes, Scene& scene)
        : document_(document),
          skeleton_(skeleton),
          meshes_(meshes),
          pointers_(document, skeleton, meshes),
          expressions_(find_expressions(document.json, skeleton)),
          scene_(scene) {}

    void import(std::size_t index) {
        const tinygltf::Animation& animation = document_.model.animations[index];
        place_ = at("animations", index);
        Clip clip;
        clip.name = animation.name;
        clip.extras = extras_text(document_.json["animations"][index]);
        clip.loop = asks_to_loop(document_.json["animations"][index]);
        std::map<std::pair<TrackPath, std::uint32_t>, std::size_t> track_of;
        curve_of_.clear();
        for (std::size_t c = 0; c < animation.channels.size(); ++c) {
            for (Track& track : read_channel(animation, c, index, clip)) {
                const auto [known, is_new] = track_of.emplace(std::pair(track.path, track.target), clip.tracks.size());
                if (is_new) {
                    clip.tracks.push_back(std::move(track));
                } else {
                    document_.report.warn("second channel for the same target, the last one is taken",
                                          place_ + '.' + at("channels", c));
                    clip.tracks[known->second] = std::move(track);
                }
            }
        }
        for (const Track& track : clip.tracks) add_expression(track, clip);
        take_markers_from_extras(clip, place_ + ".extras", document_.report);
        scene_.clips.push_back(std::move(clip));
    }

    /// Reports the losses of all animations.
    void report_losses() const { losses_.report(document_.report); }

private:
    /// The tracks for a channel: none, one, or one for each mesh of a node whose morph weights it animates. Properties
    /// other than nodes' transforms and weights become curves of the clip.
    std::vector<Track> read_channel(const tinygltf::Animation& animation, std::size_t c, std::size_t index,
                                    Clip& clip) {
        const tinygltf::AnimationChannel& channel = animation.channels[c];
        const std::string place = place_ + '.' + at("channels", c);
        const Json& source = document_.json["animations"][index]["channels"][c];
        const auto sampler = static_cast<std::size_t>(channel.sampler);
        const std::string sampler_place = place_ + '.' + at("samplers", sampler);
        if (pointer_of(source) != nullptr)
            return read_pointer(source, animation.samplers[sampler], sampler_place, place, clip);
        const Json& target = source["target"];
        const auto path = track_path(channel.target_path);
        if (!path) {
            document_.report.warn("channel that animates " + quote(channel.target_path) + " left out",
                                  place + ".target");
            return {};
        }
        if (channel.target_node < 0) {
            document_.report.warn("channel without a target node left out", place + ".target");
            return {};
        }
        if (target.contains("extensions")) {
            document_.report.warn("extensions of a channel's target left out", place + ".target.extensions");
        }
        return read_tracks(static_cast<std::size_t>(channel.target_node), *path, animation.samplers[sampler],
                           sampler_place, place);
    }

    std::vector<Track> read_tracks(std::size_t node, TrackPath path, const tinygltf::AnimationSampler& sampler,
                                   const std::string& sampler_place, const std::string& place) {
        const std::size_t components = path == TrackPath::rotation  ? 4
                                       : path == TrackPath::weights ? target_count(node)
                                                                    : 3;
        if (components == 0) {
            document_.report.warn("channel with weights of a node without morph targets left out", place);
            return {};
        }
        // Validated even if unused: a faulty file is an error.
        Keys keys = read_keys(sampler, components, sampler_place);
        const std::uint32_t joint = skeleton_.joint_of_node[node];
        if (joint == kNone) {
            document_.report.warn("channel of a node outside the chosen scene left out", place + ".target.node");
            return {};
        }
        if (path == TrackPath::rotation) check_rotations(keys, sampler_place + ".output");
        if (keys.times.empty()) return {};
        if (path != TrackPath::weights && !document_.model.nodes[node].matrix.empty()) {
            document_.report.warn("channel of a node with a matrix moves the matrix's parts", place + ".target.node");
        }
        Track track;
        track.path = path;
        track.interpolation = keys.interpolation;
        track.components = static_cast<std::uint32_t>(components);
        track.times = std::move(keys.times);
        track.values = std::move(keys.values);
        if (path != TrackPath::weights) {
            track.target = joint;
            std::vector<Track> tracks;
            tracks.push_back(std::move(track));
            return tracks;
        }
        return for_each_mesh(std::move(track), node, place);
    }

    /// Reads a channel of KHR_animation_pointer.
    std::vector<Track> read_pointer(const Json& channel, const tinygltf::AnimationSampler& sampler,
                                    const std::string& sampler_place, const std::string& place, Clip& clip) {
        const Json& target = channel["target"];
        if (target.contains("node"))
            document_.report.warn("node of a channel that animates a pointer left out", place + ".target.node");
        if (target["extensions"].size() > 1)
            document_.report.warn("extensions of a channel's target left out", place + ".target.extensions");
        const std::string& pointer = *pointer_of(channel);
        const PointedProperty pointed =
            pointers_.read(pointer, place + ".target.extensions.KHR_animation_pointer.pointer");
        std::vector<Track> tracks;
        switch (pointed.kind) {
            case PointedProperty::Kind::track:
                tracks = read_tracks(pointed.element, pointed.path, sampler, sampler_place, place);
                break;
            case PointedProperty::Kind::mesh_weights:
                tracks = read_mesh_weights(pointed.element, sampler, sampler_place, place);
                if (tracks.empty()) losses_.add("channels of weights that no node takes", quote(pointer), place);
                break;
            case PointedProperty::Kind::curve:
                read_curve(pointed, channel, sampler, sampler_place, place, clip);
                break;
            case PointedProperty::Kind::left_out:
                losses_.add(pointed.why, quote(pointer), place);
                break;
        }
        return tracks;
    }

    /// One weights track for each node that takes its weights from the mesh.
    std::vector<Track> read_mesh_weights(std::size_t mesh, const tinygltf::AnimationSampler& sampler,
                                         const std::string& sampler_place, const std::string& place) {
        const std::vector<std::size_t>& nodes = pointers_.nodes_weighted_by(mesh);
        const std::size_t components = nodes.empty() ? 0 : target_count(nodes.front());
        std::vector<Track> tracks;
        if (components == 0) return tracks;
        Keys keys = read_keys(sampler, components, sampler_place);
        const Track track{TrackPath::weights,    keys.interpolation,    kNone, static_cast<std::uint32_t>(components),
                          std::move(keys.times), std::move(keys.values)};
        for (const std::size_t node : nodes) {
            document_.budget.take(meshes_[node].size(), sizeof(Track), place);
            for (Track& one : for_each_mesh(track, node, place)) tracks.push_back(std::move(one));
        }
        return tracks;
    }

    void read_curve(const PointedProperty& pointed, const Json& channel, const tinygltf::AnimationSampler& sampler,
                    const std::string& sampler_place, const std::string& place, Clip& clip) {
        const std::size_t components = curve_components(sampler);
        if (components > kMostCurveComponents) {
            losses_.add("channels of a pointer with more than 4 numbers, or with 32-bit integers",
                        quote(*pointer_of(channel)), place);
            return;
        }
        Keys keys = read_keys(sampler, components, sampler_place);
        Curve curve;
        curve.name = curve_name(channel);
        curve.path = pointed.property;
        document_.budget.take(curve.name.size() + curve.path.size(), 1, place);
        curve.kind = pointed.target_kind;
        curve.target = pointed.target;
        curve.interpolation = keys.interpolation;
        curve.components = static_cast<std::uint32_t>(components);
        curve.times = std::move(keys.times);
        curve.values = std::move(keys.values);
        for (const std::uint32_t target : pointed.further) {
            document_.budget.take(curve.times.size() + curve.values.size(), sizeof(float), place);
            document_.budget.take(sizeof(Curve) + curve.name.size() + curve.path.size(), 1, place);
            Curve copy = curve;
            copy.target = target;
            add_curve(std::move(copy), place, clip);
        }
        add_curve(std::move(curve), place, clip);
    }

    /// Adds the weight of the expression that the joint of a track stands for, 0 to 1, as a curve with its name.
    void add_expression(const Track& track, Clip& clip) {
        const auto name = expressions_.find(track.target);
        if (track.path != TrackPath::translation || name == expressions_.end()) return;
        document_.budget.take(track.times.size(), 4 * sizeof(float), place_);
        Curve curve;
        curve.name = name->second;
        curve.path = kExpressionPath;
        curve.kind = CurveTarget::joint;
        curve.target = track.target;
        curve.interpolation = track.interpolation;
        curve.times = track.times;
        for (std::size_t i = 0; i < track.values.size(); i += 3) curve.values.push_back(track.values[i]);
        if (track.interpolation != Interpolation::cubic) {
            for (float& weight : curve.values) weight = std::clamp(weight, 0.0f, 1.0f);
        }
        add_curve(std::move(curve), place_, clip);
    }

    void add_curve(Curve curve, const std::string& place, Clip& clip) {
        const auto [known, is_new] = curve_of_.emplace(own_property_of(curve), clip.curves.size());
        if (is_new) {
            clip.curves.push_back(std::move(curve));
        } else {
            document_.report.warn("second channel for the same target, the last one is taken", place);
            clip.curves[known->second] = std::move(curve);
        }
    }

    /// Components per key; more than 4 if a curve cannot hold them. Arrays of numbers are stored as several scalars per
    /// key. read_keys checks that the count matches the keys.
    [[nodiscard]] std::size_t curve_components(const tinygltf::AnimationSampler& sampler) const {
        const tinygltf::Accessor& output = document_.model.accessors[static_cast<std::size_t>(sampler.output)];
        if (!output.normalized && output.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
            return kMostCurveComponents + 1;
        if (output.type != TINYGLTF_TYPE_SCALAR)
            return output.type == TINYGLTF_TYPE_MAT2 ? kMostCurveComponents + 1 : component_count(output);
        const std::size_t keys = document_.model.accessors[static_cast<std::size_t>(sampler.input)].count;
        const std::size_t of_key = output.count / keys;
        const bool is_cubic = interpolation_of(sampler.interpolation) == Interpolation::cubic;
        return std::max<std::size_t>(1, is_cubic ? of_key / 3 : of_key);
    }

    std::vector<Track> for_each_mesh(Track track, std::size_t node, const std::string& place) const {
        const auto& meshes = meshes_[node];
        if (meshes.empty()) document_.report.warn("channel with weights of a node that draws nothing left out", place);
        std::vector<Track> tracks;
        for (const std::uint32_t mesh : meshes) {
            document_.budget.take(track.times.size() + track.values.size(), sizeof(float), place);
            track.target = mesh;
            tracks.push_back(track);
        }
        return tracks;
    }

    /// Number of morph targets of the node's mesh: the largest among its primitives.
    [[nodiscard]] std::size_t target_count(std::size_t node) const {
        const int mesh = document_.model.nodes[node].mesh;
        if (mesh < 0) return 0;
        const auto index = static_cast<std::size_t>(mesh);
        const auto known = target_counts_.find(index);
        if (known != target_counts_.end()) return known->second;
        std::size_t count = 0;
        for (const auto& primitive : document_.model.meshes[index].primitives) {
            count = std::max(count, primitive.targets.size());
        }
        target_counts_.emplace(index, count);
        return count;
    }

    [[nodiscard]] Keys read_keys(const tinygltf::AnimationSampler& sampler, std::size_t components,
                                 const std::string& place) const {
        const auto input = static_cast<std::size_t>(sampler.input);
        const auto output = static_cast<std::size_t>(sampler.output);
        const auto& accessors = document_.model.accessors;
        Keys keys;
        keys.interpolation = interpolation_of(sampler.interpolation);
        if (accessors[input].type != TINYGLTF_TYPE_SCALAR) {
            fail(place + ".input", at("accessors", input) + " must hold scalars");
        }
        const std::uint64_t per_key = components * (keys.interpolation == Interpolation::cubic ? 3 : 1);
        const std::uint64_t count = accessors[input].count;
        const std::uint64_t found = std::uint64_t{accessors[output].count} * component_count(accessors[output]);
        if (found / per_key != count || found % per_key != 0) {
            fail(place + ".output", at("accessors", output) + ": expected " + std::to_string(count) + " keys of " +
                                        std::to_string(per_key) + " numbers, found " + std::to_string(found) +
                                        " numbers");
        }
        keys.times = read_floats(document_, input, place + ".input");
        for (std::size_t k = 1; k < keys.times.size(); ++k) {
            if (keys.times[k] < keys.times[k - 1]) {
                fail(place + ".input", at("accessors", input) + ", element " + std::to_string(k) +
                                           ": key times must increase, but " + std::to_string(keys.times[k]) +
                                           " follows " + std::to_string(keys.times[k - 1]));
            }
        }
        keys.values = read_floats(document_, output, place + ".output");
        if (const std::uint64_t touched = separate_equal_times(keys); touched > 0) {
            document_.report.warn("keys at the same time: the value jumps there", place + ".input", touched);
        }
        return keys;
    }

    /// Normalises the rotations of linear and step keys. Cubic keys stay: the specification normalises the spline's
    /// result, and value and tangents belong together. Four zeros are not a rotation: such keys are removed.
    void check_rotations(Keys& keys, const std::string& place) const {
        const bool is_cubic = keys.interpolation == Interpolation::cubic;
        const std::size_t stride = is_cubic ? 12 : 4;
        std::uint64_t far_off = 0;
        std::size_t kept = 0;
        for (std::size_t k = 0; k < keys.times.size(); ++k) {
            float* value = keys.values.data() + k * stride + (is_cubic ? 4 : 0);
            const UnitQuaternion unit = make_unit({value[0], value[1], value[2], value[3]});
            if (unit.length == 0.0) continue;
            if (std::abs(unit.length - 1.0) > kUnitTolerance) ++far_off;
            if (!is_cubic) std::copy_n(&unit.value[0], 4, value);
            if (kept != k) {
                keys.times[kept] = keys.times[k];
                std::copy_n(keys.values.data() + k * stride, stride, keys.values.data() + kept * stride);
            }
            ++kept;
        }
        if (kept < keys.times.size())
            document_.report.warn("rotation key is (0, 0, 0, 0), left out", place, keys.times.size() - kept);
        keys.times.resize(kept);
        keys.values.resize(kept * stride);
        if (far_off > 0) {
            document_.report.warn(is_cubic ? "rotation key is not a unit quaternion"
                                           : "rotation key is not a unit quaternion, normalised",
                                  place, far_off);
        }
    }

    const Document& document_;
    const Skeleton& skeleton_;
    const MeshesOfNode& meshes_;
    PointerReader pointers_;
    std::map<std::uint32_t, std::string> expressions_;
    Losses losses_;
    Scene& scene_;
    std::string place_;                            ///< of the animation
    std::map<OwnProperty, std::size_t> curve_of_;  ///< its curves
    mutable std::map<std::size_t, std::size_t> target_counts_;
};

}  // namespace

void import_animations(const Document& document, const Skeleton& skeleton, const MeshesOfNode& meshes, Scene& scene) {
    AnimationImporter importer(document, skeleton, meshes, scene);
    for (std::size_t i = 0; i < document.model.animations.size(); ++i) importer.import(i);
    importer.report_losses();
}

}  // namespace bendy::converter::gltf
