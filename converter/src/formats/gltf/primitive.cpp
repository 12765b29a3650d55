#include "primitive.h"

#include "accessor.h"
#include "draco.h"
#include "scene/failure.h"

#include <bendy/format/charconv.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

namespace bendy::converter::gltf {
namespace {

/// Values of one attribute.
struct Attribute {
    std::size_t components = 0;
    std::size_t count = 0;
    std::vector<float> values;
};

/// Parses n of `PREFIXn`, as the specification writes it: no sign, no leading zeros.
std::optional<std::uint32_t> set_number(std::string_view name, std::string_view prefix) {
    if (name.substr(0, prefix.size()) != prefix) return std::nullopt;
    name.remove_prefix(prefix.size());
    std::uint32_t number = 0;
    const char* end = name.data() + name.size();
    const auto parsed = from_chars(name.data(), end, number);
    if (name.empty() || parsed.ec != std::errc() || parsed.ptr != end || (name[0] == '0' && name.size() > 1)) {
        return std::nullopt;
    }
    return number;
}

/// The first three of each `components` values.
std::vector<glm::vec3> as_vec3(const std::vector<float>& values, std::size_t components = 3) {
    std::vector<glm::vec3> vectors(values.size() / components);
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        const float* from = values.data() + i * components;
        vectors[i] = {from[0], from[1], from[2]};
    }
    return vectors;
}

std::vector<glm::vec4> as_vec4(const std::vector<float>& values) {
    std::vector<glm::vec4> vectors(values.size() / 4);
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        vectors[i] = {values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]};
    }
    return vectors;
}

class PrimitiveReader {
public:
    PrimitiveReader(const Document& document, const tinygltf::Primitive& primitive, const Json& json, std::string place)
        : document_(document), primitive_(primitive), place_(std::move(place)) {
        if (const Json* extension = find_draco(json); extension != nullptr) {
            draco_ = decode_draco(document, primitive, *extension, place_);
        }
    }

    Vertices read(bool skinned) {
        Vertices vertices;
        Mesh& mesh = vertices.mesh;
        Attribute positions = read_attribute("POSITION", 3, 3);
        count_ = positions.count;
        mesh.positions = as_vec3(positions.values);
        if (has("NORMAL")) mesh.normals = as_vec3(read_attribute("NORMAL", 3, 3, read_floats_or_zero).values);
        if (has("TANGENT")) mesh.tangents = as_vec4(read_attribute("TANGENT", 4, 4, read_floats_or_zero).values);
        read_streams(mesh);
        if (skinned) read_influences(vertices);
        read_targets(mesh);
        if (draco_) vertices.draco_indices = std::move(draco_->indices);
        return vertices;
    }

private:
    [[nodiscard]] bool has(const std::string& name) const {
        return primitive_.attributes.count(name) > 0 || (draco_ && draco_->attributes.count(name) > 0);
    }

    [[nodiscard]] std::string attribute_place(const std::string& name) const {
        return place_ + ".attributes." + key(name);
    }

    /// Reads an attribute with `low` to `high` components and as many elements as POSITION.
    /// \param read_accessor  read_floats or read_floats_or_zero
    Attribute read_attribute(const std::string& name, std::size_t low, std::size_t high,
                             decltype(&read_floats) read_accessor = read_floats) {
        const std::string place = attribute_place(name);
        Attribute attribute;
        if (draco_ && draco_->attributes.count(name) > 0) {
            auto& decoded = draco_->attributes[name];
            attribute.components = decoded.components;
            attribute.values = std::move(decoded.values);
            attribute.count = draco_->count;
            check(attribute, low, high, place);
            return attribute;
        }
        const auto index = static_cast<std::size_t>(primitive_.attributes.at(name));
        const auto& accessor = document_.model.accessors[index];
        attribute.components = component_count(accessor);
        attribute.count = accessor.count;
        check(attribute, low, high, place);
        attribute.values = read_accessor(document_, index, place);
        return attribute;
    }

    void check(const Attribute& attribute, std::size_t low, std::size_t high, const std::string& place) const {
        if (attribute.components < low || attribute.components > high) {
            fail(place, "expected elements of " + std::to_string(low) +
                            (low == high ? "" : " to " + std::to_string(high)) + " components, found " +
                            std::to_string(attribute.components));
        }
        check_count(attribute.count, place);
    }

    void check_count(std::size_t count, const std::string& place) const {
        if (count_ && count != *count_) {
            fail(place, std::to_string(count) + " elements, but POSITION has " + std::to_string(*count_));
        }
    }

    /// Reads texture coordinates and colours by set number, and all attributes that the specification does not define.
    void read_streams(Mesh& mesh) {
        std::map<std::uint32_t, std::string> texture_coords;
        std::map<std::uint32_t, std::string> colours;
        std::vector<std::string> others;
        const auto sort = [&](const std::string& name) {
            if (const auto set = set_number(name, "TEXCOORD_")) {
                texture_coords.emplace(*set, name);
            } else if (const auto colour = set_number(name, "COLOR_")) {
                colours.emplace(*colour, name);
            } else if (name != "POSITION" && name != "NORMAL" && name != "TANGENT" && !set_number(name, "JOINTS_") &&
                       !set_number(name, "WEIGHTS_")) {
                others.push_back(name);
            }
        };
        for (const auto& [name, accessor] : primitive_.attributes) sort(name);
        if (draco_) {
            for (const auto& [name, attribute] : draco_->attributes) {
                if (primitive_.attributes.count(name) == 0) sort(name);
            }
        }
        for (const auto& [set, name] : texture_coords) {
            mesh.texture_coords.push_back(make_stream({}, set, read_attribute(name, 2, 2)));
        }
        for (const auto& [set, name] : colours) {
            mesh.colours.push_back(make_stream({}, set, read_attribute(name, 3, 4)));
        }
        std::sort(others.begin(), others.end());
        for (const std::string& name : others) {
            mesh.attributes.push_back(make_stream(name, 0, read_attribute(name, 1, 16)));
            report_inexact(name);
        }
    }

    static Stream make_stream(std::string name, std::uint32_t set, Attribute&& attribute) {
        Stream stream;
        stream.name = std::move(name);
        stream.set = set;
        stream.components = static_cast<std::uint32_t>(attribute.components);
        stream.values = std::move(attribute.values);
        return stream;
    }

    /// Reports 32-bit identifiers, the only component type that a float may not hold exactly.
    void report_inexact(const std::string& name) const {
        const auto named = primitive_.attributes.find(name);
        if (named == primitive_.attributes.end()) return;
        const auto& accessor = document_.model.accessors[static_cast<std::size_t>(named->second)];
        if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
            document_.report.warn("32-bit integers of attribute " + quote(name) + " are kept as floats (exact to 2^24)",
                                  attribute_place(name), accessor.count);
        }
    }

    void read_influences(Vertices& vertices) {
        std::vector<Attribute> weights;
        std::vector<std::vector<std::uint32_t>> bones;
        for (std::uint32_t set = 0;; ++set) {
            const std::string joints_name = "JOINTS_" + std::to_string(set);
            const std::string weights_name = "WEIGHTS_" + std::to_string(set);
            if (!has(joints_name) || !has(weights_name)) break;
            bones.push_back(read_bones(joints_name));
            weights.push_back(read_attribute(weights_name, 4, 4, read_floats_or_zero));
        }
        report_loose_sets(bones.size());
        if (bones.empty()) return;
        Influences influences;
        influences.per_vertex = bones.size() * 4;
        if (bones.size() == 1) {
            influences.bones = std::move(bones.front());
            influences.weights = std::move(weights.front().values);
        } else {
            join_sets(bones, weights, influences);
        }
        vertices.largest_bone = normalise_influences(influences, attribute_place("WEIGHTS_0"), document_.report);
        vertices.mesh.influences = static_cast<std::uint32_t>(influences.per_vertex);
        vertices.mesh.bones = std::move(influences.bones);
        vertices.mesh.weights = std::move(influences.weights);
    }

    /// Joins the sets' four influences of each vertex.
    void join_sets(const std::vector<std::vector<std::uint32_t>>& bones, const std::vector<Attribute>& weights,
                   Influences& influences) const {
        document_.budget.take(*count_, influences.per_vertex * 8, place_);
        influences.bones.resize(*count_ * influences.per_vertex);
        influences.weights.resize(*count_ * influences.per_vertex);
        for (std::size_t v = 0; v < *count_; ++v) {
            for (std::size_t i = 0; i < influences.per_vertex; ++i) {
                influences.bones[v * influences.per_vertex + i] = bones[i / 4][v * 4 + i % 4];
                influences.weights[v * influences.per_vertex + i] = weights[i / 4].values[v * 4 + i % 4];
            }
        }
    }

    std::vector<std::uint32_t> read_bones(const std::string& name) {
        if (draco_ && draco_->attributes.count(name) > 0) {
            const Attribute decoded = read_attribute(name, 4, 4);
            std::vector<std::uint32_t> bones;
            bones.reserve(decoded.values.size());
            for (const float value : decoded.values) {
                if (!(value >= 0.0f && value < 16777216.0f)) {
                    fail(attribute_place(name), "a joint index cannot be " + std::to_string(value));
                }
                bones.push_back(static_cast<std::uint32_t>(value));
            }
            return bones;
        }
        const auto index = static_cast<std::size_t>(primitive_.attributes.at(name));
        const auto& accessor = document_.model.accessors[index];
        Attribute shape;
        shape.components = component_count(accessor);
        shape.count = accessor.count;
        check(shape, 4, 4, attribute_place(name));
        return read_unsigned(document_, index, attribute_place(name));
    }

    /// Reports sets without effect: JOINTS_n without WEIGHTS_n or vice versa, and sets after a gap.
    void report_loose_sets(std::size_t sets) const {
        for (const auto& [name, accessor] : primitive_.attributes) {
            const auto joints = set_number(name, "JOINTS_");
            const auto weights = set_number(name, "WEIGHTS_");
            if ((joints && *joints >= sets) || (weights && *weights >= sets)) {
                document_.report.warn("attribute " + quote(name) + " without its counterpart left out",
                                      attribute_place(name));
            }
        }
    }

    void read_targets(Mesh& mesh) {
        mesh.targets.resize(primitive_.targets.size());
        for (std::size_t t = 0; t < primitive_.targets.size(); ++t) {
            const std::string target_place = place_ + '.' + at("targets", t);
            for (const auto& [name, accessor] : primitive_.targets[t]) {
                const std::string place = target_place + '.' + key(name);
                MorphTarget& target = mesh.targets[t];
                std::vector<glm::vec3>* stream = nullptr;
                if (name == "POSITION") stream = &target.positions;
                if (name == "NORMAL" && !mesh.normals.empty()) stream = &target.normals;
                if (name == "TANGENT" && !mesh.tangents.empty()) stream = &target.tangents;
                if (stream == nullptr) {
                    document_.report.warn("morph target attribute " + quote(name) + " left out", place);
                    continue;
                }
                const auto index = static_cast<std::size_t>(accessor);
                const auto& source = document_.model.accessors[index];
                const std::size_t components = component_count(source);
                // Some exporters give tangents the base stream's fourth component; it is not displaced.
                if (components != 3 && !(name == "TANGENT" && components == 4)) {
                    fail(place, "expected elements of 3 components, found " + std::to_string(components));
                }
                check_count(source.count, place);
                *stream = as_vec3(read_floats(document_, index, place), components);
            }
        }
    }

    const Document& document_;
    const tinygltf::Primitive& primitive_;
    std::string place_;
    std::optional<DracoPrimitive> draco_;
    std::optional<std::size_t> count_;  ///< vertices, once POSITION is read
};

/// The sequence of vertices that a primitive uses.
std::vector<std::uint32_t> read_sequence(const Document& document, int indices, std::size_t vertex_count, bool is_list,
                                         const std::string& place) {
    if (indices < 0) {
        document.budget.take(vertex_count, sizeof(std::uint32_t), place);
        std::vector<std::uint32_t> sequence(vertex_count);
        for (std::size_t i = 0; i < vertex_count; ++i) sequence[i] = static_cast<std::uint32_t>(i);
        return sequence;
    }
    const std::string here = place + ".indices";
    const auto index = static_cast<std::size_t>(indices);
    const auto& accessor = document.model.accessors[index];
    const int type = accessor.componentType;
    if (accessor.type != TINYGLTF_TYPE_SCALAR ||
        (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
         type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)) {
        fail(here, at("accessors", index) + " must hold unsigned scalars");
    }
    const std::uint32_t restart = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? 0xffu
                                  : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 0xffffu
                                                                                   : 0xffffffffu;
    std::vector<std::uint32_t> sequence = read_unsigned(document, index, here);
    for (std::size_t i = 0; i < sequence.size(); ++i) {
        if (sequence[i] >= vertex_count) {
            fail(here, "element " + std::to_string(i) + ": index " + std::to_string(sequence[i]) +
                           " is out of range (there are " + std::to_string(vertex_count) + " vertices)");
        }
        // In a list it can only be a vertex index.
        if (sequence[i] == restart && !is_list) {
            fail(here, "element " + std::to_string(i) + ": " + std::to_string(restart) +
                           " would restart the primitive, which glTF forbids");
        }
    }
    return sequence;
}

}  // namespace

namespace {

/// The array of target names in an object's extras; null if there is none.
const Json* names_in(const Json& owner) {
    const Json* extras = find(owner, "extras");
    const Json* names = extras != nullptr && extras->is_object() ? find(*extras, "targetNames") : nullptr;
    return names != nullptr && names->is_array() ? names : nullptr;
}

}  // namespace

std::vector<std::string> target_names(const Json& owner, std::size_t count) {
    std::vector<std::string> names(count);
    const Json* said = names_in(owner);
    for (std::size_t t = 0; said != nullptr && t < std::min(count, said->size()); ++t) {
        if ((*said)[t].is_string()) names[t] = (*said)[t].get<std::string>();
    }
    return names;
}

Json without_target_names(const Json& owner, std::size_t count) {
    Json rest = owner;
    const Json* said = names_in(owner);
    if (said == nullptr || Json(target_names(owner, count)) != *said) return rest;
    rest["extras"].erase("targetNames");
    if (rest["extras"].empty()) rest.erase("extras");
    return rest;
}

bool has_positions(const tinygltf::Primitive& primitive, const Json& json) {
    if (primitive.attributes.count("POSITION") > 0) return true;
    const Json* draco = find_draco(json);
    return draco != nullptr && (*draco)["attributes"].contains("POSITION");
}

Vertices read_vertices(const Document& document, const tinygltf::Primitive& primitive, const Json& json, bool skinned,
                       const std::string& place) {
    return PrimitiveReader(document, primitive, json, place).read(skinned);
}

Submesh read_submesh(const Document& document, const tinygltf::Primitive& primitive, const Json& json,
                     std::size_t vertex_count, const std::vector<std::uint32_t>& draco_indices,
                     const std::string& place) {
    Submesh submesh;
    if (primitive.material >= 0) submesh.material = static_cast<std::uint32_t>(primitive.material);
    if (find_draco(json) != nullptr) {
        submesh.indices = draco_indices;  // Draco stores strips as triangles too
        return submesh;
    }
    const int mode = primitive.mode;
    const bool is_list = mode == TINYGLTF_MODE_POINTS || mode == TINYGLTF_MODE_LINE || mode == TINYGLTF_MODE_TRIANGLES;
    std::vector<std::uint32_t> sequence = read_sequence(document, primitive.indices, vertex_count, is_list, place);
    const std::size_t n = sequence.size();
    if (!is_list) document.budget.take(n, 3 * sizeof(std::uint32_t), place);
    std::size_t unused = 0;  // vertices of incomplete primitives
    switch (mode) {
        case TINYGLTF_MODE_POINTS:
            submesh.topology = Topology::points;
            submesh.indices = std::move(sequence);
            break;
        case TINYGLTF_MODE_LINE:
            submesh.topology = Topology::lines;
            unused = n % 2;
            sequence.resize(n - unused);
            submesh.indices = std::move(sequence);
            break;
        case TINYGLTF_MODE_LINE_LOOP:
        case TINYGLTF_MODE_LINE_STRIP:
            submesh.topology = Topology::lines;
            if (n < 2) unused = n;
            for (std::size_t i = 0; i + 1 < n; ++i)
                submesh.indices.insert(submesh.indices.end(), {sequence[i], sequence[i + 1]});
            if (mode == TINYGLTF_MODE_LINE_LOOP && n >= 2) {
                submesh.indices.insert(submesh.indices.end(), {sequence[n - 1], sequence[0]});
            }
            break;
        case TINYGLTF_MODE_TRIANGLE_STRIP:
            if (n < 3) unused = n;
            for (std::size_t i = 0; i + 2 < n; ++i) {  // flip every other triangle, so that all face the same side
                submesh.indices.insert(submesh.indices.end(),
                                       {sequence[i], sequence[i + 1 + i % 2], sequence[i + 2 - i % 2]});
            }
            break;
        case TINYGLTF_MODE_TRIANGLE_FAN:
            if (n < 3) unused = n;
            for (std::size_t i = 1; i + 1 < n; ++i) {
                submesh.indices.insert(submesh.indices.end(), {sequence[i], sequence[i + 1], sequence[0]});
            }
            break;
        default:
            unused = n % 3;
            sequence.resize(n - unused);
            submesh.indices = std::move(sequence);
            break;
    }
    if (unused > 0) document.report.warn("vertices at the end that make no whole primitive left out", place, unused);
    return submesh;
}

}  // namespace bendy::converter::gltf
