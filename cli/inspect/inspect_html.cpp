#include "inspect/inspect_html.h"

#include "inspect/describe_chunk.h"
#include "inspect/describe_rig.h"
#include "inspect/inspect_page.h"
#include "inspect/page_curves.h"
#include "inspect/page_materials.h"
#include "inspect/page_skeleton.h"
#include "terminal/problem.h"
#include "terminal/text.h"

#include <bendy/format/diagnostics.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

namespace bendy::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kMostChunks = 100'000;
constexpr std::size_t kMostWarnings = 1'000;

/// The innermost chunk at an offset, or null.
Json chunk_at(const ChunkTree* tree, std::uint64_t offset) {
    if (tree == nullptr) return nullptr;
    const auto chunks = tree->chunks();
    const auto after = std::upper_bound(chunks.begin(), chunks.end(), offset,
                                        [](std::uint64_t at, const Chunk& chunk) { return at < chunk.offset; });
    if (after == chunks.begin()) return nullptr;
    const auto number = static_cast<std::uint32_t>(after - chunks.begin() - 1);
    return number < kMostChunks ? Json(number) : Json(nullptr);
}

Json faults_json(const InspectedFile& file) {
    Json list = Json::array();
    for (const Error& fault : file.faults.list()) {
        list.push_back({{"code", code_name(fault.code)},
                        {"text", describe(fault)},
                        {"path", chunk_path(file.bytes, fault.offset)},
                        {"offset", fault.offset},
                        {"chunk", chunk_at(file.tree, fault.offset)}});
    }
    return {{"total", file.faults.count()}, {"list", std::move(list)}};
}

/// What is no fault and yet worth knowing, each with its chunk.
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

void warn_of_rig(const ObjectView& object, Warnings& warnings) {
    const auto warn_of_flags = [&](std::uint32_t chunk, std::uint8_t flags, const std::string& what) {
        if ((flags & kApproximated) != 0)
            warnings.add(chunk, what + " is approximated: the source says more, or otherwise");
        if ((flags & kProposed) != 0) warnings.add(chunk, what + " is proposed by --auto-rig; nobody has authored it");
    };
    for (const ConstraintView& constraint : object.skeleton.constraints) {
        warn_of_flags(constraint.chunk, constraint.record.flags, "the constraint");
        if ((constraint.record.flags & kRestOutside) != 0)
            warnings.add(constraint.chunk, "the rest pose is outside the constraint, and the author knows");
    }
    for (const ChainView& chain : object.chains) warn_of_flags(chain.chunk, chain.record.flags, "the IK chain");
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

/// The chunks as columns, in file order; ids and encodings by number.
Json chunks_json(const ChunkTree& tree, const RigIndex& rigs) {
    const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(tree.chunks().size(), kMostChunks));
    std::map<std::uint32_t, std::size_t> known;
    Json ids = Json::array();
    Json meanings = Json::array();
    Json id = Json::array();
    Json parent = Json::array();
    Json offset = Json::array();
    Json size = Json::array();
    Json text = Json::array();
    Json encoded = Json::object();
    for (std::uint32_t number = 0; number < count; ++number) {
        const Chunk& chunk = tree[number];
        const auto [place, is_new] = known.try_emplace(chunk.id.value, ids.size());
        if (is_new) {
            ids.push_back(chunk.id.letters().data());
            meanings.push_back(chunk_meaning(chunk.id));
        }
        id.push_back(place->second);
        parent.push_back(number == 0 ? -1 : static_cast<std::int64_t>(chunk.parent));
        offset.push_back(chunk.offset);
        size.push_back(chunk.size);
        text.push_back(describe_chunk(tree, number, rigs));
        if (chunk.codec() != 0) encoded[std::to_string(number)] = encoding_text(tree, number);
    }
    return {{"total", tree.chunks().size()}, {"ids", std::move(ids)},       {"meanings", std::move(meanings)},
            {"id", std::move(id)},           {"parent", std::move(parent)}, {"offset", std::move(offset)},
            {"size", std::move(size)},       {"text", std::move(text)},     {"encoded", std::move(encoded)}};
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
    Json data{{"file", printable(file.name)},
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

/// JSON that can stand in a script element whatever its strings hold: ASCII, and without < > &.
std::string as_script_data(const Json& data) {
    const std::string json = data.dump(-1, ' ', true, Json::error_handler_t::replace);
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

}  // namespace bendy::cli
