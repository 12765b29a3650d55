#include "formats/gltf_out/curves.h"

#include "scene/curve_property.h"
#include "scene/failure.h"

#include <bendy/format/charconv.h>
#include <bendy/format/curve.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace bendy::converter::gltf_out {
namespace {

/// Unescapes a token of a JSON pointer.
std::string unescaped(std::string_view token) {
    std::string name;
    for (std::size_t i = 0; i < token.size(); ++i) {
        const bool is_escape = token[i] == '~' && i + 1 < token.size() && (token[i + 1] == '0' || token[i + 1] == '1');
        name += !is_escape ? token[i] : token[i + 1] == '0' ? '~' : '/';
        i += is_escape ? 1 : 0;
    }
    return name;
}

/// Objects that mean the same whether absent or empty: glTF omits them if everything in them has its default.
bool is_default_if_empty(std::string_view member) {
    return member == "pbrMetallicRoughness" || member == "extensions" || member == "KHR_texture_transform";
}

/// The element or member for a token; null if there is none.
Json* inner(Json& json, std::string_view token) {
    if (json.is_object()) {
        const auto member = json.find(unescaped(token));
        return member == json.end() ? nullptr : &*member;
    }
    if (!json.is_array()) return nullptr;
    std::size_t index = 0;
    const auto read = from_chars(token.data(), token.data() + token.size(), index);
    if (read.ec != std::errc() || read.ptr != token.data() + token.size() || index >= json.size()) return nullptr;
    return &json[index];
}

/// Whether the document has the object that contains a pointer's property. Creates the objects of is_default_if_empty.
bool open_parent(Json& root, std::string_view pointer) {
    if (pointer.empty() || pointer.front() != '/') return false;
    Json* json = &root;
    for (std::string_view rest = pointer.substr(1);;) {
        const std::size_t end = rest.find('/');
        const std::string_view token = rest.substr(0, end);
        if (end == std::string_view::npos) {
            return !token.empty() && (json->is_object() || inner(*json, token) != nullptr);
        }
        if (token == "extras") return true;  // the author's own
        Json* next = inner(*json, token);
        if (next == nullptr && json->is_object() && is_default_if_empty(token)) {
            // Inside extensions, only KHR_texture_transform may be created: the presence of others has a meaning.
            const std::string_view following = rest.substr(end + 1);
            const bool is_known = token != "extensions" || following.starts_with("KHR_texture_transform/");
            if (is_known) next = &((*json)[std::string(token)] = Json::object());
        }
        if (next == nullptr) return false;
        json = next;
        rest.remove_prefix(end + 1);
    }
}

class CurveExporter {
public:
    CurveExporter(std::span<const std::uint32_t> node_of_mesh, Json& root, Buffer& buffer, Report& report)
        : node_of_mesh_(node_of_mesh), root_(root), buffer_(buffer), report_(report) {
        const Json& nodes = gltf::array_of(root, "nodes");
        for (std::uint32_t node = 0; node < nodes.size(); ++node) {
            const auto camera = nodes[node].find("camera");
            if (camera != nodes[node].end()) node_of_camera_.try_emplace(camera->get<std::size_t>(), node);
        }
    }

    void write(const Clip& clip, Json& animation, const std::string& place) {
        const float shift = shift_of(clip);
        moved_.clear();
        for (const Track& track : clip.tracks) {
            if (track.path == TrackPath::translation) moved_.insert(track.target);
        }
        for (std::size_t c = 0; c < clip.curves.size(); ++c) {
            const Curve& curve = clip.curves[c];
            if (is_written_already(curve)) continue;
            const std::string pointer = pointer_to(curve);
            if (pointer.empty() || !open_parent(root_, pointer)) {
                report_.warn(curve.path.empty()
                                 ? "curve left out: " + quote(curve.name) + " has no path, which glTF needs"
                                 : "curve left out: the file has no " + quote(pointer.empty() ? curve.path : pointer),
                             place + '.' + at("curves", c));
                continue;
            }
            Json sampler{{"input", add_times(curve.times, shift, buffer_)},
                         {"output", buffer_.add_floats(curve.values, curve.components, Buffer::Use::data, false)}};
            if (curve.interpolation != Interpolation::linear)
                sampler["interpolation"] = interpolation_name(curve.interpolation);
            Json channel{
                {"sampler", animation["samplers"].size()},
                {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}};
            if (!curve.name.empty()) channel["extras"]["name"] = curve.name;
            animation["samplers"].push_back(std::move(sampler));
            animation["channels"].push_back(std::move(channel));
        }
    }

private:
    /// The JSON pointer to the curve's property; empty if the target is not in the document.
    [[nodiscard]] std::string pointer_to(const Curve& curve) const {
        switch (curve.kind) {
            case CurveTarget::joint:
                return of_joint(curve);
            case CurveTarget::material:
                return "/materials/" + std::to_string(curve.target) + '/' + curve.path;
            case CurveTarget::texture:
                return "/textures/" + std::to_string(curve.target) + '/' + curve.path;
            case CurveTarget::mesh: {
                const std::uint32_t node = node_of_mesh_[curve.target];
                if (node == kNone) return {};
                return "/meshes/" + root_["nodes"][node]["mesh"].dump() + '/' + curve.path;
            }
            default:
                return curve.path;
        }
    }

    /// Nodes share a camera only if the same curves move it. An expression is part of its joint's track.
    [[nodiscard]] bool is_written_already(const Curve& curve) const {
        if (curve.kind != CurveTarget::joint) return false;
        if (curve.path == kExpressionPath) return moved_.contains(curve.target);
        if (!curve.path.starts_with(kCameraPath)) return false;
        const Json& node = root_["nodes"][curve.target];
        const auto camera = node.find("camera");
        return camera != node.end() && node_of_camera_.at(camera->get<std::size_t>()) != curve.target;
    }

    /// The pointer for a joint's curve; cameras have their own array in glTF.
    [[nodiscard]] std::string of_joint(const Curve& curve) const {
        const Json& node = root_["nodes"][curve.target];
        if (!curve.path.starts_with(kCameraPath)) return "/nodes/" + std::to_string(curve.target) + '/' + curve.path;
        if (!node.contains("camera")) return {};
        return "/cameras/" + node["camera"].dump() + '/' + curve.path.substr(kCameraPath.size());
    }

    std::span<const std::uint32_t> node_of_mesh_;
    std::unordered_set<std::uint32_t> moved_;                        ///< joints that the clip translates
    std::unordered_map<std::size_t, std::uint32_t> node_of_camera_;  ///< the first node that uses the camera
    Json& root_;
    Buffer& buffer_;
    Report& report_;
};

}  // namespace

void export_curves(const Scene& scene, std::span<const std::uint32_t> animation_of_clip,
                   std::span<const std::uint32_t> node_of_mesh, Json& root, Buffer& buffer, Report& report) {
    CurveExporter exporter(node_of_mesh, root, buffer, report);
    bool is_one_empty = false;
    for (std::size_t i = 0; i < scene.clips.size(); ++i) {
        if (scene.clips[i].curves.empty()) continue;
        Json animation = std::move(root["animations"][animation_of_clip[i]]);
        exporter.write(scene.clips[i], animation, at("clips", i));
        if (!animation.contains("channels")) {
            is_one_empty = true;
            report.warn("a clip that moves nothing is left out", at("clips", i));
        }
        root["animations"][animation_of_clip[i]] = std::move(animation);
    }
    if (!is_one_empty) return;
    Json& animations = root["animations"];
    Json kept = Json::array();
    for (Json& animation : animations) {
        if (animation.contains("channels")) kept.push_back(std::move(animation));
    }
    if (kept.empty()) {
        root.erase("animations");
    } else {
        animations = std::move(kept);
    }
}

}  // namespace bendy::converter::gltf_out
