#include "reports/inspect_html.h"

#include "reports/describe_chunk.h"
#include "reports/describe_rig.h"
#include "reports/json.h"
#include "reports/messages.h"
#include "reports/page_curves.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/material.h>
#include <bendy/runtime/transform.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::tools {
namespace {

using Json = OrderedJson;

constexpr std::uint32_t kMostChunks = 100'000;
constexpr std::size_t kMostWarnings = 1'000;

/// Returns the innermost chunk at an offset, or null.
Json chunk_or_null(const ChunkTree* tree, std::uint64_t offset) {
    const std::uint32_t number = tree == nullptr ? kNone : chunk_at(*tree, offset);
    return number < kMostChunks ? Json(number) : Json(nullptr);
}

Json faults_json(const InspectedFile& file) {
    Json list = Json::array();
    for (const Error& fault : file.faults.list()) {
        list.push_back({{"code", code_name(fault.code)},
                        {"text", describe(fault)},
                        {"path", chunk_path(file.bytes, fault.offset)},
                        {"offset", fault.offset},
                        {"chunk", chunk_or_null(file.tree, fault.offset)}});
    }
    return {{"total", file.faults.count()}, {"list", std::move(list)}};
}

/// Collects warnings about things that are not faults but worth knowing, each with its chunk.
class Warnings {
public:
    void add(std::uint32_t chunk, const std::string& text) {
        ++total_;
        if (list_.size() < kMostWarnings)
            list_.push_back({{"text", text}, {"chunk", chunk < kMostChunks ? Json(chunk) : Json(nullptr)}});
    }
    [[nodiscard]] Json json() const { return {{"total", total_}, {"list", list_}}; }

private:
    Json list_ = Json::array();
    std::size_t total_ = 0;
};

/// Adds one warning for all constraints of joints, or chains, with a flag.
template <class View, class NameOf>
void warn_of_flag(const std::vector<View>& views, std::uint8_t flag, const std::string& what, const NameOf& name_of,
                  Warnings& warnings) {
    std::uint32_t first = kNone;
    std::vector<std::string> names;
    for (const View& view : views) {
        if ((view.record.flags & flag) == 0) continue;
        if (names.empty()) first = view.chunk;
        const std::string name = name_of(view);
        if (names.empty() || names.back() != name) names.push_back(name);  // a joint may have several constraints
    }
    if (!names.empty()) warnings.add(first, what + ": " + some_of(names));
}

void warn_of_rig(const ObjectView& object, Warnings& warnings) {
    constexpr std::string_view kApproximately = " approximate the source, which Bendy cannot represent exactly";
    constexpr std::string_view kGuessed = " proposed by --auto-rig, not by an author";
    const auto warn_of_constraints = [&](std::uint8_t flag, const std::string& what) {
        const auto joint_of = [&](const ConstraintView& constraint) {
            return joint_name(object.skeleton, constraint.joint);
        };
        warn_of_flag(object.skeleton.constraints, flag, what, joint_of, warnings);
    };
    const auto warn_of_chains = [&](std::uint8_t flag, const std::string& what) {
        warn_of_flag(
            object.chains, flag, what, [](const ChainView& chain) { return brief(chain.name); }, warnings);
    };
    warn_of_constraints(kApproximated, "joint constraints" + std::string(kApproximately));
    warn_of_constraints(kProposed, "joint constraints" + std::string(kGuessed));
    warn_of_constraints(kRestOutside, "the rest pose is outside these joints' constraints, intentionally");
    warn_of_chains(kApproximated, "IK chains" + std::string(kApproximately));
    warn_of_chains(kProposed, "IK chains" + std::string(kGuessed));
}

Json warnings_json(const InspectedFile& file) {
    Warnings warnings;
    const ChunkTree& tree = *file.tree;
    for (std::uint32_t number = 0; number < tree.chunks().size(); ++number) {
        if (chunk_meaning(tree[number].id) == "unknown")
            warnings.add(number, "chunk of an unknown kind: skipped by readers, kept by tools");
    }
    for (const ObjectView& object : file.document.objects) warn_of_rig(object, warnings);
    for (const TextureView& texture : file.document.textures) {
        for (const ImageView& image : texture.images) {
            if (image.bytes.empty() && !image.uri.empty())
                warnings.add(texture.chunk, "the image is not in the file, which names " + brief(image.uri));
        }
    }
    return warnings.json();
}

/// Returns an empty table with these columns.
Json empty_columns(std::size_t total, std::initializer_list<const char*> names) {
    Json table{{"total", total}};
    for (const char* name : names) table[name] = Json::array();
    return table;
}

/// Returns the chunks as columns, in file order; ids and encodings by number.
Json chunks_json(const ChunkTree& tree, const RigIndex& rigs) {
    const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(tree.chunks().size(), kMostChunks));
    std::map<std::uint32_t, std::size_t> known;
    Json table = empty_columns(tree.chunks().size(), {"ids", "meanings", "id", "parent", "offset", "size", "text"});
    table["encoded"] = Json::object();
    for (std::uint32_t number = 0; number < count; ++number) {
        const Chunk& chunk = tree[number];
        const auto [place, is_new] = known.try_emplace(chunk.id.value, table["ids"].size());
        if (is_new) {
            table["ids"].push_back(chunk.id.letters().data());
            table["meanings"].push_back(chunk_meaning(chunk.id));
        }
        table["id"].push_back(place->second);
        table["parent"].push_back(number == 0 ? -1 : static_cast<std::int64_t>(chunk.parent));
        table["offset"].push_back(chunk.offset);
        table["size"].push_back(chunk.size);
        table["text"].push_back(describe_chunk(tree, number, rigs));
        if (chunk.codec() != 0) table["encoded"][std::to_string(number)] = encoding_text(tree, number);
    }
    return table;
}

Json facts_json(const Document& document) {
    std::uint64_t joints = 0;
    std::uint64_t meshes = 0;
    std::uint64_t vertices = 0;
    std::uint64_t chains = 0;
    std::uint64_t constraints = 0;
    std::uint64_t clips = 0;
    for (const ObjectView& object : document.objects) {
        joints += object.skeleton.joints.size();
        constraints += object.skeleton.constraints.size();
        chains += object.chains.size();
        clips += object.clips.size();
        meshes += object.meshes.size();
        for (const MeshView& mesh : object.meshes) vertices += mesh.vertices;
    }
    return {{"objects", document.objects.size()},
            {"joints", joints},
            {"constraints", constraints},
            {"IK chains", chains},
            {"meshes", meshes},
            {"vertices", vertices},
            {"clips", clips},
            {"materials", document.materials.size()},
            {"textures", document.textures.size()}};
}

constexpr std::size_t kMostJoints = 20'000;
constexpr std::size_t kMostChains = 1'000;
constexpr std::size_t kMostLinks = 1'000;  // per chain

glm::dmat4 rest_matrix(const RestRecord& rest) {
    JointTransform transform;
    transform.rotation = glm::quat(rest.rotation[3], rest.rotation[0], rest.rotation[1], rest.rotation[2]);
    transform.translation = {rest.translation[0], rest.translation[1], rest.translation[2]};
    transform.scale = {rest.scale[0], rest.scale[1], rest.scale[2]};
    return to_matrix(transform, {rest.shear[0], rest.shear[1], rest.shear[2]});
}

/// Returns the constraints of the joints, one text each.
std::vector<std::string> constraint_texts(const SkeletonView& skeleton, std::size_t joints) {
    std::vector<std::string> texts(joints);
    for (const ConstraintView& constraint : skeleton.constraints) {
        if (constraint.joint >= joints) continue;
        std::string& text = texts[constraint.joint];
        text += (text.empty() ? "" : " | ") + constraint_text(constraint.record);
    }
    return texts;
}

/// Returns the joints from the effector up to the start; empty if the start is not an ancestor.
Json links_of(const SkeletonView& skeleton, const ChainRecord& chain) {
    Json links = Json::array();
    std::uint32_t joint = chain.effector;
    while (joint < skeleton.joints.size() && links.size() < kMostLinks) {
        links.push_back(joint);
        if (joint == chain.start) return links;
        joint = skeleton.joints[joint].parent;
    }
    return links.size() == kMostLinks ? links : Json::array();
}

/// Returns the joints of an object as columns: parents, names, rest values, positions in the rest pose, limits.
Json page_joints(const ObjectView& object) {
    const auto& joints = object.skeleton.joints;
    const std::size_t count = std::min(joints.size(), kMostJoints);
    const std::vector<std::string> constraints = constraint_texts(object.skeleton, count);
    std::vector<glm::dmat4> model_space(count);
    Json table = empty_columns(joints.size(), {"parent", "name", "chunk", "t", "r", "s", "place"});
    for (std::size_t number = 0; number < count; ++number) {
        const JointView& joint = joints[number];
        const bool is_root = joint.parent == kNone;
        const glm::dmat4 local = rest_matrix(joint.rest);
        model_space[number] = is_root ? local : model_space[joint.parent] * local;
        table["parent"].push_back(is_root ? -1 : static_cast<std::int64_t>(joint.parent));
        table["name"].push_back(brief(joint.name));
        table["chunk"].push_back(joint.chunk);
        table["t"].push_back(short_numbers(joint.rest.translation));
        table["r"].push_back(short_numbers(joint.rest.rotation));
        table["s"].push_back(short_numbers(joint.rest.scale));
        const glm::dvec4 place = model_space[number][3];
        table["place"].push_back(short_numbers(
            std::array{static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z)}));
    }
    table["constraints"] = constraints;
    return table;
}

/// Returns the IK chains of an object: names, descriptions, links.
Json page_chains(const ObjectView& object, const RigIndex& rigs) {
    Json list = Json::array();
    for (const ChainView& chain : object.chains) {
        if (list.size() == kMostChains) break;
        list.push_back({{"name", brief(chain.name)},
                        {"chunk", chain.chunk},
                        {"text", rigs.chain_text(chain.chunk)},
                        {"links", links_of(object.skeleton, chain.record)}});
    }
    return {{"total", object.chains.size()}, {"list", std::move(list)}};
}

constexpr std::size_t kMostListed = 1'000;  // textures; materials
/// Images are embedded in file order, up to this many bytes in total.
constexpr std::size_t kMostImageBytes = std::size_t{32} << 20u;
constexpr std::size_t kMostUses = 50;  // per texture

struct Use {
    std::string_view slot;
    const TextureUseRecord* record;
};

std::array<Use, 5> uses_of(const SurfaceRecord& surface) {
    return {{{"base colour", &surface.base_colour_texture},
             {"metallic-roughness", &surface.metallic_roughness_texture},
             {"normal", &surface.normal_texture},
             {"occlusion", &surface.occlusion_texture},
             {"emissive", &surface.emissive_texture}}};
}

std::string sampler_text(const SamplerRecord& sampler) {
    constexpr std::array<std::string_view, kMinFilters> kFilters{
        "unspecified",         "nearest",           "linear", "nearest, mip nearest", "linear, mip nearest",
        "nearest, mip linear", "linear, mip linear"};
    constexpr std::array<std::string_view, kWraps> kWrapNames{"repeats", "clamped", "mirrored"};
    std::string text = "magnified " + std::string(name_at(kFilters, sampler.mag_filter));
    text.append("; minified ").append(name_at(kFilters, sampler.min_filter));
    text.append("; S ").append(name_at(kWrapNames, sampler.wrap_s));
    text.append(", T ").append(name_at(kWrapNames, sampler.wrap_t));
    return text;
}

/// Returns the bytes as a data URI.
std::string data_uri(std::string_view media_type, Bytes bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text("data:");
    text.append(media_type).append(";base64,");
    text.reserve(text.size() + (bytes.size() + 2) / 3 * 4);
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        const std::size_t left = bytes.size() - at;
        std::uint32_t group = 0;
        for (std::size_t i = 0; i < 3; ++i)
            group = group << 8u | (i < left ? std::to_integer<std::uint32_t>(bytes[at + i]) : 0u);
        for (std::size_t i = 0; i < 4; ++i) text += i <= left ? kDigits[group >> (18 - 6 * i) & 63u] : '=';
    }
    return text;
}

Json image_json(const ImageView& image, std::size_t& budget) {
    if (image.same) return {{"same", image.same->texture}};
    if (image.bytes.empty() && !image.uri.empty()) return {{"uri", brief(image.uri)}};
    Json json{{"media", name_at(kShownNames<MediaType>, static_cast<std::size_t>(image.media))},
              {"bytes", image.bytes.size()}};
    if (image.media == MediaType::other || image.media == MediaType::ktx2) {
        json["why"] = "browsers do not show this kind";
    } else if (image.bytes.size() > budget) {
        json["why"] = "not embedded: the page holds up to 32 MiB of images";
    } else {
        budget -= image.bytes.size();
        json["src"] = data_uri(mime_type(image.media), image.bytes);
    }
    return json;
}

/// Returns the material and slot of each use of a texture.
std::vector<Json> uses_by_texture(const Document& document) {
    std::vector<Json> uses(document.textures.size(), Json::array());
    for (std::size_t number = 0; number < document.materials.size(); ++number) {
        for (const Use& use : uses_of(document.materials[number].surface)) {
            if (use.record->texture < uses.size() && uses[use.record->texture].size() < kMostUses)
                uses[use.record->texture].push_back({number, use.slot});
        }
    }
    return uses;
}

/// Returns the textures: images that a browser can show as data URIs, samplers, uses.
Json page_textures(const Document& document) {
    std::vector<Json> uses = uses_by_texture(document);
    std::size_t budget = kMostImageBytes;
    Json list = Json::array();
    for (std::size_t number = 0; number < document.textures.size() && number < kMostListed; ++number) {
        const TextureView& texture = document.textures[number];
        Json images = Json::array();
        for (const ImageView& image : texture.images) images.push_back(image_json(image, budget));
        list.push_back({{"name", brief(texture.name)},
                        {"chunk", texture.chunk},
                        {"sampler", sampler_text(texture.sampler)},
                        {"images", std::move(images)},
                        {"uses", std::move(uses[number])}});
    }
    return {{"total", document.textures.size()}, {"list", std::move(list)}};
}

/// Returns the materials: surface parameters, textures, extensions.
Json page_materials(const Document& document) {
    Json list = Json::array();
    for (const MaterialView& material : document.materials) {
        if (list.size() == kMostListed) break;
        const SurfaceRecord& surface = material.surface;
        Json textures = Json::array();
        for (const Use& use : uses_of(surface)) {
            if (use.record->texture == kNone) continue;
            textures.push_back({use.slot, use.record->texture, use.record->coords});
        }
        std::string alpha(name_at(kValueNames<AlphaMode>, surface.alpha_mode));
        if (alpha == "mask") alpha += ", cut-off " + brief(surface.alpha_cutoff);
        list.push_back({{"name", brief(material.name)},
                        {"chunk", material.chunk},
                        {"base", short_numbers(surface.base_colour)},
                        {"emissive", short_numbers(surface.emissive)},
                        {"metallic", short_number(surface.metallic)},
                        {"roughness", short_number(surface.roughness)},
                        {"normalScale", short_number(surface.normal_scale)},
                        {"occlusion", short_number(surface.occlusion_strength)},
                        {"alpha", alpha},
                        {"doubleSided", surface.double_sided != 0},
                        {"unlit", surface.unlit != 0},
                        {"textures", std::move(textures)},
                        {"extensions", brief(material.extensions)}});
    }
    return {{"total", document.materials.size()}, {"list", std::move(list)}};
}

Json pictures_json(const InspectedFile& file) {
    Json list = Json::array();
    for (const PagePicture& picture : file.pictures.list) {
        list.push_back({{"name", brief(picture.name)},
                        {"clip", picture.is_clip},
                        {"src", data_uri(picture.media_type, picture.bytes)}});
    }
    return {{"list", std::move(list)},
            {"leftOut", file.pictures.clips_left_out},
            {"whyNone", printable(file.pictures.why_none)}};
}

Json page_data(const InspectedFile& file) {
    Json data{{"file", escaped(file.name)},
              {"bytes", file.bytes.size()},
              {"tool", "bendy " BENDY_VERSION},
              {"faults", faults_json(file)}};
    if (file.tree == nullptr) return data;
    const ChunkTree& tree = *file.tree;
    const RigIndex rigs(tree);
    const std::uint32_t version = tree[0].is_container() ? tree.find(0, FourCC("VERS")) : kNone;
    data["version"] = version == kNone ? std::string() : describe_chunk(tree, version, rigs);
    data["warnings"] = warnings_json(file);
    data["pictures"] = pictures_json(file);
    data["facts"] = facts_json(file.document);
    data["chunks"] = chunks_json(tree, rigs);
    CurveSampler curves(file.document.objects);
    Json objects = Json::array();
    for (const ObjectView& object : file.document.objects) {
        objects.push_back({{"name", brief(object.name)},
                           {"joints", page_joints(object)},
                           {"chains", page_chains(object, rigs)},
                           {"clips", curves.clips(object)}});
    }
    data["objects"] = std::move(objects);
    data["times"] = curves.times();
    data["curves"] = {
        {"points", curves.points_per_track()}, {"thinned", curves.thinned()}, {"leftOut", curves.left_out()}};
    data["textures"] = page_textures(file.document);
    data["materials"] = page_materials(file.document);
    return data;
}

/// Returns JSON that is safe in a script element whatever its strings hold: ASCII, without < > &.
std::string as_script_data(const Json& data) {
    const std::string json = data.dump(-1, true, Json::InvalidText::replaced);
    std::string text;
    text.reserve(json.size());
    for (const char c : json) {
        if (c == '<') {
            text += "\\u003c";
        } else if (c == '>') {
            text += "\\u003e";
        } else if (c == '&') {
            text += "\\u0026";
        } else {
            text += c;
        }
    }
    return text;
}

}  // namespace

std::string inspect_page(const InspectedFile& file) {
    std::string page(kPageBeforeData);
    page += as_script_data(page_data(file));
    page += kPageAfterData;
    return page;
}

}  // namespace bendy::tools
