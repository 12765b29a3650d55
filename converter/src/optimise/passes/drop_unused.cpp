#include "optimise/passes/drop_unused.h"

#include "optimise/passes/equal_vertices.h"
#include "optimise/passes/mesh_order.h"
#include "optimise/passes/mesh_streams.h"
#include "scene/failure.h"
#include "scene/json_text.h"
#include "scene/used_entries.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

/// The streams that the materials of a mesh read.
struct Readers {
    std::set<std::uint32_t> coords;  ///< set numbers
    bool all_coords = false;
    bool tangents = false;
    bool normals = false;

    void add(const Readers& other) {
        coords.insert(other.coords.begin(), other.coords.end());
        all_coords = all_coords || other.all_coords;
        tangents = tangents || other.tangents;
        normals = normals || other.normals;
    }
};

bool has(std::string_view name, std::string_view part) {
    return name.find(part) != std::string_view::npos;
}

/// Adds what the members of an extension's JSON object may read, by their names: a texture's use names its set, or
/// means set 0; normal maps and anisotropy need tangents.
void add_readers(const Json& root, Readers& readers) {
    std::vector<const Json*> open{&root};
    while (!open.empty()) {
        const Json& json = *open.back();
        open.pop_back();
        if (json.is_object() && json.contains("index") && !json.contains("texCoord")) readers.coords.insert(0);
        for (const auto& member : json.items()) {
            const std::string& name = member.key();
            const Json& value = member.value();
            if (json.is_object()) {
                const bool is_use = value.is_object() && value.contains("index");  // it says its set itself
                if (name == "texCoord") {
                    if (value.is_number_unsigned()) readers.coords.insert(value.get<std::uint32_t>());
                } else if ((has(name, "exture") || has(name, "Tex")) && !is_use && name != "KHR_texture_transform") {
                    readers.coords.insert(0);
                }
                readers.tangents = readers.tangents || has(name, "ormalTex") || has(name, "nisotropy");
            }
            if (value.is_structured()) open.push_back(&value);
        }
    }
}

void add_readers_of_text(const std::string& text, Readers& readers) {
    if (text.empty()) return;
    try {
        Report unheard;
        add_readers(parse_json_text<Json>(text, unheard), readers);
    } catch (const Failure&) {  // unknown: it may read anything
        readers.all_coords = readers.tangents = true;
    }
}

Readers readers_of(const Material& material) {
    Readers readers;
    for (const TextureUse* use : {&material.base_colour_texture, &material.metallic_roughness_texture,
                                  &material.normal_texture, &material.occlusion_texture, &material.emissive_texture}) {
        if (use->texture != kNone) readers.coords.insert(use->coords);
    }
    readers.normals = !material.unlit;
    readers.tangents = material.normal_texture.texture != kNone;
    add_readers_of_text(material.extensions, readers);
    return readers;
}

bool is_white(const Stream& stream) {
    return std::all_of(stream.values.begin(), stream.values.end(), [](float value) { return value == 1.0f; });
}

/// Drops streams of one mesh.
class Dropper {
public:
    Dropper(Mesh& mesh, std::string name, Report& report) : mesh_(mesh), name_(std::move(name)), report_(report) {}

    /// Removes the streams for which `is_unused` is true.
    template <class Unused>
    void drop_sets(std::vector<Stream>& streams, std::string_view attribute, const std::string& message,
                   const Unused& is_unused) {
        std::erase_if(streams, [&](const Stream& stream) {
            if (!is_unused(stream)) return false;
            tell(message, std::string(attribute) + std::to_string(stream.set));
            return true;
        });
    }

    template <class Vectors, class Shifts>
    void drop(Vectors& stream, Shifts MorphTarget::*shifts, std::string_view attribute, const std::string& message) {
        if (stream.empty()) return;
        stream = {};
        for (MorphTarget& target : mesh_.targets) target.*shifts = {};
        tell(message, std::string(attribute));
    }

    /// Removes the palette's entries that move no vertex.
    void drop_entries() {
        std::vector<bool> used;
        mark_used(mesh_, used);
        if (used.empty()) return;
        if (std::find(used.begin(), used.end(), true) == used.end()) used[0] = true;  // bones must refer to one
        Palette kept;
        std::vector<std::uint32_t> place(used.size(), 0);  // 0 also for bones of no weight
        for (std::size_t entry = 0; entry < used.size(); ++entry) {
            if (!used[entry]) continue;
            place[entry] = static_cast<std::uint32_t>(kept.joints.size());
            kept.joints.push_back(mesh_.palette.joints[entry]);
            kept.inverse_bind.push_back(mesh_.palette.inverse_bind[entry]);
        }
        if (kept.joints.size() == used.size()) return;
        for (auto& bone : mesh_.bones) bone = place[bone];
        report_.warn("joints of the skin that move no vertex of the mesh are left out of its palette", name_,
                     used.size() - kept.joints.size());
        mesh_.palette = std::move(kept);
    }

    /// Merges equal vertices if a stream was dropped.
    void merge() {
        if (!has_dropped_ || !mesh_.collapse.empty()) return;
        std::vector<VertexRows> rows;
        for_each_stream(std::as_const(mesh_),
                        [&](const auto& values, std::size_t entries) { add_rows(rows, values, entries); });
        const std::size_t vertices = mesh_.positions.size();
        const std::vector<std::uint32_t> first_of = first_equal_vertices(vertices, rows);
        std::vector<std::uint32_t> kept;
        for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
            if (first_of[vertex] == vertex) kept.push_back(vertex);
        }
        if (kept.size() == vertices) return;
        for (Submesh& submesh : mesh_.submeshes) {
            for (std::uint32_t& index : submesh.indices) index = first_of[index];
        }
        permute_vertices(mesh_, kept);
        report_.warn("vertices that differed in nothing else are merged", name_, vertices - kept.size());
    }

private:
    void tell(const std::string& message, const std::string& attribute) {
        has_dropped_ = true;
        report_.warn(message, name_ + ", " + attribute);
    }

    Mesh& mesh_;
    std::string name_;
    Report& report_;
    bool has_dropped_ = false;
};

}  // namespace

void drop_unused(Scene& scene, Report& report) {
    std::vector<Readers> materials;
    for (const Material& material : scene.materials) materials.push_back(readers_of(material));
    Readers root;  // an extension of the file may describe its materials, as VRM 0 does
    add_readers_of_text(scene.extensions, root);
    for (std::size_t number = 0; number < scene.meshes.size(); ++number) {
        Mesh& mesh = scene.meshes[number];
        if (mesh.submeshes.empty()) continue;
        Readers readers = root;
        for (const Submesh& submesh : mesh.submeshes) {
            if (submesh.material == kNone) {
                readers.normals = true;  // the default material reads nothing else
            } else {
                readers.add(materials[submesh.material]);
            }
        }
        Dropper dropper(mesh, "mesh " + (mesh.name.empty() ? '#' + std::to_string(number) : quote(mesh.name)), report);
        dropper.drop_sets(
            mesh.texture_coords, "TEXCOORD_", "texture coordinates that no material uses are left out",
            [&](const Stream& stream) { return !readers.all_coords && !readers.coords.contains(stream.set); });
        dropper.drop_sets(mesh.colours, "COLOR_", "colours that change nothing are left out",
                          [](const Stream& stream) { return stream.set != 0 || is_white(stream); });
        if (!readers.tangents) {
            dropper.drop(mesh.tangents, &MorphTarget::tangents, "TANGENT",
                         "tangents that no material uses are left out");
        }
        if (!readers.normals) {
            dropper.drop(mesh.normals, &MorphTarget::normals, "NORMAL", "normals that no material uses are left out");
        }
        dropper.drop_entries();
        dropper.merge();
    }
}

}  // namespace bendy::converter
