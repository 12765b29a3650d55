#include "formats/gltf/source_generator.h"
#include "formats/gltf_out/buffer.h"
#include "formats/gltf_out/curves.h"
#include "formats/gltf_out/parts.h"
#include "optimise/passes/mesh_order.h"
#include "scene/curve_property.h"
#include "scene/failure.h"
#include "scene/source/normalise.h"
#include "scene/source/source_file.h"

#include <bendy/converter/export.h>
#include <bendy/converter/import.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

using gltf_out::Buffer;

/// The source's `asset` if it is one of glTF 2, as one of 2.0, otherwise ours; in both, the generator names this
/// program.
Json write_asset(const Scene& scene, Report& report) {
    constexpr std::string_view kGenerator = "bendy " BENDY_VERSION;
    Json ours{{"version", "2.0"}, {"generator", kGenerator}};
    if (scene.asset.empty()) return ours;
    try {
        auto asset = parse_json_text<Json>(scene.asset, report);
        const auto version = asset.is_object() ? asset.find("version") : asset.end();
        if (asset.is_object() && version != asset.end() && version->is_string() && version->text().starts_with("2.")) {
            *version = "2.0";
            asset.erase("minVersion");  // no later than that
            gltf_out::leave_out_drafts(asset, gltf::Element::asset, "asset", report);
            gltf::name_generator(asset, kGenerator);
            return asset;
        }
    } catch (const Failure&) {
    }
    report.warn("the source's asset data left out: not a glTF 2.0 asset", "HEAD/EXTR");
    return ours;
}

/// The names of all extensions below, of any object. Extras are skipped.
// NOLINTNEXTLINE(misc-no-recursion): parsed JSON is at most 128 levels deep
void gather_extensions(const Json& json, std::set<std::string>& names) {
    if (!json.is_structured()) return;
    for (const auto& [member, value] : json.items()) {
        if (json.is_object() && member == "extras") continue;
        if (json.is_object() && member == "extensions" && value.is_object()) {
            for (const auto& extension : value.items()) names.insert(extension.key());
        }
        gather_extensions(value, names);
    }
}

/// The members of each joint's node that the Scene does not interpret.
std::vector<Json> read_node_members(const Scene& scene, Report& report) {
    std::vector<Json> members;
    members.reserve(scene.joints.size());
    for (std::size_t i = 0; i < scene.joints.size(); ++i)
        members.push_back(gltf_out::read_members(scene.joints[i].more, at("joints", i), report));
    return members;
}

/// By joint: a key of its camera's motion in the clips; equal for equal motions only.
std::vector<std::string> motions_of_cameras(const Scene& scene) {
    std::vector<std::string> motions(scene.joints.size());
    for (std::size_t clip = 0; clip < scene.clips.size(); ++clip) {
        for (const Curve& curve : scene.clips[clip].curves) {
            if (curve.kind == CurveTarget::joint && curve.path.starts_with(kCameraPath))
                gltf_out::append_motion(curve, clip, motions[curve.target]);
        }
    }
    return motions;
}

void add_node_members(const Scene& scene, const std::vector<Json>& members, Json& root, Json& nodes, Report& report) {
    const std::vector<std::string> motions = motions_of_cameras(scene);
    std::map<std::pair<std::string, std::string_view>, std::size_t> cameras;  // by their text and motion
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (const auto camera = members[i].find("camera"); camera != members[i].end() && camera->is_object()) {
            const auto [known, is_new] = cameras.try_emplace({camera->dump(), motions[i]}, cameras.size());
            if (is_new) root["cameras"].push_back(*camera);
            nodes[i]["camera"] = known->second;
        }
        gltf_out::add_members(nodes[i], members[i], gltf::Element::node, at("joints", i), report);
    }
}

/// Adds a list unless it is empty, which glTF does not allow.
void add_list(Json& root, const char* member, Json list) {
    if (!list.empty()) root[member] = std::move(list);
}

Json write_scene(const Scene& scene, Json roots, Report& report) {
    Json written = Json::object();
    add_list(written, "nodes", std::move(roots));
    if (!scene.name.empty()) written["name"] = scene.name;
    gltf_out::add_extras(written, scene.extras, "scene", report);
    gltf_out::add_members(written, gltf_out::read_members(scene.more, "HEAD/OBJE/MORE", report), gltf::Element::scene,
                          "scene", report);
    return written;
}

/// The document's numbers for things of the Scene.
class DocumentNumbers {
public:
    explicit DocumentNumbers(const Scene& scene) : scene_(scene), carried_(scene.joints.size(), kNone) {
        for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
            const std::uint32_t joint = scene.meshes[mesh].joint;
            if (joint != kNone && carried_[joint] == kNone) carried_[joint] = mesh;
        }
    }

    /// glTF meshes get numbers only when they are written.
    void set_meshes(const gltf_out::ExportedMeshes& meshes, const Json& nodes) {
        for (const std::uint32_t node : meshes.node_of_mesh)
            meshes_.push_back(node == kNone ? kNone : nodes[node]["mesh"].get<std::uint32_t>());
    }

    std::optional<std::uint32_t> operator()(extensions::Thing thing, std::uint32_t number, std::uint32_t owner) const {
        switch (thing) {
            case extensions::Thing::joint:
                return extensions::below(number, scene_.joints.size());
            case extensions::Thing::mesh:
                return number < meshes_.size() && meshes_[number] != kNone ? std::optional(meshes_[number])
                                                                           : std::nullopt;
            case extensions::Thing::target_of_joint:
                return owner < carried_.size() ? target_of(carried_[owner], number) : std::nullopt;
            case extensions::Thing::target_of_mesh:
                return target_of(owner, number);
            case extensions::Thing::material:
            case extensions::Thing::rows_of_materials:
                return extensions::below(number, scene_.materials.size());
            case extensions::Thing::texture:
                return extensions::below(number, scene_.textures.size());
            case extensions::Thing::image:
                if (number >= scene_.textures.size() || scene_.textures[number].images.empty()) return std::nullopt;
                return scene_.textures[number].images.front();
            case extensions::Thing::element:
                break;
        }
        return std::nullopt;
    }

private:
    [[nodiscard]] std::optional<std::uint32_t> target_of(std::uint32_t mesh, std::uint32_t target) const {
        return mesh < scene_.meshes.size() ? extensions::below(target, scene_.meshes[mesh].targets.size())
                                           : std::nullopt;
    }

    const Scene& scene_;
    std::vector<std::uint32_t> carried_;  ///< by joint: its first mesh
    std::vector<std::uint32_t> meshes_;   ///< by mesh: the glTF mesh
};

GltfAsset write(const Scene& scene, const std::filesystem::path& buffer_file, Report& report) {
    Json root{{"asset", write_asset(scene, report)}, {"scene", 0}};
    Buffer buffer;
    DocumentNumbers numbers(scene);
    Json nodes = gltf_out::export_nodes(scene, std::ref(numbers), report);
    Json roots = gltf_out::root_nodes(scene);
    const std::vector<Json> node_members = read_node_members(scene, report);
    gltf_out::ExportedMeshes meshes = gltf_out::export_meshes(scene, node_members, nodes, roots, buffer, report);
    numbers.set_meshes(meshes, nodes);
    gltf_out::export_instances(nodes, buffer, report);
    add_node_members(scene, node_members, root, nodes, report);
    gltf_out::ExportedAnimations animations = gltf_out::export_animations(scene, meshes.node_of_mesh, buffer, report);
    add_list(root, "animations", std::move(animations.animations));
    gltf_out::export_materials(scene, std::ref(numbers), root, buffer, report);
    add_list(root, "meshes", std::move(meshes.meshes));
    add_list(root, "skins", std::move(meshes.skins));
    add_list(root, "nodes", std::move(nodes));
    root["scenes"].push_back(write_scene(scene, std::move(roots), report));
    if (!scene.levels.empty()) report.warn("levels of detail left out: glTF has no place for them");
    gltf_out::add_extras(root, scene.source_extras, "HEAD/EXTR", report);
    gltf_out::add_extensions(root, scene.extensions, extensions::Host::root, std::ref(numbers), "HEAD/EXTN", report);
    gltf_out::export_rig(scene, root, report);
    gltf_out::add_members(root, gltf_out::read_members(scene.source_more, "HEAD/MORE", report), gltf::Element::root,
                          "HEAD/MORE", report);
    gltf_out::export_curves(scene, animations.animation_of_clip, meshes.node_of_mesh, root, buffer, report);
    std::set<std::string> used;
    gather_extensions(root, used);
    if (!used.empty()) root["extensionsUsed"] = used;
    add_list(root, "bufferViews", buffer.views());
    add_list(root, "accessors", buffer.accessors());
    if (!buffer.bytes().empty()) {
        Json entry{{"byteLength", buffer.bytes().size()}};
        if (!buffer_file.empty()) entry["uri"] = uri_of(buffer_file);
        root["buffers"].push_back(std::move(entry));
    }
    return {root.dump(), std::move(buffer).take()};
}

GltfAsset export_bytes(Bytes bytes, const std::filesystem::path& buffer_file, Report& report,
                       const ExportOptions& options, const std::filesystem::path& bendy_file) {
    Result<Scene, ImportError> scene = import_bendy(bytes, report);
    if (!scene) throw Failure{scene.error()};
    if (!bendy_file.empty() && !options.output.empty())
        move_links(*scene, bendy_file, options.output, ReadableFolders::of(bendy_file), report);
    if (!options.vertices.empty()) keep_level(*scene, options.vertices);
    for (std::size_t i = 0; i < scene->meshes.size(); ++i) merge_influences(scene->meshes[i], at("meshes", i), report);
    return write(*scene, buffer_file, report);
}

void append_u32(std::vector<std::byte>& bytes, std::uint64_t value) {
    for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::byte>(value >> shift));
}

void append_chunk(std::vector<std::byte>& bytes, std::uint32_t type, Bytes data, std::byte padding) {
    const std::size_t size = (data.size() + 3) / 4 * 4;
    append_u32(bytes, size);
    append_u32(bytes, type);
    bytes.insert(bytes.end(), data.begin(), data.end());
    bytes.resize(bytes.size() + size - data.size(), padding);
}

}  // namespace

Result<GltfAsset, ImportError> export_gltf(Bytes bytes, const std::filesystem::path& buffer_file, Report& report,
                                           const ExportOptions& options) {
    return without_throwing<GltfAsset>(
        [&]() -> Result<GltfAsset, ImportError> { return export_bytes(bytes, buffer_file, report, options, {}); });
}

Result<GltfAsset, ImportError> export_gltf(const std::filesystem::path& bendy_file,
                                           const std::filesystem::path& buffer_file, Report& report,
                                           const ExportOptions& options) {
    const Result<MappedFile> mapped = MappedFile::open(bendy_file);
    if (!mapped) return ImportError{{}, describe(mapped.error())};
    return without_throwing<GltfAsset>([&]() -> Result<GltfAsset, ImportError> {
        return export_bytes(mapped->bytes(), buffer_file, report, options, bendy_file);
    });
}

Result<std::vector<std::byte>, ImportError> make_glb(const GltfAsset& asset) {
    constexpr std::uint64_t kHeader = 12;
    constexpr std::uint64_t kChunkHeader = 8;
    const auto padded_size = [](std::uint64_t size) { return (size + 3) / 4 * 4; };
    std::uint64_t size = kHeader + kChunkHeader + padded_size(asset.json.size());
    if (!asset.buffer.empty()) size += kChunkHeader + padded_size(asset.buffer.size());
    if (size > std::numeric_limits<std::uint32_t>::max())
        return ImportError{{}, "a GLB file cannot be larger than 4 GiB: write a .gltf file"};
    std::vector<std::byte> bytes;
    bytes.reserve(size);
    append_u32(bytes, 0x46546c67);  // "glTF"
    append_u32(bytes, 2);
    append_u32(bytes, size);
    append_chunk(bytes, 0x4e4f534a, std::as_bytes(std::span(asset.json)), std::byte{' '});
    if (!asset.buffer.empty()) append_chunk(bytes, 0x004e4942, asset.buffer, std::byte{0});
    return bytes;
}

}  // namespace bendy::converter
