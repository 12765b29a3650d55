#include "pointer.h"

#include "scene/curve_property.h"
#include "scene/failure.h"

#include <bendy/format/charconv.h>

#include <algorithm>
#include <array>
#include <utility>

namespace bendy::converter::gltf {
namespace {

constexpr const char* kExtension = "KHR_animation_pointer";

PointedProperty left_out(std::string why) {
    PointedProperty pointed;
    pointed.why = std::move(why);
    return pointed;
}

PointedProperty curve_of(CurveTarget kind, std::uint32_t target, std::string property) {
    PointedProperty pointed;
    pointed.kind = PointedProperty::Kind::curve;
    pointed.target_kind = kind;
    pointed.target = target;
    pointed.property = std::move(property);
    return pointed;
}

/// Splits off the first token of a pointer; the rest starts after the next slash.
std::pair<std::string_view, std::string_view> split(std::string_view pointer) {
    const std::size_t end = std::min(pointer.find('/'), pointer.size());
    return {pointer.substr(0, end), pointer.substr(std::min(end + 1, pointer.size()))};
}

std::size_t read_index(std::string_view token, std::string_view list, std::size_t count, const std::string& place) {
    std::size_t index = 0;
    const auto read = from_chars(token.data(), token.data() + token.size(), index);
    const bool is_number = read.ec == std::errc() && read.ptr == token.data() + token.size() &&
                           (token.size() == 1 || token.front() != '0');
    if (!is_number) fail(place, "expected an index after /" + std::string(list) + "/, found " + quote(token));
    if (index < count) return index;
    fail(place,
         std::string(list) + '[' + std::string(token) + "] does not exist (there are " + std::to_string(count) + ")");
}

/// The arrays whose elements have numbers in the Scene.
bool is_numbered(std::string_view list) {
    constexpr std::array<std::string_view, 5> kLists{"nodes", "materials", "textures", "meshes", "cameras"};
    return std::find(kLists.begin(), kLists.end(), list) != kLists.end();
}

}  // namespace

const std::string* pointer_of(const Json& channel) {
    const Json& target = channel["target"];
    if (target["path"] != "pointer") return nullptr;
    const Json* extensions = find(target, "extensions");
    const Json* extension = extensions == nullptr || !extensions->is_object() ? nullptr : find(*extensions, kExtension);
    const Json* pointer = extension == nullptr ? nullptr : find(*extension, "pointer");
    return pointer == nullptr || !pointer->is_string() ? nullptr : &pointer->text();
}

std::string curve_name(const Json& channel) {
    const Json* extras = find(channel, "extras");
    const Json* name = extras == nullptr || !extras->is_object() ? nullptr : find(*extras, "name");
    return name == nullptr || !name->is_string() ? std::string() : name->get<std::string>();
}

Json without_curve_name(const Json& channel) {
    Json rest = channel;
    if (pointer_of(channel) == nullptr || curve_name(channel).empty()) return rest;
    rest["extras"].erase("name");
    if (rest["extras"].empty()) rest.erase("extras");
    return rest;
}

std::optional<TrackPath> track_path(std::string_view name) {
    if (name == "translation") return TrackPath::translation;
    if (name == "rotation") return TrackPath::rotation;
    if (name == "scale") return TrackPath::scale;
    if (name == "weights") return TrackPath::weights;
    return std::nullopt;
}

PointerReader::PointerReader(const Document& document, const Skeleton& skeleton, const MeshesOfNode& meshes)
    : document_(document),
      skeleton_(skeleton),
      weighted_(array_of(document.json, "meshes").size()),
      first_mesh_(weighted_.size(), kNone),
      camera_joints_(array_of(document.json, "cameras").size()) {
    const Json& nodes = array_of(document.json, "nodes");
    for (std::size_t node = 0; node < nodes.size(); ++node) {
        const Json* mesh = find(nodes[node], "mesh");
        if (mesh == nullptr) continue;
        const auto number = mesh->get<std::size_t>();
        if (!meshes[node].empty() && first_mesh_[number] == kNone) first_mesh_[number] = meshes[node].front();
        if (!meshes[node].empty() && !nodes[node].contains("weights")) weighted_[number].push_back(node);
    }
    for (std::size_t joint = 0; joint < skeleton.node_of_joint.size(); ++joint) {
        if (skeleton.instance_of_joint[joint] != kNone) continue;
        const Json* camera = find(nodes[skeleton.node_of_joint[joint]], "camera");
        if (camera == nullptr) continue;
        camera_joints_[camera->get<std::size_t>()].push_back(static_cast<std::uint32_t>(joint));
    }
}

PointedProperty PointerReader::read(std::string_view pointer, const std::string& place) const {
    if (pointer.empty() || pointer.front() != '/')
        fail(place, "expected a JSON pointer, which begins with '/', found " + quote(pointer));
    const auto [list, inside] = split(pointer.substr(1));
    if (!is_numbered(list)) return curve_of(CurveTarget::nothing, kNone, std::string(pointer));
    const auto [token, property] = split(inside);
    const std::size_t count = array_of(document_.json, std::string(list).c_str()).size();
    const std::size_t index = read_index(token, list, count, place);
    if (property.empty()) return left_out("channels whose pointer names a whole object");
    const auto number = static_cast<std::uint32_t>(index);
    if (list == "materials") return curve_of(CurveTarget::material, number, std::string(property));
    if (list == "textures") return curve_of(CurveTarget::texture, number, std::string(property));
    if (list == "nodes") return read_node(index, property);
    if (list == "meshes") return read_mesh(index, property);
    // Cameras are stored with the joints that use them, and numbered accordingly when written.
    const std::vector<std::uint32_t>& joints = camera_joints_[index];
    if (joints.empty()) return left_out("channels of cameras that no node of the scene has");
    PointedProperty pointed =
        curve_of(CurveTarget::joint, joints.front(), std::string(kCameraPath) + std::string(property));
    pointed.further = std::span(joints).subspan(1);
    return pointed;
}

PointedProperty PointerReader::read_node(std::size_t node, std::string_view property) const {
    if (const auto path = track_path(property)) {
        PointedProperty pointed;
        pointed.kind = PointedProperty::Kind::track;
        pointed.path = *path;
        pointed.element = node;
        return pointed;
    }
    if (property.starts_with("weights/")) return left_out("channels of one morph target's weight");
    const std::uint32_t joint = skeleton_.joint_of_node[node];
    if (joint == kNone) return left_out("channels of nodes outside the chosen scene");
    return curve_of(CurveTarget::joint, joint, std::string(property));
}

PointedProperty PointerReader::read_mesh(std::size_t mesh, std::string_view property) const {
    if (property == "weights") {
        PointedProperty pointed;
        pointed.kind = PointedProperty::Kind::mesh_weights;
        pointed.element = mesh;
        return pointed;
    }
    if (property.starts_with("weights/")) return left_out("channels of one morph target's weight");
    if (first_mesh_[mesh] == kNone) return left_out("channels of meshes that no node of the scene draws");
    if (!property.starts_with("extras/")) return left_out("channels of a mesh that animate its vertices or extensions");
    return curve_of(CurveTarget::mesh, first_mesh_[mesh], std::string(property));
}

}  // namespace bendy::converter::gltf
