#include "reports/summary.h"

#include "reports/describe_chunk.h"
#include "reports/json.h"
#include "reports/messages.h"

#include <bendy/converter/report.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/runtime/lod.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/skin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <string_view>

namespace bendy::tools {
namespace {

using Json = OrderedJson;

constexpr std::size_t kIndentation = 17;  // of the text after a label

std::string name_of_joint(const Model& model, std::uint32_t joint) {
    return std::string(model.joints()[joint].name);
}

std::vector<Summary::MeshLine> list_meshes(const Model& model) {
    std::vector<Summary::MeshLine> meshes;
    for (const Mesh& view : model.meshes()) {
        Summary::MeshLine& mesh = meshes.emplace_back();
        mesh.name = view.name;
        mesh.vertices = view.vertices;
        mesh.influences = view.bones ? view.bones->components : 0;
        for (const MorphTargetView& target : view.targets) mesh.morph_targets.emplace_back(target.name);
    }
    for (const Submesh& submesh : model.submeshes()) {
        Summary::MeshLine& mesh = meshes[submesh.mesh];
        if (submesh.topology == Topology::triangles) mesh.triangles += submesh.count / 3;
        if (submesh.topology == Topology::lines) mesh.lines += submesh.count / 2;
        if (submesh.topology == Topology::points) mesh.points += submesh.count;
    }
    return meshes;
}

std::vector<Summary::TextureLine> list_textures(const Model& model) {
    std::vector<Summary::TextureLine> textures;
    for (const Texture& texture : model.textures()) {
        Summary::TextureLine& line = textures.emplace_back();
        line.name = texture.name;
        for (const ImageView& own : texture.images) {
            const ImageView& image = own.same ? model.textures()[own.same->texture].images[own.same->image] : own;
            const auto type = static_cast<std::size_t>(image.media);
            line.images.push_back({std::string(kShownNames<MediaType>.at(type < kMediaTypes ? type : 0)),
                                   own.bytes.size(), std::string(image.uri), own.same ? own.same->texture : kNone});
        }
    }
    return textures;
}

std::vector<Summary::Level> list_levels(const Model& model) {
    std::vector<Summary::Level> levels;
    if (model.collapse() == nullptr) return levels;
    Lod lod(model);
    for (const float share : {1.0f, 0.5f, 0.25f, 0.1f, 0.0f}) {
        lod.set_share(share);
        std::uint64_t vertices = 0;
        for (std::uint32_t mesh = 0; mesh < model.meshes().size(); ++mesh) vertices += lod.vertices(mesh);
        levels.push_back({share, lod.triangles(), vertices, lod.error()});
    }
    return levels;
}

Box box_around(std::span<const glm::vec3> points) {
    Box box;
    for (const glm::vec3& point : points) box = unite(box, {point, point});
    const bool is_finite = std::isfinite(box.minimum.x + box.minimum.y + box.minimum.z) &&
                           std::isfinite(box.maximum.x + box.maximum.y + box.maximum.z);
    return is_finite ? box : Box();
}

Box rest_bounds(const Model& model) {
    Pose pose(model);
    std::vector<glm::vec3> points(model.vertex_count());
    if (points.empty()) {
        for (const auto& matrix : pose.model_space()) points.emplace_back(matrix[3]);
    } else {
        (void)skin(pose, {.out = {.positions = points}});
    }
    return box_around(points);
}

/// Lines with a label, and parts separated by commas.
class Lines {
public:
    explicit Lines(std::size_t columns) : columns_(columns) {}

    void add(std::string_view label, const std::vector<std::string>& parts) {
        text_ += "  ";
        text_ += in_colour(Colour::bold, label, Stream::output);
        text_.append(kIndentation - 2 - label.size(), ' ');
        std::size_t at = kIndentation;
        for (std::size_t k = 0; k < parts.size(); ++k) {
            const std::size_t width = width_of(parts[k]) + (k + 1 < parts.size() ? 1 : 0);
            if (k != 0 && columns_ != 0 && at + 1 + width > columns_) {
                text_ += '\n' + std::string(kIndentation, ' ');
                at = kIndentation;
            } else if (k != 0) {
                text_ += ' ';
                ++at;
            }
            text_ += parts[k];
            if (k + 1 < parts.size()) text_ += ',';
            at += width;
        }
        text_ += '\n';
    }
    std::string take() { return std::move(text_); }

private:
    std::size_t columns_;
    std::string text_;
};

/// Returns the parts "3: Survey 3.42 s", "Walk 0.708 s", "Run 1.16 s"; only the first ones if there are many.
template <class List, class Describe>
std::vector<std::string> listed(const List& list, std::string first, Describe describe) {
    constexpr std::size_t kShown = 20;
    std::vector<std::string> parts;
    for (std::size_t k = 0; k < std::min(list.size(), kShown); ++k) {
        parts.push_back((k == 0 ? first + ": " : "") + describe(list[k], k));
    }
    if (parts.empty()) parts.push_back(std::move(first));
    if (list.size() > kShown) parts.push_back("... " + grouped(list.size() - kShown) + " more");
    return parts;
}

std::string label_of(const std::string& name, std::size_t number) {
    return name.empty() ? '#' + std::to_string(number) : brief(std::string_view(name));
}

void add_meshes(const Summary& summary, Lines& lines) {
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
    std::uint32_t influences = 0;
    for (const Summary::MeshLine& mesh : summary.meshes) {
        vertices += mesh.vertices;
        triangles += mesh.triangles;
        influences = std::max(influences, mesh.influences);
    }
    std::vector<std::string> parts{grouped(summary.meshes.size()) + " with " + counted(vertices, "vertex", "vertices"),
                                   counted(triangles, "triangle")};
    if (summary.meshes.empty()) parts = {"0"};
    if (influences != 0) parts.push_back("up to " + counted(influences, "influence") + " a vertex");
    lines.add("meshes", parts);
}

void add_levels(const Summary& summary, Lines& lines) {
    if (summary.levels.empty()) return;
    std::vector<std::string> parts;
    for (const Summary::Level& level : summary.levels) {
        constexpr float kPercent = 100.0f;
        constexpr float kMillimetres = 1000.0f;
        const std::string triangles = grouped(level.triangles);
        std::string part = level.share > 0.0f ? brief(kPercent * level.share) + " % " + triangles
                                              : "fewest " + counted(level.triangles, "triangle");
        if (level.error > 0.0f) part += " (" + brief(kMillimetres * level.error) + " mm off)";
        parts.push_back(std::move(part));
    }
    lines.add("levels", parts);
}

void add_rig(const Summary& summary, Lines& lines) {
    if (summary.constraints == 0 && summary.chains.empty()) return;
    const std::string chains = counted(summary.chains.size(), "chain");
    std::vector<std::string> parts = listed(
        summary.chains, chains, [](const Summary::ChainLine& chain, std::size_t k) { return label_of(chain.name, k); });
    if (summary.chains.empty()) parts.clear();
    parts.insert(parts.begin(), counted(summary.constraints, "constraint"));
    lines.add("rig", parts);
}

/// Returns each name once, in order: a target in several meshes is one thing to the user.
void add_morph_targets(const Summary& summary, Lines& lines) {
    std::uint64_t count = 0;
    std::set<std::string_view> known;
    std::vector<std::string> names;
    for (const Summary::MeshLine& mesh : summary.meshes) {
        count += mesh.morph_targets.size();
        for (const std::string& name : mesh.morph_targets) {
            if (!name.empty() && known.insert(name).second) names.push_back(name);
        }
    }
    if (count == 0) return;
    lines.add("morph targets",
              listed(names, grouped(count), [](const std::string& name, std::size_t k) { return label_of(name, k); }));
}

void add_surfaces(const Summary& summary, Lines& lines) {
    lines.add("materials", listed(summary.materials, grouped(summary.materials.size()),
                                  [](const Summary::Named& one, std::size_t k) { return label_of(one.name, k); }));
    lines.add("textures", listed(summary.textures, grouped(summary.textures.size()),
                                 [&](const Summary::TextureLine& texture, std::size_t k) {
                                     std::string text = label_of(texture.name, k);
                                     for (const Summary::ImageLine& image : texture.images) {
                                         if (image.same != kNone) {
                                             text += " the same image as " +
                                                     label_of(summary.textures[image.same].name, image.same);
                                             continue;
                                         }
                                         text += image.link.empty() ? ' ' + image.type
                                                                    : " -> " + brief(std::string_view(image.link));
                                     }
                                     return text;
                                 }));
}

void add_bounds(const Summary& summary, Lines& lines) {
    if (summary.bounds.is_empty()) return;
    const glm::vec3 low = summary.bounds.minimum;
    const glm::vec3 high = summary.bounds.maximum;
    const glm::vec3 size = high - low;
    lines.add("bounds",
              {brief(size.x) + " x " + brief(size.y) + " x " + brief(size.z) + " m",
               "from " + brief(std::array{low.x, low.y, low.z}) + " to " + brief(std::array{high.x, high.y, high.z})});
}

void add_contents(const Summary& summary, Lines& lines) {
    lines.add("joints", {grouped(summary.joints.size())});
    add_rig(summary, lines);
    add_meshes(summary, lines);
    add_levels(summary, lines);
    add_morph_targets(summary, lines);
    lines.add("clips",
              listed(summary.clips, grouped(summary.clips.size()), [](const Summary::ClipLine& clip, std::size_t k) {
                  std::string label = label_of(clip.name, k) + ' ' + brief(clip.end - clip.start) + " s";
                  if (clip.start == 0.0f) return label;
                  return label + " (" + brief(clip.start) + " to " + brief(clip.end) + " s)";
              }));
    add_surfaces(summary, lines);
    add_bounds(summary, lines);
}

template <class List>
Json json_list(const List& list, void (*fill)(Json&, const typename List::value_type&)) {
    Json all = Json::array();
    for (std::size_t k = 0; k < list.size(); ++k) {
        Json one{{"number", k}, {"name", list[k].name}};
        fill(one, list[k]);
        all.push_back(std::move(one));
    }
    return all;
}

void fill_joint(Json& json, const Summary::JointLine& joint) {
    json["parent"] = joint.parent == kNone ? Json(nullptr) : Json(joint.parent);
}

void fill_chain(Json& json, const Summary::ChainLine& chain) {
    json["start"] = chain.start;
    json["effector"] = chain.effector;
    json["links"] = chain.links;
}

void fill_mesh(Json& json, const Summary::MeshLine& mesh) {
    json["vertices"] = mesh.vertices;
    json["triangles"] = mesh.triangles;
    if (mesh.lines != 0) json["lines"] = mesh.lines;
    if (mesh.points != 0) json["points"] = mesh.points;
    json["influences"] = mesh.influences;
    json["morphTargets"] = mesh.morph_targets;
}

void fill_clip(Json& json, const Summary::ClipLine& clip) {
    json["start"] = short_number(clip.start);
    json["end"] = short_number(clip.end);
    json["seconds"] = short_number(clip.end - clip.start);
    json["repeats"] = clip.repeats;
}

void fill_texture(Json& json, const Summary::TextureLine& texture) {
    json["images"] = Json::array();
    for (const Summary::ImageLine& image : texture.images) {
        Json one{{"type", image.type}, {"bytes", image.bytes}};
        if (!image.link.empty()) one["link"] = image.link;
        if (image.same != kNone) one["sameAs"] = image.same;
        json["images"].push_back(std::move(one));
    }
}

Json levels_as_json(const Summary& summary) {
    Json levels = Json::array();
    for (const Summary::Level& level : summary.levels) {
        levels.push_back({{"share", short_number(level.share)},
                          {"triangles", level.triangles},
                          {"vertices", level.vertices},
                          {"error", level.error > 0.0f ? short_number(level.error) : Json(nullptr)}});
    }
    if (!levels.empty()) levels[0]["error"] = 0.0;
    return levels;
}

}  // namespace

std::string kind_in_words(const std::string& kind) {
    constexpr std::array<std::array<std::string_view, 2>, 10> kWords{{{"PALT", "palettes"},
                                                                      {"POSI", "positions"},
                                                                      {"NORM", "normals"},
                                                                      {"TANG", "tangents"},
                                                                      {"TEXC", "texture coordinates"},
                                                                      {"COLR", "colours"},
                                                                      {"BONE", "influences"},
                                                                      {"WGHT", "weights"},
                                                                      {"targets", "morph targets"},
                                                                      {"LODD", "levels of detail"}}};
    for (const auto& [id, words] : kWords) {
        if (kind == id) return std::string(words);
    }
    return kind;
}

Summary summarize_empty(Bytes file) {
    Summary summary;
    summary.bytes = file.size();
    summary.objects = 0;
    for (const converter::ByteCount& count : converter::count_bytes(file)) {
        if (count.bytes != 0) summary.bytes_by_kind.emplace_back(kind_in_words(count.kind), count.bytes);
    }
    return summary;
}

Summary summarize(const Model& model, Bytes file) {
    Summary summary = summarize_empty(file);
    summary.name = model.name();
    if (const Result<ChunkTree> tree = read_chunk_tree(file)) {
        summary.objects = static_cast<std::uint64_t>(std::count_if(
            tree->chunks().begin(), tree->chunks().end(), [](const Chunk& c) { return c.id == FourCC("OBJE"); }));
    }
    for (const Joint& joint : model.joints()) summary.joints.push_back({std::string(joint.name), joint.parent});
    summary.constraints = model.constraints().size();
    for (const Chain& chain : model.chains()) {
        summary.chains.push_back({std::string(chain.name), name_of_joint(model, chain.record.start),
                                  name_of_joint(model, chain.record.effector), chain.links});
    }
    summary.meshes = list_meshes(model);
    summary.levels = list_levels(model);
    for (const Clip& clip : model.clips())
        summary.clips.push_back({std::string(clip.name), clip.start, clip.end, clip.loop});
    for (const Material& material : model.materials()) summary.materials.push_back({std::string(material.name)});
    summary.textures = list_textures(model);
    summary.bounds = rest_bounds(model);
    return summary;
}

Result<Summary> summarize_file(const ChunkTree& tree, Bytes file) {
    if (tree.find(0, FourCC("OBJE")) == kNone) return summarize_empty(file);
    const Result<Model> model = Model::from_memory(file);
    if (!model) return model.error();
    return summarize(*model, file);
}

std::string summary_as_text(const Summary& summary, const std::string& file, std::size_t columns,
                            bool with_bytes_by_kind) {
    std::uint64_t images = 0;
    for (const Summary::TextureLine& texture : summary.textures) {
        for (const Summary::ImageLine& image : texture.images) images += image.bytes;
    }
    std::string head = escaped(file) + ": " + grouped(summary.bytes) + " bytes";
    if (images != 0) head += ", " + grouped(images) + " of them images";
    if (summary.objects == 0) head += ", no object";
    if (summary.objects > 1) head += "; " + grouped(summary.objects) + " objects, this is the first";

    Lines lines(columns);
    if (summary.objects != 0) add_contents(summary, lines);
    if (with_bytes_by_kind) {
        std::vector<std::string> parts;
        for (const auto& [kind, bytes] : summary.bytes_by_kind) parts.push_back(kind + ' ' + grouped(bytes));
        lines.add("bytes", parts);
    }
    return head + '\n' + lines.take();
}

Json summary_as_json(const Summary& summary) {
    Json json{{"name", summary.name}, {"objects", summary.objects}};
    json["joints"] = json_list(summary.joints, fill_joint);
    json["constraints"] = summary.constraints;
    json["chains"] = json_list(summary.chains, fill_chain);
    json["meshes"] = json_list(summary.meshes, fill_mesh);
    json["levels"] = levels_as_json(summary);
    json["clips"] = json_list(summary.clips, fill_clip);
    json["materials"] = json_list(
        summary.materials, +[](Json&, const Summary::Named&) {});
    json["textures"] = json_list(summary.textures, fill_texture);
    json["bounds"] = nullptr;
    if (!summary.bounds.is_empty()) {
        const auto corner = [](const glm::vec3& at) { return short_numbers(std::array{at.x, at.y, at.z}); };
        json["bounds"] = {{"min", corner(summary.bounds.minimum)}, {"max", corner(summary.bounds.maximum)}};
    }
    json["bytesByKind"] = Json::object();
    for (const auto& [kind, bytes] : summary.bytes_by_kind) json["bytesByKind"][kind] = bytes;
    return json;
}

}  // namespace bendy::tools
