#include "extensions.h"

#include "failure.h"
#include "parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace bendy::converter::gltf {
namespace {

enum class Use : std::uint8_t {
    decoded,   ///< the importer does what it says
    material,  ///< becomes part of the material, or stays there as JSON; material.cpp reports
    ignored,   ///< changes neither shape nor motion; kept as JSON on nodes and the root, has no place elsewhere
};

struct Known {
    std::string_view name;
    Use use;
};

constexpr std::array kKnown = {
    Known{"EXT_meshopt_compression", Use::decoded},
    Known{"EXT_texture_avif", Use::decoded},
    Known{"EXT_texture_webp", Use::decoded},
    Known{"KHR_animation_pointer", Use::decoded},
    Known{"KHR_draco_mesh_compression", Use::decoded},
    Known{"KHR_mesh_quantization", Use::decoded},
    Known{"KHR_meshopt_compression", Use::decoded},
    Known{"KHR_texture_basisu", Use::decoded},
    Known{"KHR_texture_transform", Use::decoded},
    Known{"KHR_materials_unlit", Use::decoded},
    Known{"KHR_materials_anisotropy", Use::material},
    Known{"KHR_materials_clearcoat", Use::material},
    Known{"KHR_materials_diffuse_transmission", Use::material},
    Known{"KHR_materials_dispersion", Use::material},
    Known{"KHR_materials_emissive_strength", Use::material},
    Known{"KHR_materials_ior", Use::material},
    Known{"KHR_materials_iridescence", Use::material},
    Known{"KHR_materials_pbrSpecularGlossiness", Use::material},
    Known{"KHR_materials_sheen", Use::material},
    Known{"KHR_materials_specular", Use::material},
    Known{"KHR_materials_transmission", Use::material},
    Known{"KHR_materials_volume", Use::material},
    Known{"AGI_articulations", Use::ignored},
    Known{"AGI_stk_metadata", Use::ignored},
    Known{"KHR_lights_punctual", Use::ignored},
    Known{"KHR_materials_variants", Use::ignored},
    Known{"KHR_xmp_json_ld", Use::ignored},
    Known{"VRM", Use::ignored},
    Known{"VRMC_node_constraint", Use::ignored},
    Known{"VRMC_springBone", Use::ignored},
    Known{"VRMC_vrm", Use::ignored},
};

const Known* find_known(std::string_view name) {
    const auto known = std::find_if(kKnown.begin(), kKnown.end(), [&](const Known& k) { return k.name == name; });
    return known == kKnown.end() ? nullptr : &*known;
}

struct Occurrence {
    std::string first_place;
    std::uint64_t count = 0;
};

/// Finds the `extensions` objects of a file. Materials are left to material.cpp, the root and nodes to
/// keep_extensions.cpp, cameras are kept whole, extras are the author's own, and what stands inside an extension goes
/// with it.
class Finder {
public:
    // NOLINTNEXTLINE(misc-no-recursion): the nesting of parsed JSON is bounded
    void search(const Json& node, const std::string& place) {
        if (node.is_array()) {
            // A place is made only for elements that hold objects: arrays of numbers are long.
            for (std::size_t i = 0; i < node.size(); ++i) {
                if (node[i].is_structured()) search(node[i], at(place, i));
            }
        } else if (node.is_object()) {
            for (auto member = node.begin(); member != node.end(); ++member) {
                if (member.key() == "extensions") {
                    count(member.value(), place);
                } else if (member.value().is_structured() && member.key() != "extras" &&
                           !(place.empty() && (member.key() == "materials" || member.key() == "cameras"))) {
                    search(member.value(), place.empty() ? key(member.key()) : place + '.' + key(member.key()));
                }
            }
        }
    }

    std::map<std::string, Occurrence> found;
    std::set<std::string> kept;

private:
    void count(const Json& extensions, const std::string& place) {
        if (!extensions.is_object()) return;
        if (place.empty() || is_node(place)) {
            for (auto extension = extensions.begin(); extension != extensions.end(); ++extension)
                kept.insert(extension.key());
            return;
        }
        for (auto extension = extensions.begin(); extension != extensions.end(); ++extension) {
            Occurrence& occurrence = found[extension.key()];
            if (occurrence.count++ == 0) {
                occurrence.first_place = place + ".extensions." + key(extension.key());
            }
        }
    }

    /// "nodes[12]": an element of the root's array.
    static bool is_node(std::string_view place) {
        return place.substr(0, 6) == "nodes[" && place.find(']') == place.size() - 1;
    }
};

}  // namespace

bool is_known_extension(std::string_view name) {
    return find_known(name) != nullptr;
}

bool is_interpreted_material_extension(std::string_view name) {
    return name == "KHR_materials_unlit";
}

void report_extensions(const Json& root, Report& report) {
    Finder finder;
    finder.search(root, {});
    const Json& used = array_of(root, "extensionsUsed");
    for (std::size_t i = 0; i < used.size(); ++i) {
        // Listed without a trace: still something that the author counted on. Materials report for themselves.
        const auto& name = used[i].get_ref<const std::string&>();
        if (finder.kept.count(name) != 0) continue;
        const auto& occurrence = finder.found.emplace(name, Occurrence{at("extensionsUsed", i), 0}).first->second;
        if (occurrence.count == 0 && name.rfind("KHR_materials_", 0) == 0) finder.found.erase(name);
    }
    for (const auto& [name, occurrence] : finder.found) {
        const Known* known = find_known(name);
        if (known != nullptr && known->use != Use::ignored) continue;
        report.warn("extension not read: " + quote(name), occurrence.first_place,
                    std::max<std::uint64_t>(1, occurrence.count));
    }
}

namespace {

/// Where an extension holds a node's number. In a path `[]` means each element of an array, `{}` each member of an
/// object.
struct NodeReference {
    std::string_view extension;
    std::string_view path;
};
constexpr std::array kNodeReferences{
    NodeReference{"MSFT_lod", "ids[]"},
    NodeReference{"VRM", "firstPerson.firstPersonBone"},
    NodeReference{"VRM", "humanoid.humanBones[].node"},
    NodeReference{"VRM", "secondaryAnimation.boneGroups[].bones[]"},
    NodeReference{"VRM", "secondaryAnimation.boneGroups[].center"},
    NodeReference{"VRM", "secondaryAnimation.colliderGroups[].node"},
    NodeReference{"VRMC_node_constraint", "constraint.aim.source"},
    NodeReference{"VRMC_node_constraint", "constraint.roll.source"},
    NodeReference{"VRMC_node_constraint", "constraint.rotation.source"},
    NodeReference{"VRMC_springBone", "colliders[].node"},
    NodeReference{"VRMC_springBone", "springs[].center"},
    NodeReference{"VRMC_springBone", "springs[].joints[].node"},
    NodeReference{"VRMC_vrm", "expressions.custom{}.morphTargetBinds[].node"},
    NodeReference{"VRMC_vrm", "expressions.preset{}.morphTargetBinds[].node"},
    NodeReference{"VRMC_vrm", "firstPerson.meshAnnotations[].node"},
    NodeReference{"VRMC_vrm", "humanoid.humanBones{}.node"},
};

/// What to say of an extension that is kept; empty for one that is interpreted in full.
std::string kept_message(const std::string& name) {
    if (name == "AGI_articulations") return {};
    if (name == kInstancing) {
        return "instances are kept as numbers, the mesh is drawn once; the option to make instances draws all: " +
               quote(name);
    }
    if (name == "VRMC_vrm") return "extension kept as JSON, only its humanoid is interpreted: " + quote(name);
    if (name == "VRM") {
        return "extension kept as JSON, only its humanoid is interpreted, mesh numbers in it are the source's: " +
               quote(name);
    }
    const bool is_renumbered = std::any_of(kNodeReferences.begin(), kNodeReferences.end(),
                                           [&](const NodeReference& known) { return known.extension == name; });
    return (is_renumbered ? "extension kept as JSON, not interpreted: "
                          : "extension kept as JSON, not interpreted, numbers in it are the source's: ") +
           quote(name);
}

/// Puts joint numbers in place of node numbers.
class Renumberer {
public:
    Renumberer(const Skeleton& skeleton, Report& report) : skeleton_(skeleton), report_(report) {}

    void renumber(const std::string& name, Json& extension, const std::string& place) {
        for (const NodeReference& known : kNodeReferences) {
            if (known.extension != name) continue;
            place_ = place;
            walk(extension, known.path);
        }
    }

private:
    // NOLINTNEXTLINE(misc-no-recursion): as deep as the path is long
    void walk(Json& value, std::string_view path) {
        if (path.empty()) return replace(value);
        const std::size_t length = place_.size();
        if (path.substr(0, 2) == "[]") {
            if (!value.is_array()) return;
            for (std::size_t i = 0; i < value.size(); ++i) {
                place_ += at("", i);
                walk(value[i], path.substr(2));
                place_.resize(length);
            }
        } else if (path.substr(0, 2) == "{}") {
            if (!value.is_object()) return;
            for (auto member = value.begin(); member != value.end(); ++member) {
                place_ += '.' + key(member.key());
                walk(member.value(), path.substr(2));
                place_.resize(length);
            }
        } else {
            if (path.front() == '.') path.remove_prefix(1);
            const std::size_t end = std::min(path.find_first_of(".[{"), path.size());
            const std::string name(path.substr(0, end));
            if (!value.is_object() || !value.contains(name)) return;
            place_ += '.' + name;
            walk(value[name], path.substr(end));
            place_.resize(length);
        }
    }

    void replace(Json& value) {
        const auto& joints = skeleton_.joint_of_node;
        if (value.is_number()) {
            const double number = value.get<double>();
            if (number == -1.0) return;  // VRM 0.x: none
            if (number >= 0.0 && number < static_cast<double>(joints.size()) && number == std::floor(number)) {
                const std::uint32_t joint = joints[static_cast<std::size_t>(number)];
                if (joint != kNone) {
                    value = joint;
                    return;
                }
                report_.warn("node of an extension is outside the chosen scene, null in its place", place_);
                value = nullptr;
                return;
            }
        }
        report_.warn("node of an extension does not exist, null in its place", place_);
        value = nullptr;
    }

    const Skeleton& skeleton_;
    Report& report_;
    std::string place_;
};

class ExtensionKeeper {
public:
    ExtensionKeeper(const Document& document, const Skeleton& skeleton)
        : document_(document), renumberer_(skeleton, document.report) {}

    /// The extensions of the root or of a node as JSON text, or empty.
    /// \param are_instances_made  the node's instances are joints already
    std::string keep(const Json& object, const std::string& place, bool are_instances_made) {
        const Json* extensions = find(object, "extensions");
        if (extensions == nullptr) return {};
        const std::string here = place.empty() ? "extensions" : place + ".extensions";
        if (!extensions->is_object()) {
            document_.report.warn("extensions are no object, left out", here);
            return {};
        }
        Json kept = *extensions;
        if (are_instances_made) kept.erase(std::string(kInstancing));
        for (auto extension = kept.begin(); extension != kept.end();) {
            const std::string at_extension = here + '.' + key(extension.key());
            if (extension.key() == kInstancing && !place.empty() && !keep_instances(*extension, at_extension)) {
                extension = kept.erase(extension);
                continue;
            }
            if (const std::string message = kept_message(extension.key()); !message.empty())
                document_.report.warn(message, at_extension);
            renumberer_.renumber(extension.key(), extension.value(), at_extension);
            ++extension;
        }
        return kept.empty() ? std::string() : kept.dump();
    }

private:
    /// False, which is said, if the instances are faulty.
    bool keep_instances(Json& extension, const std::string& place) {
        try {
            inline_instances(document_, extension, place);
            return true;
        } catch (const Failure& failure) {
            document_.report.warn("instances left out, they cannot be read (" + failure.error.message + ')',
                                  failure.error.place);
            return false;
        }
    }

    const Document& document_;
    Renumberer renumberer_;
};

}  // namespace

void keep_extensions(const Document& document, const Skeleton& skeleton, Scene& scene) {
    ExtensionKeeper keeper(document, skeleton);
    scene.extensions = keeper.keep(document.json, {}, false);
    for (std::size_t joint = 0; joint < scene.joints.size(); ++joint) {
        if (skeleton.instance_of_joint[joint] != kNone) continue;
        const std::uint32_t node = skeleton.node_of_joint[joint];
        scene.joints[joint].extensions =
            keeper.keep(document.json["nodes"][node], at("nodes", node), skeleton.has_instances[node]);
    }
}

}  // namespace bendy::converter::gltf
