#include "reports/describe_chunk.h"

#include "reports/messages.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/leaf_parts.h>
#include <bendy/format/marker.h>
#include <bendy/format/packed_clip.h>
#include <bendy/format/read_record.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string_view>

namespace bendy::tools {
namespace {

using Json = OrderedJson;

/// Returns a field of plain numbers or of text; null for a field that is a nested record.
Json field_json(const RecordField& field, Bytes payload, std::uint64_t base) {
    const std::uint64_t at = base + field.offset;
    if (field.is_text()) {
        const std::uint64_t size = std::min<std::uint64_t>(field.count, payload.size() - at);
        const std::string_view text = as_text(payload.subspan(at, size));
        return text.substr(0, text.find('\0'));
    }
    if (field.type == FieldType::record) return nullptr;
    Json list = Json::array();
    for (std::uint32_t k = 0; k < field.count; ++k) {
        if (field.type == FieldType::f32) {
            float number = 0.0f;
            copy_at(payload, at + k * sizeof number, number);
            list.push_back(number);
        } else {
            list.push_back(field_number(field, payload, base + k * field_type_size(field.type)));
        }
    }
    return field.count == 1 ? list.front() : list;
}

/// Calls visit(field) for each field of a record at `base` that the payload holds.
template <class Visit>
void for_each_field(const RecordLayout& layout, Bytes payload, std::uint64_t base, const Visit& visit) {
    for (const RecordField& field : layout.fields) {
        if (!field.is_reserved() && base + field.offset < payload.size()) visit(field);
    }
}

/// Returns a nested record, which contains only numbers.
Json inner_record_json(const RecordLayout& layout, Bytes payload, std::uint64_t base) {
    Json fields = Json::object();
    for_each_field(layout, payload, base, [&](const RecordField& field) {
        fields[std::string(field.name)] = field_json(field, payload, base);
    });
    return fields;
}

Json record_json(const RecordLayout& layout, Bytes payload, std::uint64_t base) {
    Json fields = Json::object();
    for_each_field(layout, payload, base, [&](const RecordField& field) {
        fields[std::string(field.name)] =
            field.type == FieldType::record
                ? inner_record_json(*find_layout(field.type_name), payload, base + field.offset)
                : field_json(field, payload, base);
    });
    return fields;
}

Json names_json(std::string_view text) {
    Json names = Json::array();
    while (!text.empty()) {
        const std::size_t end = text.find('\0');
        names.push_back(text.substr(0, end));
        text.remove_prefix(std::min(end, text.size() - 1) + 1);
    }
    return names;
}

/// Returns true if the field is the length in bytes of a text that is itself shown.
bool is_size_of_text(const LeafLayout& leaf, const RecordField& field) {
    return std::any_of(leaf.parts.begin(), leaf.parts.end(),
                       [&](const LeafPart& part) { return part.kind == PartKind::text && part.count == field.name; });
}

/// "solver two_bone", "target joint 3", "soft_zone 0.1 radians".
std::string field_text(const RecordLayout& layout, const RecordField& field, Bytes payload) {
    std::string text(field.name);
    const std::uint64_t number = field_number(field, payload, 0);
    if (const std::string_view value = field.value_name(number); !value.empty() && field.count == 1)
        return text.append(1, ' ').append(value);
    if (field.reference.is_any()) {
        const std::string_view thing = name_of(referred_entity(layout, field, payload, 0));
        if (number == kNone) return text + " none";
        if (!thing.empty() && thing != field.name) text.append(1, ' ').append(thing);
        return text + ' ' + std::to_string(number);
    }
    const Json value = field_json(field, payload, 0);
    if (value.is_string()) return text + " \"" + brief(value.text()) + '"';
    const auto add = [&](const Json& one) {
        text += ' ';
        text += one.is_number_float() ? brief(one.get<float>()) : grouped(one.get<std::uint64_t>());
    };
    if (value.is_array()) {
        std::for_each(value.begin(), value.end(), add);
    } else {
        add(value);
    }
    if (!field.unit.empty()) text.append(1, ' ').append(field.unit);
    return text;
}

/// Returns the fields of the record, texts and names by name, and the records of a leaf that is an array of records.
/// Long arrays of numbers are left out. Empty for other leaves.
Json leaf_fields(const LeafLayout& leaf, Bytes payload) {
    Json fields = Json::object();
    const bool is_records = leaf.record() == nullptr;
    // A truncated record still has its first fields.
    if (!is_records) fields = record_json(*leaf.record(), payload, 0);
    for (const LocatedPart& located : locate_parts(leaf, payload).list) {
        const std::string name(located.part->name);
        const Bytes bytes = payload.subspan(located.offset, located.size);
        if (located.part->kind == PartKind::text) fields[name] = as_text(bytes);
        if (located.part->kind == PartKind::names) fields[name] = names_json(as_text(bytes));
        if (located.part->kind != PartKind::records || !is_records) continue;
        Json list = Json::array();
        for (std::uint64_t k = 0; k < located.shape.count; ++k)
            list.push_back(record_json(*located.shape.record, bytes, k * located.shape.unit()));
        fields[name] = std::move(list);
    }
    return fields;
}

/// The same as one line: enumerations by name, references by kind and number, texts.
std::string leaf_text(const LeafLayout& leaf, Bytes payload) {
    std::string text;
    const RecordLayout* record = leaf.record();
    if (record != nullptr) {
        for_each_field(*record, payload, 0, [&](const RecordField& field) {
            if (field.type != FieldType::record && !is_size_of_text(leaf, field))
                add_part(text, field_text(*record, field, payload));
        });
    }
    for (const LocatedPart& located : locate_parts(leaf, payload).list) {
        const Bytes bytes = payload.subspan(located.offset, located.size);
        const std::string name(located.part->name);
        if (located.part->kind == PartKind::text && !bytes.empty())
            add_part(text, name + " \"" + brief(as_text(bytes)) + '"');
        const bool is_list = located.part->kind == PartKind::records || located.part->kind == PartKind::numbers;
        if (is_list && located.part->count == "rest") add_part(text, grouped(located.shape.count) + ' ' + name);
    }
    return text;
}

std::string quoted(std::string_view text) {
    return '"' + brief(text) + '"';
}

std::string stream_text(const ChunkTree& tree, std::uint32_t number) {
    const auto record = record_at<StreamRecord>(tree, number);
    std::string text = grouped(record.elements) + " x " + std::to_string(record.components) + ' ';
    text += name_at(kValueNames<ComponentType>, record.component_type);
    if (record.normalised != static_cast<std::uint8_t>(Numbers::plain) && record.normalised < kNumbers)
        text.append(" ").append(kValueNames<Numbers>[record.normalised]);
    if (tree[number].id == FourCC("TEXC") || tree[number].id == FourCC("COLR"))
        text += ", set " + std::to_string(record.set);
    return text;
}

std::string submesh_text(const SubmeshRecord& record) {
    if (record.topology >= kTopologies) return "?";
    std::string text = grouped(record.count / corners(static_cast<Topology>(record.topology))) + ' ';
    text += kValueNames<Topology>[record.topology];
    text += " of mesh " + std::to_string(record.mesh);
    if (record.material != kNone) {
        const bool is_local = (record.material & kLocalMaterial) != 0;
        text += is_local ? ", own material " : ", material ";
        text += std::to_string(record.material & ~kLocalMaterial);
    }
    return text;
}

/// Describes a joint's constraints, one after another; empty if it has none.
std::string constraints_text(const ChunkTree& tree, std::uint32_t pivot) {
    std::string text;
    if (pivot == kNone) return text;
    for (const std::uint32_t child : tree.children(pivot)) {
        if (!(tree[child].id == FourCC("LIMT"))) continue;
        text += text.empty() ? "constraint: " : " | ";
        text += tree.encoding_fault(child) ? "encoded" : constraint_text(record_at<ConstraintRecord>(tree, child));
    }
    return text;
}

/// Describes a joint: its place, what moves with it, its limits, and whether the author left data on it.
std::string joint_text(const ChunkTree& tree, std::uint32_t number, const RigIndex& rigs) {
    std::string text;
    const std::uint32_t pivot = tree.find(number, FourCC("PIVO"));
    if (rigs.has_rest(number)) text.append("at ").append(brief(rigs.joint_of(number)->rest.translation));
    std::array<std::uint64_t, kTopologies> polygons{};
    for (const SubmeshView& range : rigs.submeshes_of(number))
        polygons[static_cast<std::size_t>(range.topology)] += range.count / corners(range.topology);
    bool has_extras = false;
    bool has_extensions = false;
    bool has_more = false;
    for (const std::uint32_t child : tree.children(number)) {
        has_extras = has_extras || (tree[child].id == FourCC("EXTR") && tree[child].size != 0);
        has_extensions = has_extensions || (tree[child].id == FourCC("EXTN") && tree[child].size != 0);
        has_more = has_more || (tree[child].id == FourCC("MORE") && tree[child].size != 0);
    }
    for (std::size_t topology = 0; topology < kTopologies; ++topology) {
        if (polygons[topology] != 0)
            add_part(text, grouped(polygons[topology]) + ' ' + std::string(kValueNames<Topology>[topology]));
    }
    if (const std::string role = rigs.role_of(number); !role.empty()) add_part(text, role);
    if (const std::string limits = constraints_text(tree, pivot); !limits.empty()) add_part(text, limits);
    if (has_extras) add_part(text, "extras");
    if (has_extensions) add_part(text, "extensions");
    if (has_more) add_part(text, "further members");
    return text;
}

/// Returns the packed tracks of a leaf; nothing if it is faulty.
std::optional<PackedView> packed_at(const ChunkTree& tree, std::uint32_t number) {
    Faults unread;
    if (number == kNone || tree[number].is_container()) return std::nullopt;
    return read_packed(tree.payload(number), kMaxJoints, tree[number].offset, unread);
}

std::uint64_t track_count(const PackedView& packed) {
    std::uint64_t tracks = 0;
    for (const PackedList& list : packed.lists) tracks += list.count;
    return tracks;
}

std::string packed_text(const ChunkTree& tree, std::uint32_t number) {
    const auto packed = packed_at(tree, number);
    if (!packed) return {};
    std::string text = counted(track_count(*packed), "track") + ", " + counted(packed->record.frames, "frame");
    if (packed->is_even()) text += ", " + brief(packed->record.frame_rate) + " frames/s";
    return text;
}

/// Returns the markers of a leaf; nothing if it is faulty.
std::vector<Marker> markers_at(const ChunkTree& tree, std::uint32_t number) {
    Faults unread;
    if (number == kNone || tree[number].is_container() || tree.encoding_fault(number)) return {};
    return read_markers(tree.payload(number), tree[number].offset, unread).value_or(std::vector<Marker>());
}

std::string markers_text(const ChunkTree& tree, std::uint32_t number) {
    const std::vector<Marker> markers = markers_at(tree, number);
    std::string text = counted(markers.size(), "marker");
    constexpr std::size_t kShown = 6;
    for (std::size_t k = 0; k < std::min(markers.size(), kShown); ++k)
        text += (k == 0 ? ": " : ", ") + quoted(markers[k].name) + " at " + brief(markers[k].seconds) + " s";
    return markers.size() > kShown ? text + ", ..." : text;
}

constexpr std::uint64_t kGridBytes = 24;    // per frame
constexpr std::uint64_t kNormalBytes = 12;  // three f32

std::uint64_t frames_in(const ChunkTree& tree, std::uint32_t grid) {
    return grid == kNone || tree.encoding_fault(grid) ? 0 : tree.payload(grid).size() / kGridBytes;
}

std::string frames_text(const ChunkTree& tree, std::uint32_t number) {
    const std::uint64_t frames = frames_in(tree, tree.find(number, FourCC("GRID")));
    const auto positions = record_at<StreamRecord>(tree, tree.find(number, FourCC("POSI")));
    std::string text = counted(frames, "frame");
    if (frames != 0) text += " of " + grouped(positions.elements / frames) + " places";
    return text;
}

/// Returns the records of PLAY; nothing if it cannot be read.
std::vector<PlayRecord> plays_at(const ChunkTree& tree, std::uint32_t number) {
    std::vector<PlayRecord> plays;
    if (number == kNone || tree[number].is_container() || tree.encoding_fault(number)) return plays;
    const Bytes payload = tree.payload(number);
    const auto records = view_at<PlayRecord>(payload, 0, payload.size() / sizeof(PlayRecord));
    plays.assign(records.begin(), records.end());
    return plays;
}

std::string plays_text(const ChunkTree& tree, std::uint32_t number) {
    constexpr std::size_t kShown = 6;
    std::string text;
    const std::vector<PlayRecord> plays = plays_at(tree, number);
    for (std::size_t k = 0; k < std::min(plays.size(), kShown); ++k) {
        const PlayRecord& play = plays[k];
        add_part(text, counted(play.frames, "frame") + " of mesh " + std::to_string(play.mesh) + " from frame " +
                           std::to_string(play.first) + (play.closed != 0 ? ", closed" : ""));
    }
    return plays.size() > kShown ? text + ", ..." : text;
}

std::string clip_text(const ChunkTree& tree, std::uint32_t number) {
    const auto info = record_at<ClipRecord>(tree, tree.find(number, FourCC("CINF")));
    const std::uint32_t table = tree.find(number, FourCC("TRAK"));
    std::uint64_t tracks = table == kNone ? 0 : tree.payload(table).size() / sizeof(TrackRecord);
    if (const auto packed = packed_at(tree, tree.find(number, FourCC("PACK")))) tracks += track_count(*packed);
    std::uint64_t frames = 0;
    for (const PlayRecord& play : plays_at(tree, tree.find(number, FourCC("PLAY"))))
        frames = std::max(frames, std::uint64_t{play.frames});
    const auto children = tree.children(number);
    const auto curves = std::count_if(children.begin(), children.end(),
                                      [&](std::uint32_t child) { return tree[child].id == FourCC("CURV"); });
    std::string text = brief(info.start) + " to " + brief(info.end) + " s";
    if (frames != 0) text += ", " + counted(frames, "frame");
    if (tracks != 0 || (frames == 0 && curves == 0)) text += ", " + counted(tracks, "track");
    if (curves != 0) text += ", " + counted(static_cast<std::uint64_t>(curves), "curve");
    if (info.loop != 0) text += ", repeats";
    if (info.frame_rate > 0.0f) text += ", " + brief(info.frame_rate) + " frames/s";
    const std::size_t markers = markers_at(tree, tree.find(number, FourCC("MARK"))).size();
    if (markers != 0) text += ", " + counted(markers, "marker");
    return text;
}

/// Returns the error of the last level, and how few vertices remain of each mesh.
std::string collapse_text(const ChunkTree& tree, std::uint32_t number) {
    const auto record = record_at<CollapseRecord>(tree, number);
    const Bytes payload = tree.payload(number);
    std::string text = counted(record.meshes, "mesh", "meshes") + ", " + counted(record.levels, "level");
    constexpr std::uint32_t kShown = 6;
    for (std::uint32_t k = 0; k < std::min(record.meshes, kShown); ++k) {
        const std::uint64_t at = sizeof(CollapseRecord) + k * sizeof(MeshCollapseRecord);
        if (payload.size() < at + sizeof(MeshCollapseRecord)) break;
        MeshCollapseRecord mesh;
        copy_at(payload, at, mesh);
        text += (k == 0 ? ": mesh " : ", mesh ") + std::to_string(mesh.mesh) + " down to " + grouped(mesh.base);
    }
    if (record.meshes > kShown) text += ", ...";
    const std::uint64_t row = (std::uint64_t{1} + record.meshes) * sizeof(std::uint32_t);
    const std::uint64_t rows = sizeof(CollapseRecord) + std::uint64_t{record.meshes} * sizeof(MeshCollapseRecord);
    if (record.levels == 0 || rows > payload.size() || record.levels > (payload.size() - rows) / row) return text;
    float error = 0.0f;
    copy_at(payload, rows + (record.levels - 1) * row, error);
    return text + "; error at most " + brief(error) + " m";
}

std::string material_text(const SurfaceRecord& surface) {
    std::string text = "base " + brief(surface.base_colour) + ", metallic " + brief(surface.metallic) + ", roughness " +
                       brief(surface.roughness);
    if (surface.base_colour_texture.texture != kNone)
        text += ", texture " + std::to_string(surface.base_colour_texture.texture);
    if (surface.unlit != 0) text += ", unlit";
    return text;
}

std::string version_text(const VersionRecord& version) {
    std::string generator;
    for (const std::uint8_t byte : version.generator) {
        if (byte == 0) break;
        generator += static_cast<char>(byte);
    }
    std::string text = "format " + std::to_string(version.major) + '.' + std::to_string(version.minor);
    if (!generator.empty()) text += ", written by " + printable(generator);
    return text;
}

std::string bound_text(const BoundRecord& bound) {
    constexpr float kMillimetres = 1e3f;
    return "error at most " + brief(bound.max_error * kMillimetres) + " mm, met " +
           brief(bound.measured_error * kMillimetres) + " mm, of a height of " + brief(bound.height) + " m";
}

/// Describes the content of a chunk, without the chunk's name.
std::string content_text(const ChunkTree& tree, std::uint32_t number, const RigIndex& rigs) {
    const Chunk& chunk = tree[number];
    if (is_text(chunk.id)) return quoted(as_text(tree.payload(number)));
    if (is_stream(chunk.id)) return stream_text(tree, number);
    if (chunk.id == FourCC("VERS")) return version_text(record_at<VersionRecord>(tree, number));
    if (chunk.id == FourCC("BNDS")) return bound_text(record_at<BoundRecord>(tree, number));
    if (chunk.id == FourCC("SKIN")) return joint_text(tree, number, rigs);
    if (chunk.id == FourCC("JNTS")) {
        const auto table = record_at<JointsRecord>(tree, number);
        return grouped(table.joints) + " joints, " + grouped(table.submeshes) + " submeshes";
    }
    if (chunk.id == FourCC("FRMS")) return frames_text(tree, number);
    if (chunk.id == FourCC("GRID")) return grouped(frames_in(tree, number)) + " frames";
    if (chunk.id == FourCC("NLST")) return grouped(tree.payload(number).size() / kNormalBytes) + " normals";
    if (chunk.id == FourCC("PLAY")) return plays_text(tree, number);
    if (chunk.id == FourCC("JNAM") || chunk.id == FourCC("FNAM")) {
        std::string names(as_text(tree.payload(number)));
        std::replace(names.begin(), names.end(), '\0', ' ');
        return quoted(std::string_view(names));
    }
    if (chunk.id == FourCC("REST")) {
        const auto rest = record_at<RestRecord>(tree, number);
        return "translation " + brief(rest.translation) + ", rotation " + brief(rest.rotation) + ", scale " +
               brief(rest.scale);
    }
    if (chunk.id == FourCC("LIMT")) return constraint_text(record_at<ConstraintRecord>(tree, number));
    if (chunk.id == FourCC("PULL")) return rigs.chain_weight_text(number);
    if (chunk.id == FourCC("IKCH")) return rigs.chain_text(number);
    if (chunk.id == FourCC("KINF")) return rigs.chain_info_text(number);
    if (chunk.id == FourCC("POLY")) return submesh_text(record_at<SubmeshRecord>(tree, number));
    if (chunk.id == FourCC("VECT"))
        return grouped(record_at<MeshRecord>(tree, tree.find(number, FourCC("VINF"))).vertices) + " vertices";
    if (chunk.id == FourCC("PALT")) return grouped(record_at<PaletteRecord>(tree, number).entries) + " joints";
    if (chunk.id == FourCC("TARG")) {
        const auto target = record_at<MorphTargetRecord>(tree, tree.find(number, FourCC("TINF")));
        return "rest weight " + brief(target.rest_weight);
    }
    if (chunk.id == FourCC("LODD")) return collapse_text(tree, number);
    if (chunk.id == FourCC("CYCL")) return clip_text(tree, number);
    if (chunk.id == FourCC("PACK")) return packed_text(tree, number);
    if (chunk.id == FourCC("MARK")) return markers_text(tree, number);
    if (chunk.id == FourCC("TRAK")) return counted(tree.payload(number).size() / sizeof(TrackRecord), "track");
    if (chunk.id == FourCC("TIME") || chunk.id == FourCC("KEYV"))
        return grouped(tree.payload(number).size() / sizeof(float)) + " f32";
    if (chunk.id == FourCC("MATE"))
        return material_text(record_at<SurfaceRecord>(tree, tree.find(number, FourCC("SURF"))));
    if (chunk.id == FourCC("IMAG"))
        return std::string(name_at(kShownNames<MediaType>, record_at<ImageRecord>(tree, number).media));
    if (chunk.id == FourCC("SAME")) {
        const auto same = record_at<SameRecord>(tree, number);
        return "the same image as image " + std::to_string(same.image) + " of TEXT " + std::to_string(same.texture);
    }
    const LeafLayout* leaf = find_leaf(chunk.id);
    return leaf == nullptr || chunk.is_container() ? std::string() : leaf_text(*leaf, tree.payload(number));
}

}  // namespace

std::string encoding_text(const ChunkTree& tree, std::uint32_t number) {
    constexpr std::array<std::string_view, kCodecs> kNames{"raw",     "zstd",          "vertices", "vertices, zstd",
                                                           "indices", "indices, zstd", "clip",     "sums"};
    const unsigned codec = tree[number].codec();
    if (codec >= kCodecs) return "encoded with codec " + std::to_string(codec) + ", unknown";
    std::string text = "encoded: " + std::string(kNames[codec]);
    if (!tree.encoding_fault(number)) text += ", " + grouped(tree.payload(number).size()) + " bytes decoded";
    return text;
}

std::string describe_chunk(const ChunkTree& tree, std::uint32_t number, const RigIndex& rigs) {
    std::string text;
    const auto add = [&](const std::string& part, std::string_view separator) {
        if (part.empty()) return;
        if (!text.empty()) text += separator;
        text += part;
    };
    if (tree[number].is_container()) {
        const std::uint32_t name = tree.find(number, FourCC("NAME"));
        if (name != kNone) {
            add(quoted(as_text(tree.payload(name))), " ");
        } else if (const JointView* joint = rigs.joint_of(number); joint != nullptr && !joint->name.empty()) {
            add(quoted(joint->name), " ");
        }
    }
    const bool is_readable = !tree.encoding_fault(number);
    if (is_readable) add(content_text(tree, number, rigs), "  ");
    if (tree[number].codec() != 0) add(encoding_text(tree, number), "  ");
    if (chunk_meaning(tree[number].id) == "unknown")
        add(tree[number].is_required() ? "unknown, required" : "unknown", " ");
    return text;
}

Json chunk_fields(const ChunkTree& tree, std::uint32_t number) {
    const Chunk& chunk = tree[number];
    const LeafLayout* leaf = find_leaf(chunk.id);
    if (leaf == nullptr || chunk.is_container() || tree.encoding_fault(number)) return Json::object();
    if (chunk.id == FourCC("MARK")) {
        Json markers = Json::array();
        for (const Marker& marker : markers_at(tree, number))
            markers.push_back({{"seconds", marker.seconds}, {"name", marker.name}});
        return {{"markers", markers}};
    }
    return leaf_fields(*leaf, tree.payload(number));
}

std::uint32_t chunk_at(const ChunkTree& tree, std::uint64_t offset) {
    const auto chunks = tree.chunks();
    const auto after = std::upper_bound(chunks.begin(), chunks.end(), offset,
                                        [](std::uint64_t at, const Chunk& chunk) { return at < chunk.offset; });
    return after == chunks.begin() ? kNone : static_cast<std::uint32_t>(after - chunks.begin() - 1);
}

FaultyChunks::FaultyChunks(const ChunkTree& tree, const Faults& faults) {
    for (const Error& fault : faults.list()) first_.try_emplace(chunk_at(tree, fault.offset), fault);
}

std::string FaultyChunks::text(std::uint32_t number) const {
    const auto found = first_.find(number);
    return found == first_.end() ? std::string() : bendy::describe(found->second);
}

bool FaultyChunks::has_fault(const ChunkTree& tree, std::uint32_t number) const {
    const auto found = first_.lower_bound(number);
    return found != first_.end() && found->first < tree[number].end;
}

Json chunks_as_json(const ChunkTree& tree, std::uint32_t root, const FaultyChunks& faulty) {
    Json chunks = Json::array();
    for (std::uint32_t number = root; number < tree[root].end; ++number) {
        const Chunk& chunk = tree[number];
        std::array<char, 11> sum{};
        std::snprintf(sum.data(), sum.size(), "0x%08x", chunk.sum);
        Json entry{{"number", number - root},
                   {"parent", number == root ? Json(nullptr) : Json(chunk.parent - root)},
                   {"id", chunk.id.letters().data()},
                   {"meaning", chunk_meaning(chunk.id)},
                   {"offset", chunk.offset},
                   {"size", chunk.size},
                   {"sum", sum.data()},
                   {"container", chunk.is_container()}};
        if (chunk.is_required()) entry["required"] = true;
        if (chunk.codec() != 0) {
            entry["codec"] = chunk.codec();
            entry["decoded"] = tree.payload(number).size();
        }
        if (auto fields = chunk_fields(tree, number); !fields.empty()) entry["fields"] = std::move(fields);
        if (std::string fault = faulty.text(number); !fault.empty()) entry["fault"] = std::move(fault);
        chunks.push_back(std::move(entry));
    }
    return chunks;
}

std::string_view chunk_meaning(FourCC id) {
#define BENDY_CHUNK(letters, shape, parents, times, what) \
    if (id == FourCC(#letters)) return what;
#include <bendy/format/chunk_ids.def>
#undef BENDY_CHUNK
    return "unknown";
}

}  // namespace bendy::tools
