#include "formats/gltf/extensions.h"
#include "formats/gltf_out/buffer.h"
#include "formats/gltf_out/parts.h"
#include "scene/failure.h"
#include "scene/space.h"

#include <bendy/format/charconv.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::converter::gltf_out {
namespace {

/// Objects whose presence has a meaning: they are written by other code, or not at all.
bool has_meaning(std::string_view member) {
    constexpr std::array<std::string_view, 9> kSuch{
        "baseColorTexture",    "metallicRoughnessTexture", "normalTexture",    "occlusionTexture", "emissiveTexture",
        "KHR_materials_unlit", "KHR_texture_basisu",       "EXT_texture_avif", "EXT_texture_webp"};
    return std::find(kSuch.begin(), kSuch.end(), member) != kSuch.end();
}

// NOLINTNEXTLINE(misc-no-recursion): parsed JSON is at most 128 levels deep
void merge(Json& object, const Json& more, const std::string& place, Report& report) {
    for (auto member = more.begin(); member != more.end(); ++member) {
        const std::string here = place + '.' + key(member.key());
        const auto known = object.find(member.key());
        const bool is_inner = member->is_object() && member.key() != "extras";
        if (known != object.end() && known->is_object() && is_inner) {
            merge(*known, *member, here, report);
        } else if (known == object.end() && is_inner && has_meaning(member.key())) {
            report.warn("data of a texture or extension that is not used any more left out", here);
        } else if (known == object.end() && is_inner &&
                   (member.key() == "extensions" || member.key() == "pbrMetallicRoughness")) {
            Json made = Json::object();
            merge(made, *member, here, report);
            if (!made.empty()) object[member.key()] = std::move(made);
        } else if (known == object.end() && (member.key() != "name" || member->is_string())) {
            object[member.key()] = *member;
        }
    }
}

}  // namespace

Json read_members(const std::string& more, const std::string& place, Report& report) {
    if (more.empty()) return Json::object();
    constexpr std::size_t kLevelsAround = 8;  // of the document, whose depth is limited like that of other JSON
    try {
        Json members = parse_json_text<Json>(more, report, kMostJsonLevels - kLevelsAround);
        if (members.is_object()) return members;
        report.warn("further members left out: not a JSON object", place);
    } catch (const Failure& failure) {
        report.warn("further members left out: " + failure.error.message, place);
    }
    return Json::object();
}

void leave_out_drafts(Json& members, gltf::Element element, const std::string& place, Report& report) {
    for (const std::string& name : gltf::take_drafts(members, element))
        report.warn("left out, because only glTF 2.1 has it: " + name, place);
}

void add_members(Json& object, const Json& more, gltf::Element element, const std::string& place, Report& report) {
    Json members = gltf::further_members(more, element);
    leave_out_drafts(members, element, place, report);
    merge(object, members, place, report);
}

namespace {

/// Extensions that refer to accessors or images by number; these numbers have changed.
constexpr std::array kWithSourceNumbers{"EXT_lights_image_based"};

template <class Vector>
std::span<const float> floats_of(const Vector& vector) {
    return {glm::value_ptr(vector), static_cast<std::size_t>(Vector::length())};
}

/// Bitwise equality: a negative zero is written too.
template <class Vector>
bool is_same(const Vector& a, const Vector& b) {
    for (int i = 0; i < Vector::length(); ++i) {
        if (bit_cast<std::uint32_t>(a[i]) != bit_cast<std::uint32_t>(b[i])) return false;
    }
    return true;
}

/// T * R * U (see Transform), column by column, in double.
Json matrix_of(const Transform& rest) {
    const glm::dvec4 q(rest.rotation);
    const Local local{glm::dquat(q.w, q.x, q.y, q.z), glm::dvec3(rest.translation), glm::dvec3(rest.scale)};
    return to_affine(local, rest.shear).columns();
}

std::vector<bool> find_moved(const Scene& scene) {
    std::vector<bool> moved(scene.joints.size());
    for (const Clip& clip : scene.clips) {
        for (const Track& track : clip.tracks) {
            if (track.path != TrackPath::weights) moved[track.target] = true;
        }
    }
    return moved;
}

void add_rest(Json& node, const Transform& rest) {
    const Transform usual;
    if (!is_same(rest.translation, usual.translation)) node["translation"] = json_numbers(floats_of(rest.translation));
    if (!is_same(rest.rotation, usual.rotation)) node["rotation"] = json_numbers(floats_of(rest.rotation));
    if (!is_same(rest.scale, usual.scale)) node["scale"] = json_numbers(floats_of(rest.scale));
}

void add_json(Json& object, const char* member, const std::string& text, const std::string& place, Report& report) {
    if (text.empty()) return;
    constexpr std::size_t kLevelsAround = 8;  // of the document, whose depth is limited like that of other JSON
    try {
        object[member] = parse_json_text<Json>(text, report, kMostJsonLevels - kLevelsAround);
    } catch (const Failure& failure) {
        report.warn(std::string(member) + " left out: " + failure.error.message, place);
    }
}

}  // namespace

void add_extras(Json& object, const std::string& extras, const std::string& place, Report& report) {
    add_json(object, "extras", extras, place, report);
}

void add_extensions(Json& object, const std::string& extensions, extensions::Host host,
                    const extensions::NewNumber& numbers, const std::string& place, Report& report) {
    if (extensions.empty()) return;
    const auto renumbered = extensions::renumber_extensions(extensions, host, numbers);
    if (!renumbered) return report.warn("extensions left out, they are not a JSON object", place);
    for (const std::string& gone : renumbered->gone) {
        report.warn("an extension names what is not there: its entry is left out",
                    std::string(place).append(".").append(gone));
    }
    for (const std::string& name : renumbered->unknown)
        report.warn("extension of which the meaning of numbers is not known, written as it is: " + quote(name), place);
    add_json(object, "extensions", renumbered->json, place, report);
    const auto found = object.find("extensions");
    if (found == object.end()) return;
    for (const char* name : kWithSourceNumbers) {
        if (found->erase(name) != 0)
            report.warn(std::string("extension left out, numbers in it are the source's: ") + name, place);
    }
    if (found->empty()) object.erase("extensions");
}

Json export_nodes(const Scene& scene, const extensions::NewNumber& numbers, Report& report) {
    const std::vector<bool> moved = find_moved(scene);
    Json nodes = Json::array();
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
        const Joint& joint = scene.joints[i];
        const std::string place = at("joints", i);
        Json node = Json::object();
        if (!joint.name.empty()) node["name"] = joint.name;
        if (is_same(joint.rest.shear, glm::vec3(0.0f))) {
            add_rest(node, joint.rest);
        } else if (moved[i]) {
            report.warn("shear of an animated joint left out: glTF has no place for it", place);
            add_rest(node, joint.rest);
        } else {
            report.warn("a joint with shear is written as a matrix, which not every reader keeps", place);
            node["matrix"] = matrix_of(joint.rest);
        }
        add_extras(node, joint.extras, place, report);
        add_extensions(node, joint.extensions, extensions::Host::node, numbers, place, report);
        nodes.push_back(std::move(node));
        if (joint.parent != kNone) nodes[joint.parent]["children"].push_back(i);
    }
    return nodes;
}

Json root_nodes(const Scene& scene) {
    Json roots = Json::array();
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
        if (scene.joints[i].parent == kNone) roots.push_back(i);
    }
    return roots;
}

namespace {

/// One attribute's numbers.
struct Numbers {
    std::uint32_t components = 0;
    std::vector<float> floats;
    std::vector<std::uint32_t> integers;  ///< exactly one of the two is filled

    [[nodiscard]] std::size_t elements() const { return std::max(floats.size(), integers.size()) / components; }
};

std::uint32_t components_of(const Json& type) {
    constexpr std::array kTypes{"SCALAR", "VEC2", "VEC3", "VEC4"};
    const auto found = std::find(kTypes.begin(), kTypes.end(), type);
    return found == kTypes.end() ? 0 : static_cast<std::uint32_t>(found - kTypes.begin() + 1);
}

std::optional<Numbers> read_numbers(const Json& attribute) {
    if (!attribute.is_object() || !attribute.contains("type") || !attribute.contains("values")) return std::nullopt;
    Numbers numbers;
    numbers.components = components_of(attribute["type"]);
    const Json& values = attribute["values"];
    if (numbers.components == 0 || !values.is_array() || values.empty() || values.size() % numbers.components != 0)
        return std::nullopt;
    const bool are_integers = attribute["integers"] == true;
    for (const Json& value : values) {
        if (are_integers) {
            if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
                return std::nullopt;
            numbers.integers.push_back(value.get<std::uint32_t>());
        } else {
            if (!value.is_number() || !(std::abs(value.get<double>()) <= double{std::numeric_limits<float>::max()}))
                return std::nullopt;
            numbers.floats.push_back(value.get<float>());
        }
    }
    return numbers;
}

/// Writes the attributes; false unless all hold numbers, in equal counts.
bool export_attributes(Json& extension, Buffer& buffer) {
    if (!extension.is_object() || !extension.contains("attributes")) return false;
    Json& attributes = extension["attributes"];
    if (!attributes.is_object() || attributes.empty()) return false;
    std::vector<std::pair<std::string, Numbers>> all;
    for (auto attribute = attributes.begin(); attribute != attributes.end(); ++attribute) {
        std::optional<Numbers> numbers = read_numbers(*attribute);
        if (!numbers || (!all.empty() && all.front().second.elements() != numbers->elements())) return false;
        all.emplace_back(attribute.key(), *std::move(numbers));
    }
    for (const auto& [name, numbers] : all) {
        attributes[name] = numbers.integers.empty()
                               ? buffer.add_floats(numbers.floats, numbers.components, Buffer::Use::data, false)
                               : buffer.add_integers(numbers.integers, numbers.components, Buffer::Use::data);
    }
    return true;
}

}  // namespace

void export_instances(Json& nodes, Buffer& buffer, Report& report) {
    const std::string name(gltf::kInstancing);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto extensions = nodes[i].find("extensions");
        if (extensions == nodes[i].end()) continue;
        const auto extension = extensions->find(name);
        if (extension == extensions->end() || export_attributes(*extension, buffer)) continue;
        report.warn("extension left out, numbers in it are the source's: " + name, at("joints", i));
        extensions->erase(extension);
        if (extensions->empty()) nodes[i].erase("extensions");
    }
}

}  // namespace bendy::converter::gltf_out
