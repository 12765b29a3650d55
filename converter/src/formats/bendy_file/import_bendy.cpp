#include "formats/bendy_file/mesh.h"
#include "rigging/rig/clips.h"
#include "scene/failure.h"
#include "scene/frame_shapes.h"

#include <bendy/converter/import.h>
#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/chunk_reader.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>
#include <bendy/format/file.h>
#include <bendy/format/material.h>
#include <bendy/format/records.h>
#include <bendy/json/json.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

using Member = std::pair<std::string_view, std::string_view>;  // key and value, as in the text

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

/// The members of an object. `text` must be valid JSON that starts with a brace.
std::vector<Member> members_of(std::string_view text) {
    std::vector<Member> members;
    std::size_t depth = 0;
    std::size_t start = 1;  // of the current key or value
    std::string_view name;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            in_string = c != '"';
            continue;
        }
        const bool ends_value = depth == 1 && (c == ',' || c == '}');
        if (ends_value && !name.empty()) members.emplace_back(name, trimmed(text.substr(start, i - start)));
        if (ends_value) {
            name = {};
            start = i + 1;
        }
        if (depth == 1 && c == ':') {
            name = trimmed(text.substr(start, i - start));
            start = i + 1;
        }
        in_string = c == '"';
        if (c == '{' || c == '[') ++depth;
        if (c == '}' || c == ']') --depth;
    }
    return members;
}

/// Splits HEAD's EXTR as written by build_chunks, {"asset": ..., "extras": ...}; the values' text is kept verbatim.
/// Other JSON is kept whole as the source's extras.
void read_source_facts(std::string_view text, Scene& scene, Report& report) {
    if (text.empty()) return;
    const std::string_view json = trimmed(text);
    if (!is_json(json)) return report.warn("the file's own data is not JSON, left out", "HEAD/EXTR");
    std::vector<Member> members;
    if (json.front() == '{') members = members_of(json);
    const auto is_fact = [](const Member& member) {
        return member.first == R"("asset")" || member.first == R"("extras")";
    };
    const bool are_facts = !members.empty() && members.size() <= 2 &&
                           std::all_of(members.begin(), members.end(), is_fact) &&
                           members.front().first <= members.back().first &&
                           (members.size() == 1 || members.front().first != members.back().first);
    if (!are_facts) {
        scene.source_extras = json;
        return report.warn("the file's own data is kept as the member \"extras\" of what is written", "HEAD/EXTR");
    }
    for (const auto& [name, value] : members) (name == R"("asset")" ? scene.asset : scene.source_extras) = value;
}

/// The chunks that this importer reads. The list is deliberately separate from the format's tables: a chunk that a
/// later version defines is reported as left out until it is supported here.
constexpr std::array kRead{
    FourCC("HEAD"), FourCC("VERS"), FourCC("TEXT"), FourCC("SAMP"), FourCC("IMAG"), FourCC("LINK"), FourCC("SAME"),
    FourCC("MATE"), FourCC("SURF"), FourCC("EXTN"), FourCC("OBJE"), FourCC("NAME"), FourCC("EXTR"), FourCC("SKIN"),
    FourCC("PIVO"), FourCC("REST"), FourCC("LIMT"), FourCC("PULL"), FourCC("POLY"), FourCC("IKCH"), FourCC("KINF"),
    FourCC("VECT"), FourCC("VINF"), FourCC("PALT"), FourCC("TARG"), FourCC("TINF"), FourCC("POSI"), FourCC("NORM"),
    FourCC("TANG"), FourCC("TEXC"), FourCC("COLR"), FourCC("BONE"), FourCC("WGHT"), FourCC("USER"), FourCC("VALS"),
    FourCC("INDX"), FourCC("CYCL"), FourCC("CINF"), FourCC("TRAK"), FourCC("TIME"), FourCC("KEYV"), FourCC("PACK"),
    FourCC("LODD"), FourCC("BNDS"), FourCC("JNTS"), FourCC("JNAM"), FourCC("MARK"), FourCC("MORE"), FourCC("FRMS"),
    FourCC("FNAM"), FourCC("GRID"), FourCC("NLST"), FourCC("PLAY"), FourCC("CURV"), FourCC("ROLE"), FourCC("STND")};

/// Number of bytes read from a leaf that holds a single record; 0 for other leaves.
std::uint64_t record_size(FourCC id) {
    constexpr std::array<std::pair<FourCC, std::uint64_t>, 11> kSizes{{{FourCC("VERS"), sizeof(VersionRecord)},
                                                                       {FourCC("SAMP"), sizeof(SamplerRecord)},
                                                                       {FourCC("SAME"), sizeof(SameRecord)},
                                                                       {FourCC("SURF"), sizeof(SurfaceRecord)},
                                                                       {FourCC("REST"), sizeof(RestRecord)},
                                                                       {FourCC("LIMT"), sizeof(ConstraintRecord)},
                                                                       {FourCC("PULL"), sizeof(ChainWeightRecord)},
                                                                       {FourCC("KINF"), sizeof(ChainRecord)},
                                                                       {FourCC("VINF"), sizeof(MeshRecord)},
                                                                       {FourCC("TINF"), sizeof(MorphTargetRecord)},
                                                                       {FourCC("CINF"), sizeof(ClipRecord)}}};
    for (const auto& [known, size] : kSizes) {
        if (known == id) return size;
    }
    return 0;
}

struct LeftOut {
    std::uint32_t first = 0;  // chunk number
    std::uint64_t count = 0;
};

/// Names the chunks that import_bendy does not read, and records that are longer than this version knows.
void warn_of_left_out(const ChunkTree& tree, Report& report) {
    constexpr std::size_t kNamed = 50;  // ids; a hostile file may have a million
    std::map<std::uint32_t, LeftOut> unread;
    std::map<std::uint32_t, LeftOut> longer;
    for (std::uint32_t number = 0; number < tree.chunks().size();) {
        const Chunk& chunk = tree[number];
        const bool is_read = std::find(kRead.begin(), kRead.end(), chunk.id) != kRead.end();
        const std::uint64_t size = record_size(chunk.id);
        if (!is_read || (size != 0 && !chunk.is_container() && tree.payload(number).size() > size)) {
            const auto [place, is_new] = (is_read ? longer : unread).try_emplace(chunk.id.value, LeftOut{number, 0});
            ++place->second.count;
        }
        number = is_read ? number + 1 : chunk.end;
    }
    const auto name = [&](const std::map<std::uint32_t, LeftOut>& list, const std::string& what) {
        std::size_t named = 0;
        for (const auto& [id, found] : list) {
            if (named++ < kNamed) {
                const std::string path = chunk_path(tree.bytes(), tree[found.first].offset);
                report.warn(what + FourCC(id).letters().data(), path, found.count);
            } else {
                report.warn(what + "other kinds", {}, found.count);
            }
        }
    };
    name(unread, "chunk that is not read is left out: ");
    name(longer, "fields of a later version are left out: ");
}

template <int N, std::size_t Size>
glm::vec<N, float> to_vec(const std::array<float, Size>& numbers) {
    static_assert(N == static_cast<int>(Size));
    glm::vec<N, float> vector(0.0f);
    for (std::size_t i = 0; i < Size; ++i) vector[static_cast<int>(i)] = numbers[i];
    return vector;
}

// --- joints

void import_joints(const SkeletonView& skeleton, Scene& scene) {
    for (const JointView& view : skeleton.joints) {
        Joint& joint = scene.joints.emplace_back();
        joint.name = view.name;
        joint.parent = view.parent;
        joint.rest.translation = to_vec<3>(view.rest.translation);
        joint.rest.rotation = to_vec<4>(view.rest.rotation);
        joint.rest.scale = to_vec<3>(view.rest.scale);
        joint.rest.shear = to_vec<3>(view.rest.shear);
        joint.extras = view.extras;
        joint.extensions = view.extensions;
        joint.more = view.more;
    }
    for (const ConstraintView& constraint : skeleton.constraints)
        scene.joints[constraint.joint].constraints.push_back(constraint.record);
}

void import_chains(const ObjectView& object, Scene& scene) {
    scene.roles.assign(object.roles.begin(), object.roles.end());
    if (object.standing_pose) {
        scene.standing_pose = {object.standing_pose->pose,
                               {object.standing_pose->rotations.begin(), object.standing_pose->rotations.end()}};
    }
    for (const ChainView& view : object.chains) {
        Chain& chain = scene.chains.emplace_back();
        chain.name = view.name;
        chain.record = view.record;
        chain.extras = view.extras;
    }
    for (const ChainWeightView& chain_weight : object.skeleton.chain_weights)
        scene.chains[chain_weight.chain].weights.push_back({chain_weight.joint, chain_weight.weight});
}

// --- clips

/// Key k of fixed frames is at start + k / frame_rate. Times are kept ascending even if a float cannot distinguish two
/// frames.
std::vector<float> frame_times(const ClipView& clip, std::uint32_t keys) {
    std::vector<float> times;
    times.reserve(keys);
    for (std::uint32_t key = 0; key < keys; ++key) {
        const auto time = static_cast<float>(clip.start + key / double{clip.frame_rate});
        const bool ascends = times.empty() || time > times.back();
        times.push_back(ascends ? time : std::nextafter(times.back(), std::numeric_limits<float>::infinity()));
    }
    return times;
}

class ClipImporter {
public:
    ClipImporter(const ChunkTree& tree, const SkeletonView& skeleton, Budget& budget, Report& report)
        : tree_(tree), budget_(budget), report_(report) {
        rests_.reserve(skeleton.joints.size());
        for (const JointView& joint : skeleton.joints) rests_.push_back(joint.rest);
    }

    Clip import(const ClipView& view) {
        const std::string place = chunk_path(tree_.bytes(), tree_[view.chunk].offset);
        Clip clip;
        clip.name = view.name;
        clip.loop = view.loop;
        clip.extras = view.extras;
        clip.more = view.more;
        std::uint64_t fixed = 0;
        for (const TrackView& track : view.tracks) {
            budget_.take(track.keys + std::uint64_t{track.values.size()}, sizeof(float), place);
            fixed += track.times.empty() ? 1 : 0;
            std::vector<float> times = track.times.empty() ? frame_times(view, track.keys)
                                                           : std::vector<float>(track.times.begin(), track.times.end());
            clip.tracks.push_back({track.path,
                                   track.interpolation,
                                   track.target,
                                   track.components,
                                   std::move(times),
                                   {track.values.begin(), track.values.end()}});
        }
        if (view.packed) unpack(view, place, clip);
        for (const PlayRecord& play : view.plays)
            clip.plays.push_back({play.mesh, play.first, play.frames, play.closed != 0});
        if (!view.plays.empty()) {
            clip.frame_rate = view.frame_rate;
            clip.frame_start = view.start;
        }
        for (const CurveView& curve : view.curves) clip.curves.push_back(import_curve(curve, place));
        if (fixed != 0) report_.warn("tracks of fixed frames are written as timed keys", place, fixed);
        if (const ClipSpan stated{view.start, view.end}; stated != span_of(clip)) clip.stated_span = stated;
        import_markers(view, place, clip);
        return clip;
    }

private:
    void unpack(const ClipView& view, const std::string& place, Clip& clip) {
        const PackedView& packed = *view.packed;
        std::uint64_t tracks = 0;
        for (const PackedList& list : packed.lists) tracks += list.count;
        budget_.take(tracks * packed.record.frames, 5 * sizeof(float), place);
        for (UnpackedTrack& track : unpack_clip(packed, rests_)) {
            // The last frame's time is rounded, so it may lie slightly after the clip's end.
            const std::size_t last = track.times.size() - 1;
            if (last == 0 || track.times[last - 1] < view.end)
                track.times[last] = std::min(track.times[last], view.end);
            clip.tracks.push_back({track.path, Interpolation::linear, track.joint, track.components,
                                   std::move(track.times), std::move(track.values)});
        }
    }

    [[nodiscard]] Curve import_curve(const CurveView& view, const std::string& place) const {
        budget_.take(view.keys + std::uint64_t{view.value_count()}, sizeof(float), place);
        budget_.take(view.path.size() + std::uint64_t{view.name.size()}, 1, place);
        Curve curve;
        curve.name = view.name;
        curve.path = view.path;
        curve.kind = view.kind;
        curve.target = view.target;
        curve.interpolation = view.interpolation;
        curve.components = view.components;
        curve.times.assign(view.times.begin(), view.times.end());
        curve.values.reserve(view.value_count());
        for (std::size_t i = 0; i < view.value_count(); ++i) curve.values.push_back(view.value(i));
        return curve;
    }

    void import_markers(const ClipView& view, const std::string& place, Clip& clip) {
        std::vector<SourceMarker> markers;
        markers.reserve(view.markers.size());
        for (const bendy::Marker& marker : view.markers) {
            budget_.take(sizeof(SourceMarker) + marker.name.size() + place.size(), 1, place);
            markers.push_back({{marker.seconds, std::string(marker.name)}, place});
        }
        set_markers(clip, std::move(markers), {}, WrongMarkers::left_out, report_);
    }

    const ChunkTree& tree_;
    Budget& budget_;
    Report& report_;
    std::vector<RestRecord> rests_;
};

// --- the collapse sequence

void import_collapse(const CollapseView& view, Scene& scene) {
    for (const MeshCollapseView& stored : view.meshes) {
        Mesh& mesh = scene.meshes[stored.mesh];
        mesh.base = stored.base;
        mesh.collapse.resize(stored.vertices);
        mesh.joined.resize(stored.vertices);
        for (std::uint32_t vertex = 0; vertex < stored.vertices; ++vertex) {
            const bool collapses = vertex >= stored.base;
            mesh.collapse[vertex] = collapses ? stored.target(vertex) : vertex;
            mesh.joined[vertex] = collapses && stored.is_joined(vertex) ? 1 : 0;
        }
    }
    for (std::uint32_t number = 0; number < view.levels; ++number) {
        LodLevel& level = scene.levels.emplace_back();
        level.error = view.error(number);
        for (const Mesh& mesh : scene.meshes) level.alive.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        for (std::uint32_t place = 0; place < view.meshes.size(); ++place)
            level.alive[view.meshes[place].mesh] = view.alive(number, place);
    }
}

// --- materials and textures

TextureUse to_use(const TextureUseRecord& record) {
    return {record.texture, record.coords, to_vec<2>(record.offset), record.rotation, to_vec<2>(record.scale)};
}

void import_materials(const Document& document, const SkeletonView& skeleton, Scene& scene) {
    for (const MaterialView& view : document.materials) {
        const SurfaceRecord& surface = view.surface;
        Material& material = scene.materials.emplace_back();
        material.name = view.name;
        material.base_colour = to_vec<4>(surface.base_colour);
        material.metallic = surface.metallic;
        material.roughness = surface.roughness;
        material.emissive = to_vec<3>(surface.emissive);
        material.normal_scale = surface.normal_scale;
        material.occlusion_strength = surface.occlusion_strength;
        material.alpha_cutoff = surface.alpha_cutoff;
        material.alpha_mode = static_cast<AlphaMode>(surface.alpha_mode);
        material.double_sided = surface.double_sided != 0;
        material.unlit = surface.unlit != 0;
        material.base_colour_texture = to_use(surface.base_colour_texture);
        material.metallic_roughness_texture = to_use(surface.metallic_roughness_texture);
        material.normal_texture = to_use(surface.normal_texture);
        material.occlusion_texture = to_use(surface.occlusion_texture);
        material.emissive_texture = to_use(surface.emissive_texture);
        material.extensions = view.extensions;
        material.extras = view.extras;
        material.more = view.more;
    }
    // The first object's own materials come behind those of HEAD, by joint.
    std::uint32_t joint = 0;
    for (std::uint32_t own = 0; own < skeleton.local_materials.size(); ++own) {
        while (joint + 1 < skeleton.joints.size() && skeleton.first_local_material[joint + 1] <= own) ++joint;
        scene.materials[document.global_materials + own].joint = joint;
    }
}

void import_textures(const ChunkTree& tree, const Document& document, Scene& scene, Report& report) {
    // The image of each IMAG and LINK by texture and index; a SAME may refer to a later texture.
    std::vector<std::vector<std::uint32_t>> image_of(document.textures.size());
    for (std::size_t number = 0; number < document.textures.size(); ++number) {
        const TextureView& view = document.textures[number];
        for (const ImageView& source : view.images) {
            image_of[number].push_back(static_cast<std::uint32_t>(scene.images.size()));
            if (source.same) continue;
            Image& image = scene.images.emplace_back();
            image.media_type = mime_type(source.media);
            image.bytes.assign(source.bytes.begin(), source.bytes.end());
            image.uri = source.uri;
            if (source.bytes.data() != nullptr && source.bytes.empty()) {
                report.warn("image without bytes is written as an empty link",
                            chunk_path(tree.bytes(), tree[view.chunk].offset));
            }
        }
    }
    for (std::size_t number = 0; number < document.textures.size(); ++number) {
        const TextureView& view = document.textures[number];
        Texture& texture = scene.textures.emplace_back();
        texture.name = view.name;
        texture.extras = view.extras;
        texture.more = view.more;
        texture.mag_filter = static_cast<Filter>(view.sampler.mag_filter);
        texture.min_filter = static_cast<Filter>(view.sampler.min_filter);
        texture.wrap_s = static_cast<Wrap>(view.sampler.wrap_s);
        texture.wrap_t = static_cast<Wrap>(view.sampler.wrap_t);
        for (std::size_t place = 0; place < view.images.size(); ++place) {
            const auto& same = view.images[place].same;
            texture.images.push_back(same ? image_of[same->texture][same->image] : image_of[number][place]);
        }
    }
}

Scene import(Bytes bytes, Report& report, MeshParts parts) {
    Result<ChunkTree> tree = read_chunk_tree(bytes);
    if (!tree) fail({}, describe_with_place(tree.error(), bytes));
    Faults faults;
    check_sums(*tree, faults);
    decode_leaves(*tree);
    const Document document = read_document(*tree, faults);
    if (faults.empty()) check_values(*tree, document, faults);
    if (!faults.empty()) fail({}, describe_with_place(faults.list().front(), bytes));
    if (document.objects.empty()) fail({}, "the file has no object");

    Budget budget;
    budget.add_source(bytes.size());
    const ObjectView& object = document.objects.front();
    for (std::size_t other = 1; other < document.objects.size(); ++other) {
        const ObjectView& left_out = document.objects[other];
        report.warn("object left out, only the first is kept", chunk_path(bytes, (*tree)[left_out.chunk].offset));
    }
    warn_of_left_out(*tree, report);

    Scene scene;
    scene.name = object.name;
    scene.extras = object.extras;
    scene.extensions = document.extensions;
    scene.more = object.more;
    scene.source_more = document.more;
    scene.was_compact = document.bound.has_value();
    read_source_facts(document.extras, scene, report);
    import_joints(object.skeleton, scene);
    import_chains(object, scene);
    import_textures(*tree, document, scene, report);
    import_materials(document, object.skeleton, scene);
    import_stored_meshes(*tree, object, parts, budget, scene, report);
    if (object.collapse) import_collapse(*object.collapse, scene);
    ClipImporter clips(*tree, object.skeleton, budget, report);
    for (const ClipView& clip : object.clips) scene.clips.push_back(clips.import(clip));
    return scene;
}

}  // namespace

bool is_bendy_file(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return false;
    std::array<char, 4> id{};
    std::ifstream stream(file, std::ios::binary);
    return stream.read(id.data(), id.size()) && std::string_view(id.data(), id.size()) == "HEAD";
}

Result<Scene, ImportError> import_bendy(Bytes bytes, Report& report, MeshParts parts) {
    return without_throwing<Scene>([&]() -> Result<Scene, ImportError> { return import(bytes, report, parts); });
}

Result<Scene, ImportError> import_bendy(const std::filesystem::path& file, Report& report) {
    const Result<MappedFile> mapped = MappedFile::open(file);
    if (!mapped) return ImportError{{}, describe(mapped.error())};
    return import_bendy(mapped->bytes(), report);
}

}  // namespace bendy::converter
