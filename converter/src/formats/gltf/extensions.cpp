#include "extensions.h"

#include "parts.h"
#include "scene/failure.h"

#include <bendy/extensions/renumber_extensions.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace bendy::converter::gltf {
namespace {

enum class Use : std::uint8_t {
    decoded,   ///< the importer implements it
    material,  ///< becomes part of the material, or is kept there as JSON; material.cpp reports it
    ignored,   ///< affects neither shape nor motion; read, or kept as JSON, on nodes and the root, dropped elsewhere
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
    Known{"VRMC_materials_hdr_emissiveMultiplier", Use::material},
    Known{"VRMC_materials_mtoon", Use::material},
    Known{"AGI_articulations", Use::ignored},
    Known{"AGI_stk_metadata", Use::ignored},
    Known{kIkChains, Use::ignored},
    Known{kJointLimits, Use::ignored},
    Known{kJointRole, Use::ignored},
    Known{kStandingPose, Use::ignored},
    Known{"KHR_lights_punctual", Use::ignored},
    Known{"KHR_materials_variants", Use::ignored},
    Known{"KHR_xmp_json_ld", Use::ignored},
    Known{"VRM", Use::ignored},
    Known{"VRMC_node_constraint", Use::ignored},
    Known{"VRMC_springBone", Use::ignored},
    Known{"VRMC_springBone_extended_collider", Use::ignored},
    Known{"VRMC_vrm", Use::ignored},
    Known{kVrmAnimation, Use::ignored},
};

const Known* find_known(std::string_view name) {
    const auto known = std::find_if(kKnown.begin(), kKnown.end(), [&](const Known& k) { return k.name == name; });
    return known == kKnown.end() ? nullptr : &*known;
}

struct Occurrence {
    std::string first_place;
    std::uint64_t count = 0;
};

/// Finds the `extensions` objects of a file, both those that are lost and those that are kept as JSON, which other code
/// reports. Kept are those of materials, the root, nodes and cameras, and anything nested in these; extras are not
/// searched.
class Finder {
public:
    // NOLINTNEXTLINE(misc-no-recursion): the nesting of parsed JSON is bounded
    void search(const Json& node, const std::string& place) {
        if (node.is_array()) {
            // Places are built only for structured elements: arrays of numbers are long.
            for (std::size_t i = 0; i < node.size(); ++i) {
                if (node[i].is_structured()) search(node[i], at(place, i));
            }
        } else if (node.is_object()) {
            for (auto member = node.begin(); member != node.end(); ++member) {
                if (member.key() == "extensions") {
                    count(member.value(), place);
                } else if (place.empty() && (member.key() == "materials" || member.key() == "cameras")) {
                    note_kept(member.value());
                } else if (member.value().is_structured() && member.key() != "extras") {
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
        if (place.empty() || is_node(place)) return note_kept_extensions(extensions);
        for (auto extension = extensions.begin(); extension != extensions.end(); ++extension) {
            Occurrence& occurrence = found[extension.key()];
            if (occurrence.count++ == 0) {
                occurrence.first_place = place + ".extensions." + key(extension.key());
            }
        }
    }

    // NOLINTNEXTLINE(misc-no-recursion): the nesting of parsed JSON is bounded
    void note_kept(const Json& node) {
        if (node.is_array()) {
            for (const Json& element : node) note_kept(element);
        } else if (node.is_object()) {
            for (auto member = node.begin(); member != node.end(); ++member) {
                if (member.key() == "extensions") note_kept_extensions(member.value());
                if (member.key() != "extensions" && member.key() != "extras") note_kept(member.value());
            }
        }
    }

    // NOLINTNEXTLINE(misc-no-recursion): the nesting of parsed JSON is bounded
    void note_kept_extensions(const Json& extensions) {
        if (!extensions.is_object()) return;
        for (auto extension = extensions.begin(); extension != extensions.end(); ++extension) {
            kept.insert(extension.key());
            note_kept(extension.value());
        }
    }

    /// Whether the place is "nodes[12]", an element of the root's array.
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

bool is_drawn_material_extension(std::string_view name, const Json& extension) {
    if (name == "KHR_materials_specular")
        return find(extension, "specularTexture") == nullptr && find(extension, "specularColorTexture") == nullptr;
    return name == "KHR_materials_emissive_strength" || name == "KHR_materials_ior";
}

void report_extensions(const Json& root, Report& report) {
    Finder finder;
    finder.search(root, {});
    const Json& used = array_of(root, "extensionsUsed");
    for (std::size_t i = 0; i < used.size(); ++i) {
        // Listed but not used: still something that the author relied on. Materials are reported elsewhere.
        const auto& name = used[i].text();
        if (finder.kept.count(name) != 0) continue;
        const auto& occurrence = finder.found.emplace(name, Occurrence{at("extensionsUsed", i), 0}).first->second;
        if (occurrence.count == 0 && name.rfind("KHR_materials_", 0) == 0) finder.found.erase(name);
    }
    for (const auto& [name, occurrence] : finder.found) {
        const Known* known = find_known(name);
        if (known != nullptr && known->use != Use::ignored) continue;
        report.warn((occurrence.count == 0 ? "extension not read: " : "extension left out: ") + quote(name),
                    occurrence.first_place, std::max<std::uint64_t>(1, occurrence.count));
    }
}

namespace {

constexpr std::string_view kVariants = "KHR_materials_variants";

static_assert(extensions::kMostLevels >= kMostJsonLevels, "what has been read can be renumbered");

/// The warning for an extension that is kept; empty for one that is fully interpreted.
std::string kept_message(const std::string& name) {
    if (name == "AGI_articulations") return {};
    if (name == kInstancing) {
        return "instances are kept as numbers, the mesh is drawn once; the option to make instances draws all: " +
               quote(name);
    }
    if (name == "VRMC_vrm") return "extension kept as JSON, only its humanoid is interpreted: " + quote(name);
    if (name == kVrmAnimation)
        return "extension kept as JSON, only its humanoid and expressions are interpreted: " + quote(name);
    return (extensions::is_known(name) ? "extension kept as JSON, not interpreted: "
                                       : "extension kept as JSON, not interpreted, numbers in it are the source's: ") +
           quote(name);
}

/// Replaces glTF's numbers with the Scene's.
class SceneNumbers {
public:
    SceneNumbers(const Document& document, const Skeleton& skeleton, const MeshesOfNode& meshes, Scene& scene)
        : skeleton_(skeleton), meshes_(meshes), scene_(scene) {
        for (const std::uint32_t node : skeleton.node_of_joint) {
            const int mesh = document.model.nodes[node].mesh;
            if (mesh >= 0 && !meshes[node].empty())
                mesh_of_source_.try_emplace(static_cast<std::uint32_t>(mesh), meshes[node].front());
        }
    }

    std::optional<std::uint32_t> operator()(extensions::Thing thing, std::uint32_t number, std::uint32_t owner) {
        switch (thing) {
            case extensions::Thing::joint:
                return number < skeleton_.joint_of_node.size() ? there(skeleton_.joint_of_node[number]) : std::nullopt;
            case extensions::Thing::mesh:
                return mesh_of(number);
            case extensions::Thing::target_of_joint:
                if (owner >= meshes_.size() || meshes_[owner].empty()) return std::nullopt;
                return target_of(meshes_[owner].front(), number);
            case extensions::Thing::target_of_mesh: {
                const auto mesh = mesh_of(owner);
                return mesh ? target_of(*mesh, number) : std::nullopt;
            }
            case extensions::Thing::material:
            case extensions::Thing::rows_of_materials:
                return extensions::below(number, scene_.materials.size());
            case extensions::Thing::texture:
                return extensions::below(number, scene_.textures.size());
            case extensions::Thing::image:
                return texture_with(number);
            case extensions::Thing::element:
                break;
        }
        return std::nullopt;
    }

private:
    static std::optional<std::uint32_t> there(std::uint32_t number) {
        return number == kNone ? std::nullopt : std::optional(number);
    }

    [[nodiscard]] std::optional<std::uint32_t> mesh_of(std::uint32_t source) const {
        const auto mesh = mesh_of_source_.find(source);
        return mesh == mesh_of_source_.end() ? std::nullopt : std::optional(mesh->second);
    }

    [[nodiscard]] std::optional<std::uint32_t> target_of(std::uint32_t mesh, std::uint32_t target) const {
        return extensions::below(target, scene_.meshes[mesh].targets.size());
    }

    /// A texture whose first image is this one; created if there is none, since a file keeps images in textures.
    std::optional<std::uint32_t> texture_with(std::uint32_t image) {
        if (image >= scene_.images.size()) return std::nullopt;
        for (std::uint32_t number = 0; number < scene_.textures.size(); ++number) {
            const auto& images = scene_.textures[number].images;
            if (!images.empty() && images.front() == image) return number;
        }
        Texture& texture = scene_.textures.emplace_back();
        texture.name = scene_.images[image].name;
        texture.images.push_back(image);
        return static_cast<std::uint32_t>(scene_.textures.size() - 1);
    }

    const Skeleton& skeleton_;
    const MeshesOfNode& meshes_;
    Scene& scene_;
    std::map<std::uint32_t, std::uint32_t> mesh_of_source_;  ///< the first mesh made from a glTF mesh
};

class ExtensionKeeper {
public:
    ExtensionKeeper(const Document& document, const Skeleton& skeleton, const MeshesOfNode& meshes, Scene& scene)
        : document_(document), numbers_(document, skeleton, meshes, scene) {}

    /// The extensions of the root or of a node as JSON text, or empty.
    /// \param are_instances_made  the node's instances have become joints
    std::string keep(const Json& object, const std::string& place, bool are_instances_made) {
        const Json* extensions = find(object, "extensions");
        if (extensions == nullptr) return {};
        const std::string here = place.empty() ? "extensions" : place + ".extensions";
        if (!extensions->is_object()) {
            document_.report.warn("extensions are not an object, left out", here);
            return {};
        }
        Json kept = *extensions;
        if (are_instances_made) kept.erase(std::string(kInstancing));
        // import_rig_extensions has read these.
        for (const std::string_view own :
             place.empty() ? std::array{kIkChains, kStandingPose} : std::array{kJointLimits, kJointRole})
            kept.erase(std::string(own));
        std::vector<std::string> gone;
        for (auto extension = kept.begin(); extension != kept.end(); ++extension) {
            const std::string at_extension = here + '.' + key(extension.key());
            if (place.empty() && extension.key() == kVariants) {
                document_.report.warn("extension left out, primitives do not keep the mappings to its variants: " +
                                          quote(extension.key()),
                                      at_extension);
                gone.push_back(extension.key());
                continue;
            }
            if (extension.key() == kInstancing && !place.empty() && !keep_instances(*extension, at_extension)) {
                gone.push_back(extension.key());
                continue;
            }
            if (const std::string message = kept_message(extension.key()); !message.empty())
                document_.report.warn(message, at_extension);
        }
        kept.erase_members(gone);
        return kept.empty() ? std::string() : renumbered(kept, place);
    }

private:
    std::string renumbered(const Json& kept, const std::string& place) {
        const auto host = place.empty() ? extensions::Host::root : extensions::Host::node;
        const auto made = extensions::renumber_extensions(kept.dump(), host, std::ref(numbers_));
        if (!made) fail(place, "the extensions are nested too deep");
        const std::string before = place.empty() ? "extensions." : place + ".extensions.";
        for (const std::string& gone : made->gone) {
            document_.report.warn("an extension names what is not there: its entry is left out",
                                  std::string(before).append(gone));
        }
        return made->json;
    }

    /// False, after a warning, if the instances are faulty.
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
    SceneNumbers numbers_;
};

}  // namespace

void keep_extensions(const Document& document, const Skeleton& skeleton, const MeshesOfNode& meshes, Scene& scene) {
    ExtensionKeeper keeper(document, skeleton, meshes, scene);
    scene.extensions = keeper.keep(document.json, {}, false);
    for (std::size_t joint = 0; joint < scene.joints.size(); ++joint) {
        if (skeleton.instance_of_joint[joint] != kNone) continue;
        const std::uint32_t node = skeleton.node_of_joint[joint];
        scene.joints[joint].extensions =
            keeper.keep(document.json["nodes"][node], at("nodes", node), skeleton.has_instances[node]);
    }
}

}  // namespace bendy::converter::gltf
