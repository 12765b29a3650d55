#include "gltf_out/skeleton.h"

#include "failure.h"
#include "gltf_out/buffer.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>

namespace bendy::converter::gltf_out {
namespace {

/// Extensions that say accessors or images by number: others have these numbers now.
constexpr std::array kWithSourceNumbers{"EXT_lights_image_based"};

template <class Vector>
std::span<const float> floats_of(const Vector& vector) {
    return {glm::value_ptr(vector), static_cast<std::size_t>(Vector::length())};
}

/// Bit by bit: a negative zero is written too.
template <class Vector>
bool is_same(const Vector& a, const Vector& b) {
    for (int i = 0; i < Vector::length(); ++i) {
        if (std::bit_cast<std::uint32_t>(a[i]) != std::bit_cast<std::uint32_t>(b[i])) return false;
    }
    return true;
}

/// T * R * U (see Transform), column by column, in double.
Json matrix_of(const Transform& rest) {
    const glm::dvec4 q(rest.rotation);
    const glm::dmat3 turn = glm::mat3_cast(glm::dquat(q.w, q.x, q.y, q.z));
    const glm::dvec3 scale(rest.scale);
    const glm::dvec3 shear(rest.shear);
    const glm::dmat3 upper({scale.x, 0.0, 0.0}, {shear.x, scale.y, 0.0}, {shear.y, shear.z, scale.z});
    const glm::dmat3 linear = turn * upper;
    Json matrix = Json::array();
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) matrix.push_back(linear[column][row]);
        matrix.push_back(0.0);
    }
    for (int row = 0; row < 3; ++row) matrix.push_back(double{rest.translation[row]});
    matrix.push_back(1.0);
    return matrix;
}

std::vector<bool> find_moved(const Scene& scene) {
    std::vector<bool> moved(scene.joints.size());
    for (const Cycle& cycle : scene.cycles) {
        for (const Track& track : cycle.tracks) {
            if (track.path != TrackPath::weights) moved[track.target] = true;
        }
    }
    return moved;
}

void add_rest(Json& node, const Transform& rest) {
    const Transform usual;
    if (!is_same(rest.translation, usual.translation)) node["translation"] = numbers(floats_of(rest.translation));
    if (!is_same(rest.rotation, usual.rotation)) node["rotation"] = numbers(floats_of(rest.rotation));
    if (!is_same(rest.scale, usual.scale)) node["scale"] = numbers(floats_of(rest.scale));
}

void add_json(Json& object, const char* member, const std::string& text, const std::string& place, Report& report) {
    if (text.empty()) return;
    constexpr std::size_t kLevelsAround = 8;  // of the document, which may not be deeper than other JSON
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

void add_extensions(Json& object, const std::string& extensions, const std::string& place, Report& report) {
    add_json(object, "extensions", extensions, place, report);
    if (const auto found = object.find("extensions"); found != object.end() && !found->is_object()) {
        report.warn("extensions left out, they are no JSON object", place);
        object.erase(found);
    } else if (found != object.end()) {
        for (const char* name : kWithSourceNumbers) {
            if (found->erase(name) != 0)
                report.warn(std::string("extension left out, numbers in it are the source's: ") + name, place);
        }
        if (found->empty()) object.erase(found);
    }
}

Json export_nodes(const Scene& scene, Report& report) {
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
        add_extensions(node, joint.extensions, place, report);
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

}  // namespace bendy::converter::gltf_out
