#include "formats/gltf_out/parts.h"
#include "optimise/measure_error.h"
#include "scene/failure.h"
#include "scene/frame_shapes.h"

#include <bendy/format/charconv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

namespace bendy::converter::gltf_out {
namespace {

const char* path_name(TrackPath path) {
    switch (path) {
        case TrackPath::translation:
            return "translation";
        case TrackPath::rotation:
            return "rotation";
        case TrackPath::scale:
            return "scale";
        default:
            return "weights";
    }
}

/// Converts a play of frames to timed keys of weights: one per frame, and for closed ones the first again at the end.
Track weights_track(const Scene& scene, const Clip& clip, const Play& play) {
    const Mesh& mesh = scene.meshes[play.mesh];
    const std::size_t targets = mesh.targets.size();
    const std::uint32_t keys = play.frames + (play.closed ? 1 : 0);
    Track track;
    track.path = TrackPath::weights;
    track.target = play.mesh;
    track.components = static_cast<std::uint32_t>(targets);
    track.values.reserve(keys * targets);
    for (std::uint32_t key = 0; key < keys; ++key) {
        const auto time = static_cast<float>(clip.frame_start + key / double{clip.frame_rate});
        const bool ascends = track.times.empty() || time > track.times.back();
        track.times.push_back(ascends ? time
                                      : std::nextafter(track.times.back(), std::numeric_limits<float>::infinity()));
        for (const MorphTarget& target : mesh.targets)
            track.values.push_back(target.is_frame ? 0.0f : target.rest_weight);
        const std::uint32_t frame = play.first + key % play.frames;
        if (frame != 0) track.values[key * targets + first_frame(mesh) + frame - 1] = 1.0f;
    }
    return track;
}

/// The number with the fewest digits that rounds to this float.
double shortest(float number) {
    std::array<char, 32> text{};
    const auto end = to_chars(text.data(), text.data() + text.size(), number).ptr;
    double back = 0.0;
    from_chars(text.data(), end, back);
    return back;
}

class AnimationExporter {
public:
    AnimationExporter(const Scene& scene, std::span<const std::uint32_t> node_of_mesh, Buffer& buffer, Report& report)
        : scene_(scene), node_of_mesh_(node_of_mesh), buffer_(buffer), report_(report) {}

    ExportedAnimations run() {
        ExportedAnimations exported;
        for (std::size_t i = 0; i < scene_.clips.size(); ++i) {
            Json animation = write(scene_.clips[i], at("clips", i));
            const bool is_kept = animation.contains("channels") || !scene_.clips[i].curves.empty();
            const auto number = static_cast<std::uint32_t>(exported.animations.size());
            exported.animation_of_clip.push_back(is_kept ? number : kNone);
            if (is_kept) {
                exported.animations.push_back(std::move(animation));
            } else {
                report_.warn("a clip that moves nothing is left out", at("clips", i));
            }
        }
        return exported;
    }

private:
    Json write(const Clip& clip, const std::string& place) {
        Json animation = Json::object();
        if (!clip.name.empty()) animation["name"] = clip.name;
        add_extras(animation, clip.extras, place, report_);
        add_members(animation, read_members(clip.more, place, report_), gltf::Element::animation, place, report_);
        if (clip.loop) mark_as_loop(animation, place);
        shift_ = shift_of(clip);
        if (shift_ > 0.0f) report_.warn("clip that begins before 0 s is moved to begin there", place);
        add_markers(clip, animation, place);
        weighted_nodes_.clear();
        for (std::size_t t = 0; t < clip.tracks.size(); ++t) {
            const Track& track = clip.tracks[t];
            if (track.path != TrackPath::rotation || track.interpolation != Interpolation::cubic) {
                add_channel(track, animation);
                continue;
            }
            Track spline = track;
            drop_zero_rotations(spline, place + "." + at("tracks", t));
            if (!spline.times.empty()) add_channel(spline, animation);
        }
        for (const Play& play : clip.plays) add_channel(weights_track(scene_, clip, play), animation);
        if (const ClipSpan span = span_of(clip); span != span_of_keys(clip)) hold(clip, span, animation, place);
        return animation;
    }

    /// glTF's animations are as long as their keys: adds a channel for a property that no track moves, to keep a longer
    /// clip's length.
    void hold(const Clip& clip, const ClipSpan& span, Json& animation, const std::string& place) {
        const auto is_free = [&](std::uint32_t joint) {
            return scene_.joints[joint].rest.shear == glm::vec3(0.0f) &&
                   std::none_of(clip.tracks.begin(), clip.tracks.end(), [&](const Track& track) {
                       return track.path == TrackPath::translation && track.target == joint;
                   });
        };
        std::uint32_t joint = 0;
        while (joint < scene_.joints.size() && !is_free(joint)) ++joint;
        if (joint == scene_.joints.size()) {
            report_.warn("clip that is longer than its keys is written as long as they are", place);
            return;
        }
        Track still{TrackPath::translation, Interpolation::linear, joint, 3, {span.start}, {}};
        if (span.end > span.start) still.times.push_back(span.end);
        const glm::vec3& at_rest = scene_.joints[joint].rest.translation;
        for (std::size_t key = 0; key < still.times.size(); ++key)
            still.values.insert(still.values.end(), {at_rest.x, at_rest.y, at_rest.z});
        add_channel(still, animation);
        report_.warn("clip that is longer than its keys: a channel that holds joint " +
                         quoted_name(scene_.joints[joint].name, joint) + " where it rests keeps its length",
                     place);
    }

    /// A cubic rotation key may have any length here; glTF readers interpret the four numbers as a rotation, which four
    /// zeros are not: such keys are removed.
    void drop_zero_rotations(Track& track, const std::string& place) {
        constexpr std::size_t kStride = 12;
        std::size_t kept = 0;
        for (std::size_t k = 0; k < track.times.size(); ++k) {
            const float* const key = track.values.data() + k * kStride;
            if (std::all_of(key + 4, key + 8, [](float number) { return number == 0.0f; })) continue;
            track.times[kept] = track.times[k];
            std::copy_n(key, kStride, track.values.data() + kept * kStride);
            ++kept;
        }
        if (kept == track.times.size()) return;
        report_.warn("rotation key is (0, 0, 0, 0), which glTF cannot hold, left out", place,
                     track.times.size() - kept);
        track.times.resize(kept);
        track.values.resize(kept * kStride);
    }

    /// The animation's extras, for adding members; null, after a warning, if they are not an object.
    Json* extras_of(Json& animation, const char* what, const std::string& place) {
        Json& extras = animation["extras"];
        if (extras.is_null()) extras = Json::object();
        if (extras.is_object()) return &extras;
        report_.warn(std::string(what) + " left out: the clip's extras are not an object", place);
        return nullptr;
    }

    void mark_as_loop(Json& animation, const std::string& place) {
        Json* extras = extras_of(animation, "that a clip repeats is", place);
        if (extras == nullptr) return;
        const auto loop = extras->find("loop");
        if (loop == extras->end() || (*loop != true && *loop != 1)) (*extras)["loop"] = true;
    }

    void add_markers(const Clip& clip, Json& animation, const std::string& place) {
        if (clip.markers.empty()) return;
        Json* extras = extras_of(animation, "markers are", place);
        if (extras == nullptr) return;
        Json list = Json::array();
        for (const Marker& marker : clip.markers)
            list.push_back({{"time", shortest(marker.seconds + shift_)}, {"name", marker.name}});
        (*extras)["markers"] = std::move(list);
    }

    void add_channel(const Track& track, Json& animation) {
        const bool is_weights = track.path == TrackPath::weights;
        const std::uint32_t node = is_weights ? node_of_mesh_[track.target] : track.target;
        if (node == kNone) return;                                       // the mesh was left out, with a warning
        if (is_weights && !weighted_nodes_.insert(node).second) return;  // another mesh has the same weights
        Json sampler{{"input", add_times(track.times, shift_, buffer_)},
                     {"output", buffer_.add_floats(track.values, output_components(track), Buffer::Use::data, false)}};
        if (track.interpolation != Interpolation::linear)
            sampler["interpolation"] = interpolation_name(track.interpolation);
        const std::size_t number = animation["samplers"].size();
        animation["samplers"].push_back(std::move(sampler));
        animation["channels"].push_back(
            {{"sampler", number}, {"target", {{"node", node}, {"path", path_name(track.path)}}}});
    }

    static std::uint32_t output_components(const Track& track) {
        return track.path == TrackPath::weights ? 1 : track.components;
    }

    const Scene& scene_;
    std::span<const std::uint32_t> node_of_mesh_;
    Buffer& buffer_;
    Report& report_;
    float shift_ = 0.0f;                                ///< seconds, of the current clip
    std::unordered_set<std::uint32_t> weighted_nodes_;  ///< of the current clip: meshes of a node share a channel
};

}  // namespace

namespace {

template <class T>
void append_bytes(const std::vector<T>& values, std::string& to) {
    const std::size_t count = values.size();
    to.append(reinterpret_cast<const char*>(&count), sizeof count);
    to.append(reinterpret_cast<const char*>(values.data()), count * sizeof(T));
}

void append_text(const std::string& text, std::string& to) {
    append_bytes(std::vector<char>(text.begin(), text.end()), to);
}

}  // namespace

void append_motion(const Curve& curve, std::size_t clip, std::string& motion) {
    const std::vector<std::size_t> numbers{clip, static_cast<std::size_t>(curve.interpolation), curve.components};
    append_bytes(numbers, motion);
    append_text(curve.name, motion);
    append_text(curve.path, motion);
    append_bytes(curve.times, motion);
    append_bytes(curve.values, motion);
}

void append_motion(const Track& track, std::size_t clip, std::string& motion) {
    append_bytes(std::vector<std::size_t>{clip, static_cast<std::size_t>(track.interpolation)}, motion);
    append_bytes(track.times, motion);
    append_bytes(track.values, motion);
}

void append_motion(const Play& play, std::size_t clip, std::string& motion) {
    append_bytes(std::vector<std::size_t>{clip, play.first, play.frames, play.closed ? 1U : 0U}, motion);
}

const char* interpolation_name(Interpolation interpolation) {
    switch (interpolation) {
        case Interpolation::step:
            return "STEP";
        case Interpolation::cubic:
            return "CUBICSPLINE";
        default:
            return "LINEAR";
    }
}

float shift_of(const Clip& clip) {
    const float start = span_of(clip).start;
    return start < 0.0f ? -start : 0.0f;
}

std::uint32_t add_times(const std::vector<float>& times, float shift, Buffer& buffer) {
    if (shift == 0.0f) return buffer.add_floats(times, 1, Buffer::Use::data, true);
    std::vector<float> moved(times);
    for (std::size_t k = 0; k < moved.size(); ++k) {  // times must ascend, but rounding may break that
        moved[k] += shift;
        if (k > 0) moved[k] = std::max(moved[k], std::nextafter(moved[k - 1], std::numeric_limits<float>::max()));
    }
    return buffer.add_floats(moved, 1, Buffer::Use::data, true);
}

ExportedAnimations export_animations(const Scene& scene, std::span<const std::uint32_t> node_of_mesh, Buffer& buffer,
                                     Report& report) {
    return AnimationExporter(scene, node_of_mesh, buffer, report).run();
}

}  // namespace bendy::converter::gltf_out
