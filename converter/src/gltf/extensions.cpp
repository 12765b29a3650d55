#include "extensions.h"

#include "failure.h"

#include <algorithm>
#include <array>
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

}  // namespace bendy::converter::gltf
