#include "accessor.h"
#include "extensions.h"
#include "further_members.h"
#include "parts.h"
#include "scene/failure.h"
#include "scene/source/normalise.h"

#include <bendy/format/names.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::converter::gltf {
namespace {

/// Bytes for a number in JSON text, including the cost of reading it.
constexpr std::uint64_t kBytesPerNumber = 64;

/// The accessor of each attribute; all must have the same element count.
std::vector<std::pair<std::string, std::size_t>> attributes_of(const Document& document, const Json& extension,
                                                               const std::string& place) {
    if (!extension.is_object()) fail(place, "it must be an object");
    const Json* attributes = find(extension, "attributes");
    if (attributes == nullptr || !attributes->is_object() || attributes->empty())
        fail(place + ".attributes", "an object with one attribute or more is expected");
    std::vector<std::pair<std::string, std::size_t>> list;
    for (auto member = attributes->begin(); member != attributes->end(); ++member) {
        const std::string here = place + ".attributes." + key(member.key());
        const auto& accessors = document.model.accessors;
        if (!member->is_number_unsigned() || member->get<std::uint64_t>() >= accessors.size())
            fail(here, "the number of an accessor is expected (there are " + std::to_string(accessors.size()) + ")");
        const auto index = member->get<std::size_t>();
        if (!list.empty() && accessors[index].count != accessors[list.front().second].count) {
            fail(here, at("accessors", index) + " has " + std::to_string(accessors[index].count) +
                           " elements, that of " + list.front().first + " has " +
                           std::to_string(accessors[list.front().second].count));
        }
        list.emplace_back(member.key(), index);
    }
    return list;
}

const Json* find_instancing(const Document& document, std::size_t node) {
    const Json* extensions = find(document.json["nodes"][node], "extensions");
    return extensions == nullptr || !extensions->is_object() ? nullptr
                                                             : find(*extensions, std::string(kInstancing).c_str());
}

class Reader {
public:
    Reader(const Document& document, std::size_t node)
        : document_(document), place_(at("nodes", node) + ".extensions." + std::string(kInstancing)) {}

    std::vector<Transform> read(const Json& extension) {
        for (const auto& [name, accessor] : attributes_of(document_, extension, place_)) {
            const std::string here = place_ + ".attributes." + key(name);
            if (instances_.empty()) {
                const auto count = static_cast<std::uint64_t>(document_.model.accessors[accessor].count);
                document_.budget.take(count, sizeof(Joint) + sizeof(Transform), here);
                instances_.resize(count);
            }
            if (name == "TRANSLATION") {
                const std::vector<float> values = read_vectors(accessor, 3, here);
                for (std::size_t i = 0; i < instances_.size(); ++i)
                    instances_[i].translation = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
            } else if (name == "SCALE") {
                const std::vector<float> values = read_vectors(accessor, 3, here);
                for (std::size_t i = 0; i < instances_.size(); ++i)
                    instances_[i].scale = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
            } else if (name == "ROTATION") {
                read_rotations(read_vectors(accessor, 4, here), here);
            } else {
                losses_.add("attributes of instances", quote(name), here);
            }
        }
        losses_.report(document_.report);
        return std::move(instances_);
    }

private:
    std::vector<float> read_vectors(std::size_t accessor, std::size_t components, const std::string& place) const {
        if (component_count(document_.model.accessors[accessor]) != components)
            fail(place, at("accessors", accessor) + " must hold VEC" + std::to_string(components));
        return read_floats(document_, accessor, place);
    }

    void read_rotations(const std::vector<float>& values, const std::string& place) {
        std::uint64_t far_off = 0;
        std::uint64_t zero = 0;
        for (std::size_t i = 0; i < instances_.size(); ++i) {
            const UnitQuaternion unit =
                make_unit({values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]});
            if (unit.length == 0.0) {
                ++zero;
                continue;
            }
            constexpr double kByteRounding = 2e-2;  // for normalised bytes, the coarsest type that the extension allows
            if (std::abs(unit.length - 1.0) > kByteRounding) ++far_off;
            instances_[i].rotation = unit.value;
        }
        if (far_off > 0)
            document_.report.warn("rotation of an instance is not a unit quaternion, normalised", place, far_off);
        if (zero > 0) document_.report.warn("rotation of an instance is (0, 0, 0, 0), taken as none", place, zero);
    }

    const Document& document_;
    std::string place_;
    std::vector<Transform> instances_;
    Losses losses_;
};

}  // namespace

std::vector<Transform> read_instances(const Document& document, std::size_t node) {
    const Json* extension = find_instancing(document, node);
    const Json& source = document.json["nodes"][node];
    if (extension == nullptr || !source.contains("mesh")) return {};
    if (source.contains("skin")) {
        document.report.warn("instances of a mesh with a skin are not made: the extension does not say where they are",
                             at("nodes", node));
        return {};
    }
    return Reader(document, node).read(*extension);
}

void inline_instances(const Document& document, Json& extension, const std::string& place) {
    for (const auto& [name, index] : attributes_of(document, extension, place)) {
        const std::string here = place + ".attributes." + key(name);
        const tinygltf::Accessor& accessor = document.model.accessors[index];
        document.budget.take(std::uint64_t{accessor.count} * component_count(accessor), kBytesPerNumber, here);
        Json numbers{{"type", document.json["accessors"][index]["type"]}};
        const bool is_whole =
            !accessor.normalized && (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                     accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                                     accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
        if (is_whole) {
            numbers["integers"] = true;
            numbers["values"] = read_unsigned(document, index, here);
        } else {
            numbers["values"] = json_numbers(read_floats(document, index, here));
        }
        extension["attributes"][name] = std::move(numbers);
    }
}

namespace {

using Nodes = std::vector<tinygltf::Node>;

/// Each node's parent or kNone; fails unless the nodes form trees.
std::vector<std::uint32_t> find_parents(const Nodes& nodes) {
    std::vector<std::uint32_t> parents(nodes.size(), kNone);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto& children = nodes[i].children;
        for (std::size_t c = 0; c < children.size(); ++c) {
            auto& parent = parents[static_cast<std::size_t>(children[c])];
            if (parent != kNone) {
                fail(at("nodes", i) + '.' + at("children", c), "node " + std::to_string(children[c]) +
                                                                   " has two parents, the other is node " +
                                                                   std::to_string(parent));
            }
            parent = static_cast<std::uint32_t>(i);
        }
    }
    // With one parent each, nodes that are unreachable from the roots lie on or below a cycle.
    std::vector<std::uint32_t> pending;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (parents[i] == kNone) pending.push_back(static_cast<std::uint32_t>(i));
    }
    std::vector<bool> reached(nodes.size());
    while (!pending.empty()) {
        const std::uint32_t node = pending.back();
        pending.pop_back();
        reached[node] = true;
        for (const int child : nodes[node].children) pending.push_back(static_cast<std::uint32_t>(child));
    }
    if (const auto lost = std::find(reached.begin(), reached.end(), false); lost != reached.end()) {
        fail(at("nodes", static_cast<std::size_t>(lost - reached.begin())), "the node is its own ancestor (a loop)");
    }
    return parents;
}

/// The scene selected by the option or by the file; nothing if the file has none.
std::optional<std::size_t> choose_scene(const Document& document, const std::optional<std::string>& option) {
    const auto& scenes = document.model.scenes;
    if (option) {
        std::vector<std::string_view> names;
        names.reserve(scenes.size());
        for (const auto& scene : scenes) names.emplace_back(scene.name);
        const auto found = find_by_key(names, *option, "scene");
        if (!found) fail("scenes", found.error().message);
        return *found;
    }
    if (scenes.empty()) return std::nullopt;
    return document.model.defaultScene >= 0 ? static_cast<std::size_t>(document.model.defaultScene) : 0;
}

void report_other_scenes(const Document& document, const std::optional<std::size_t>& chosen) {
    Losses losses;
    const Json& scenes = array_of(document.json, "scenes");
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        if (i != chosen) losses.add("scenes that were not chosen", call(scenes[i], "scenes", i), at("scenes", i));
    }
    losses.report(document.report);
}

class Builder {
public:
    Builder(const Document& document, bool with_instances, Scene& scene)
        : document_(document),
          with_instances_(with_instances),
          nodes_(document.model.nodes),
          parents_(find_parents(nodes_)),
          scene_(scene),
          included_(nodes_.size()),
          drawn_(nodes_.size()) {}

    Skeleton build(const std::vector<std::uint32_t>& roots) {
        for (const std::uint32_t root : roots) draw_tree(root);
        if (roots_outside_ > 0) {
            document_.report.warn("the scene lists a node that has a parent; it keeps its parents' transforms", {},
                                  roots_outside_);
        }
        include_skins();
        Skeleton skeleton;
        skeleton.joint_of_node.assign(nodes_.size(), kNone);
        skeleton.has_instances.resize(nodes_.size());
        // Trees in the scene's order, then those that only contain joints of skins.
        for (const std::uint32_t root : tops_) add_tree(root, skeleton);
        mark_skins(skeleton);
        Losses losses;
        for (std::size_t node = 0; node < nodes_.size(); ++node) {
            if (skeleton.joint_of_node[node] != kNone) continue;
            losses.add("nodes outside the chosen scene", call(document_.json["nodes"][node], "nodes", node),
                       at("nodes", node));
        }
        losses.report(document_.report);
        return skeleton;
    }

private:
    /// Marks a node of the scene and its descendants.
    void draw_tree(std::uint32_t root) {
        if (parents_[root] != kNone && !drawn_[root]) ++roots_outside_;
        include_with_ancestors(root);
        std::vector<std::uint32_t> pending{root};
        while (!pending.empty()) {
            const std::uint32_t node = pending.back();
            pending.pop_back();
            if (drawn_[node]) continue;
            drawn_[node] = included_[node] = true;
            for (const int child : nodes_[node].children) pending.push_back(static_cast<std::uint32_t>(child));
        }
    }

    void include_with_ancestors(std::uint32_t node) {
        while (!included_[node]) {
            included_[node] = true;
            if (parents_[node] == kNone) {
                tops_.push_back(node);
                return;
            }
            node = parents_[node];
        }
    }

    void include_skins() {
        std::vector<bool> done(document_.model.skins.size());
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            if (!drawn_[i] || nodes_[i].mesh < 0 || nodes_[i].skin < 0) continue;
            const auto skin = static_cast<std::size_t>(nodes_[i].skin);
            if (done[skin]) continue;
            done[skin] = true;
            for (const int joint : document_.model.skins[skin].joints) {
                include_with_ancestors(static_cast<std::uint32_t>(joint));
            }
        }
    }

    void add_tree(std::uint32_t root, Skeleton& skeleton) {
        std::vector<std::uint32_t> pending{root};
        while (!pending.empty()) {
            const std::uint32_t node = pending.back();
            pending.pop_back();
            skeleton.joint_of_node[node] = static_cast<std::uint32_t>(scene_.joints.size());
            skeleton.node_of_joint.push_back(node);
            skeleton.is_drawn.push_back(drawn_[node]);
            skeleton.instance_of_joint.push_back(kNone);
            scene_.joints.push_back(make_joint(node, skeleton));
            if (with_instances_ && drawn_[node]) add_instances(node, skeleton);
            const auto& children = nodes_[node].children;
            for (std::size_t c = children.size(); c-- > 0;) {  // so that the first child is on top
                const auto child = static_cast<std::uint32_t>(children[c]);
                if (included_[child]) pending.push_back(child);
            }
        }
    }

    void add_instances(std::uint32_t node, Skeleton& skeleton) {
        const std::vector<Transform> instances = read_instances(document_, node);
        const std::uint32_t parent = skeleton.joint_of_node[node];
        const std::string& name = nodes_[node].name;
        for (std::uint32_t i = 0; i < instances.size(); ++i) {
            skeleton.node_of_joint.push_back(node);
            skeleton.is_drawn.push_back(true);
            skeleton.instance_of_joint.push_back(i);
            Joint& joint = scene_.joints.emplace_back();
            joint.name = at(name.empty() ? "instance" : name, i);
            joint.parent = parent;
            joint.rest = instances[i];
        }
        skeleton.has_instances[node] = !instances.empty();
    }

    void mark_skins(const Skeleton& skeleton) {
        for (const tinygltf::Skin& skin : document_.model.skins) {
            for (const int node : skin.joints) {
                const std::uint32_t joint = skeleton.joint_of_node[static_cast<std::size_t>(node)];
                if (joint != kNone) scene_.joints[joint].in_skin = true;
            }
        }
    }

    [[nodiscard]] Joint make_joint(std::uint32_t index, const Skeleton& skeleton) const {
        const tinygltf::Node& node = nodes_[index];
        Joint joint;
        joint.name = node.name;
        if (parents_[index] != kNone) joint.parent = skeleton.joint_of_node[parents_[index]];
        joint.rest = node.matrix.empty() ? read_trs(node, index) : read_matrix(node, index);
        joint.extras = extras_text(document_.json["nodes"][index]);
        return joint;
    }

    [[nodiscard]] Transform read_trs(const tinygltf::Node& node, std::uint32_t index) const {
        Transform rest;
        for (int i = 0; i < 3; ++i) {
            const auto component = static_cast<std::size_t>(i);
            if (!node.translation.empty()) rest.translation[i] = static_cast<float>(node.translation[component]);
            if (!node.scale.empty()) rest.scale[i] = static_cast<float>(node.scale[component]);
        }
        if (node.rotation.empty()) return rest;
        const UnitQuaternion unit = make_unit({node.rotation[0], node.rotation[1], node.rotation[2], node.rotation[3]});
        rest.rotation = unit.value;
        if (unit.length == 0.0) {
            document_.report.warn("rotation of a node is (0, 0, 0, 0), taken as none",
                                  at("nodes", index) + ".rotation");
        } else if (std::abs(unit.length - 1.0) > kUnitTolerance) {
            document_.report.warn("rotation of a node is not a unit quaternion, normalised",
                                  at("nodes", index) + ".rotation");
        }
        return rest;
    }

    [[nodiscard]] static Transform read_matrix(const tinygltf::Node& node, std::uint32_t index) {
        std::array<double, 16> matrix{};
        std::copy(node.matrix.begin(), node.matrix.end(), matrix.begin());
        constexpr double kTolerance = 1e-5;
        if (std::abs(matrix[3]) > kTolerance || std::abs(matrix[7]) > kTolerance || std::abs(matrix[11]) > kTolerance ||
            std::abs(matrix[15] - 1.0) > kTolerance) {
            fail(at("nodes", index) + ".matrix", "its last row is not 0 0 0 1: not an affine transform");
        }
        return decompose(matrix);
    }

    const Document& document_;
    bool with_instances_;
    const Nodes& nodes_;
    std::vector<std::uint32_t> parents_;
    Scene& scene_;
    std::vector<bool> included_;       ///< by node: becomes a joint
    std::vector<bool> drawn_;          ///< by node: in the scene
    std::vector<std::uint32_t> tops_;  ///< roots of the trees with included nodes
    std::uint64_t roots_outside_ = 0;  ///< nodes that the scene lists as roots although they have a parent
};

}  // namespace

Skeleton import_skeleton(const Document& document, const GltfOptions& options, Scene& scene) {
    const auto chosen = choose_scene(document, options.scene);
    report_other_scenes(document, chosen);
    Builder builder(document, options.instances, scene);
    std::vector<std::uint32_t> roots;
    if (chosen) {
        for (const int node : document.model.scenes[*chosen].nodes) roots.push_back(static_cast<std::uint32_t>(node));
        scene.name = document.model.scenes[*chosen].name;
        const Json& json = document.json["scenes"][*chosen];
        scene.extras = extras_text(json);
        if (const Json more = further_members(json, Element::scene); !more.empty()) scene.more = more.dump();
    } else {
        std::vector<bool> is_child(document.model.nodes.size());
        for (const auto& node : document.model.nodes) {
            for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
        }
        for (std::size_t i = 0; i < is_child.size(); ++i) {
            if (!is_child[i]) roots.push_back(static_cast<std::uint32_t>(i));
        }
    }
    if (roots.empty()) {
        fail(chosen ? at("scenes", *chosen) : "nodes", "there is nothing to convert: the scene has no nodes");
    }
    return builder.build(roots);
}

}  // namespace bendy::converter::gltf
