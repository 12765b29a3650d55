#include <bendy/converter/build_chunks.h>
#include <bendy/format/charconv.h>

#include "convert/build_meshes.h"
#include "optimise/compact/pack_curve.h"
#include "optimise/passes/mesh_order.h"
#include "scene/frame_shapes.h"
#include "scene/rest_frames.h"
#include "scene/space.h"

#include <bendy/format/marker.h>
#include <bendy/format/material.h>
#include <bendy/format/packed_clip.h>
#include <bendy/format/records.h>
#include <bendy/format/standing_pose.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <span>
#include <utility>

namespace bendy::converter {
namespace {

// --- textures and materials

MediaType media_of(const Image& image) {
    for (unsigned number = 0; number < kMediaTypes; ++number) {
        if (const auto media = static_cast<MediaType>(number); image.media_type == mime_type(media)) return media;
    }
    return MediaType::other;
}

void put_textures(LeafWriter& out, const Scene& scene) {
    std::map<std::uint32_t, SameRecord> written;  // images that are already written
    for (std::uint32_t number = 0; number < scene.textures.size(); ++number) {
        const Texture& texture = scene.textures[number];
        out.begin(FourCC("TEXT"));
        put_text(out, FourCC("NAME"), texture.name);
        const SamplerRecord sampler{
            static_cast<std::uint8_t>(texture.mag_filter), static_cast<std::uint8_t>(texture.min_filter),
            static_cast<std::uint8_t>(texture.wrap_s), static_cast<std::uint8_t>(texture.wrap_t)};
        out.leaf(FourCC("SAMP"), bytes_of(sampler));
        put_text(out, FourCC("EXTR"), texture.extras);
        put_text(out, FourCC("MORE"), texture.more);
        for (std::uint32_t place = 0; place < texture.images.size(); ++place) {
            const std::uint32_t index = texture.images[place];
            const auto [known, is_new] = written.try_emplace(index, SameRecord{number, place});
            const Image& image = scene.images[index];
            if (!is_new) {
                out.leaf(FourCC("SAME"), bytes_of(known->second));
            } else if (image.bytes.empty()) {
                out.text_leaf(FourCC("LINK"), image.uri);
            } else {
                ImageRecord record;
                record.media = static_cast<std::uint8_t>(media_of(image));
                out.raw_leaf(FourCC("IMAG"), std::array{bytes_of(record), Bytes(image.bytes)});
            }
        }
        out.end();
    }
}

TextureUseRecord to_record(const TextureUse& use) {
    TextureUseRecord record;
    record.texture = use.texture;
    record.coords = use.coords;
    record.offset = to_array<2>(use.offset);
    record.scale = to_array<2>(use.scale);
    record.rotation = use.rotation;
    return record;
}

void put_material(LeafWriter& out, const Material& material) {
    SurfaceRecord surface;
    surface.base_colour = to_array<4>(material.base_colour);
    surface.emissive = to_array<3>(material.emissive);
    surface.metallic = material.metallic;
    surface.roughness = material.roughness;
    surface.normal_scale = material.normal_scale;
    surface.occlusion_strength = material.occlusion_strength;
    surface.alpha_cutoff = material.alpha_cutoff;
    surface.alpha_mode = static_cast<std::uint8_t>(material.alpha_mode);
    surface.double_sided = material.double_sided ? 1 : 0;
    surface.unlit = material.unlit ? 1 : 0;
    surface.base_colour_texture = to_record(material.base_colour_texture);
    surface.metallic_roughness_texture = to_record(material.metallic_roughness_texture);
    surface.normal_texture = to_record(material.normal_texture);
    surface.occlusion_texture = to_record(material.occlusion_texture);
    surface.emissive_texture = to_record(material.emissive_texture);
    out.begin(FourCC("MATE"));
    put_text(out, FourCC("NAME"), material.name);
    out.leaf(FourCC("SURF"), bytes_of(surface));
    put_text(out, FourCC("EXTN"), material.extensions);
    put_text(out, FourCC("EXTR"), material.extras);
    put_text(out, FourCC("MORE"), material.more);
    out.end();
}

// --- joints

void put_rest(LeafWriter& out, const Transform& rest) {
    const RestRecord record = to_record(rest);
    const bool has_shear = rest.shear != glm::vec3(0.0f);
    out.leaf(FourCC("REST"), bytes_of(record).first(has_shear ? sizeof record : kShortest<RestRecord>));
}

using ChainWeightsByJoint = std::vector<std::vector<ChainWeightRecord>>;

ChainWeightsByJoint sort_chain_weights(const Scene& scene) {
    ChainWeightsByJoint by_joint(scene.joints.size());
    for (std::uint32_t chain = 0; chain < scene.chains.size(); ++chain) {
        for (const Chain::Weight& weight : scene.chains[chain].weights)
            by_joint[weight.joint].push_back({chain, weight.weight});
    }
    return by_joint;
}

void put_pivot(LeafWriter& out, const Joint& joint, std::span<const ChainWeightRecord> chain_weights, bool has_table) {
    if (has_table && joint.constraints.empty() && chain_weights.empty()) return;
    out.begin(FourCC("PIVO"));
    if (!has_table) put_rest(out, joint.rest);
    for (const ConstraintRecord& constraint : joint.constraints) out.leaf(FourCC("LIMT"), bytes_of(constraint));
    for (const ChainWeightRecord& chain_weight : chain_weights) out.leaf(FourCC("PULL"), bytes_of(chain_weight));
    out.end();
}

/// Where the materials are written, and by which numbers submeshes and curves refer to them.
struct MaterialPlaces {
    std::vector<std::uint32_t> of_file;                ///< the materials of HEAD
    std::vector<std::vector<std::uint32_t>> of_joint;  ///< each joint's own
    std::vector<std::uint32_t> number;                 ///< in HEAD or, with kLocalMaterial, in the joint
};

/// A joint's own material stays so if no other joint's polygons use it, nor a curve, which knows those of HEAD only.
MaterialPlaces place_materials(const Scene& scene, std::span<const AssignedPolygons> meshes) {
    std::vector<std::uint32_t> owner;
    for (const Material& material : scene.materials) owner.push_back(material.joint);
    for (const AssignedPolygons& mesh : meshes) {
        for (const AssignedSubmesh& range : mesh.ranges) {
            if (range.material != kNone && owner[range.material] != range.joint) owner[range.material] = kNone;
        }
    }
    for (const Clip& clip : scene.clips) {
        for (const Curve& curve : clip.curves) {
            if (curve.kind == CurveTarget::material) owner[curve.target] = kNone;
        }
    }
    MaterialPlaces places;
    places.of_joint.resize(scene.joints.size());
    for (std::uint32_t material = 0; material < owner.size(); ++material) {
        const bool is_own = owner[material] != kNone;
        std::vector<std::uint32_t>& list = is_own ? places.of_joint[owner[material]] : places.of_file;
        places.number.push_back(static_cast<std::uint32_t>(list.size()) | (is_own ? kLocalMaterial : 0));
        list.push_back(material);
    }
    return places;
}

using SubmeshesByJoint = std::vector<std::vector<SubmeshRecord>>;

SubmeshesByJoint sort_by_joint(const Scene& scene, std::span<const AssignedPolygons> meshes,
                               const MaterialPlaces& materials) {
    SubmeshesByJoint by_joint(scene.joints.size());
    for (std::uint32_t mesh = 0; mesh < meshes.size(); ++mesh) {
        for (const AssignedSubmesh& range : meshes[mesh].ranges) {
            SubmeshRecord record;
            record.mesh = mesh;
            record.material = range.material == kNone ? kNone : materials.number[range.material];
            record.first = range.first;
            record.count = range.count;
            record.topology = static_cast<std::uint8_t>(range.topology);
            by_joint[range.joint].push_back(record);
        }
    }
    return by_joint;
}

/// Writes JNTS and JNAM, which replace a SKIN chunk per joint.
void put_joint_table(LeafWriter& out, const Scene& scene, const SubmeshesByJoint& submeshes) {
    std::vector<RestRecord> rests;
    std::vector<JointSubmesh> ranges;
    std::string names;
    bool is_named = false;
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        rests.push_back(to_record(scene.joints[joint].rest));
        for (const SubmeshRecord& record : submeshes[joint]) ranges.push_back({joint, record});
        names.append(scene.joints[joint].name).push_back('\0');
        is_named = is_named || !scene.joints[joint].name.empty();
    }
    JointsRecord record;
    record.joints = static_cast<std::uint32_t>(rests.size());
    record.submeshes = static_cast<std::uint32_t>(ranges.size());
    out.leaf(FourCC("JNTS"),
             std::array{bytes_of(record), std::as_bytes(std::span(rests)), std::as_bytes(std::span(ranges))},
             LeafShape{0, 0, sizeof(float), false});
    if (is_named) out.text_leaf(FourCC("JNAM"), names);
}

void put_joints(LeafWriter& out, const Scene& scene, const SubmeshesByJoint& submeshes,
                const MaterialPlaces& materials) {
    // A NUL inside a name would end it early in the table.
    const bool has_table =
        out.is_compact() && std::none_of(scene.joints.begin(), scene.joints.end(),
                                         [](const Joint& j) { return j.name.find('\0') != std::string::npos; });
    const ChainWeightsByJoint chain_weights = sort_chain_weights(scene);
    std::vector<std::uint32_t> open;
    for (std::uint32_t number = 0; number < scene.joints.size(); ++number) {
        const Joint& joint = scene.joints[number];
        while (!open.empty() && open.back() != joint.parent) {
            out.end();
            open.pop_back();
        }
        assert(joint.parent == kNone || !open.empty());  // pre-order: the parent is open
        out.begin(FourCC("SKIN"));
        open.push_back(number);
        if (!has_table) put_text(out, FourCC("NAME"), joint.name);
        put_pivot(out, joint, chain_weights[number], has_table);
        for (const std::uint32_t own : materials.of_joint[number]) put_material(out, scene.materials[own]);
        if (!has_table) {
            for (const SubmeshRecord& record : submeshes[number]) out.leaf(FourCC("POLY"), bytes_of(record));
        }
        put_text(out, FourCC("EXTR"), joint.extras);
        put_text(out, FourCC("EXTN"), joint.extensions);
        put_text(out, FourCC("MORE"), joint.more);
    }
    for (; !open.empty(); open.pop_back()) out.end();
    if (has_table && !scene.joints.empty()) put_joint_table(out, scene, submeshes);
}

void put_chain(LeafWriter& out, const Chain& chain) {
    out.begin(FourCC("IKCH"));
    put_text(out, FourCC("NAME"), chain.name);
    out.leaf(FourCC("KINF"), bytes_of(chain.record));
    put_text(out, FourCC("EXTR"), chain.extras);
    out.end();
}

// --- clips

/// Orders float arrays by their bits, so that 0 and -0 differ.
struct ByBits {
    bool operator()(const std::vector<float>& a, const std::vector<float>& b) const {
        const auto less = [](float x, float y) { return bit_cast<std::uint32_t>(x) < bit_cast<std::uint32_t>(y); };
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), less);
    }
};

/// Concatenated float arrays; equal ones are stored once.
class FloatPool {
public:
    std::uint64_t add(const std::vector<float>& values) {
        const auto [known, is_new] = places_.try_emplace(values, floats_.size());
        if (is_new) floats_.insert(floats_.end(), values.begin(), values.end());
        return known->second;
    }
    [[nodiscard]] Bytes bytes() const { return std::as_bytes(std::span(floats_)); }

private:
    std::map<std::vector<float>, std::uint64_t, ByBits> places_;
    std::vector<float> floats_;
};

/// Packed frames may end one float before the keys that they replace: moves markers inside.
void put_markers(LeafWriter& out, const Clip& clip, const ClipRecord& info) {
    if (clip.markers.empty()) return;
    std::vector<bendy::Marker> markers;
    markers.reserve(clip.markers.size());
    for (const Marker& marker : clip.markers)
        markers.push_back({std::clamp(marker.seconds, info.start, info.end), marker.name});
    out.leaf(FourCC("MARK"), write_markers(markers));
}

void put_plays(LeafWriter& out, const Clip& clip) {
    if (clip.plays.empty()) return;
    std::vector<PlayRecord> records;
    for (const Play& play : clip.plays) {
        PlayRecord& record = records.emplace_back();
        record.mesh = play.mesh;
        record.first = play.first;
        record.frames = play.frames;
        record.closed = play.closed ? 1 : 0;
    }
    out.leaf(FourCC("PLAY"), std::as_bytes(std::span(records)));
}

/// Writes a clip's curves, one CURV each; compact files pack them where that is smaller.
void put_curves(LeafWriter& out, const Clip& clip, const MaterialPlaces& materials) {
    constexpr LeafShape kFloats{0, 0, sizeof(float), false};
    for (const Curve& curve : clip.curves) {
        const std::optional<PackedCurve> packed = out.is_compact() ? pack_curve(curve) : std::nullopt;
        CurveView written = packed ? packed->view(curve) : view_of(curve);
        if (curve.kind == CurveTarget::material) written.target = materials.number[curve.target];
        out.leaf(FourCC("CURV"), write_curve(written), kFloats);
    }
}

void put_clip(LeafWriter& out, const Clip& clip, const MaterialPlaces& materials) {
    ClipRecord info;
    info.loop = clip.loop ? 1 : 0;
    const ClipSpan span = span_of(clip);
    info.start = span.start;
    info.end = span.end;
    if (!clip.plays.empty()) info.frame_rate = clip.frame_rate;
    FloatPool times;
    FloatPool values;
    std::vector<TrackRecord> tracks;
    for (const Track& track : clip.tracks) {
        TrackRecord record;
        record.target = track.target;
        record.path = static_cast<std::uint8_t>(track.path);
        record.interpolation = static_cast<std::uint8_t>(track.interpolation);
        record.components = static_cast<std::uint16_t>(track.components);
        record.keys = static_cast<std::uint32_t>(track.times.size());
        record.first_time = static_cast<std::uint32_t>(times.add(track.times));
        record.first_value = values.add(track.values);
        tracks.push_back(record);
    }
    out.begin(FourCC("CYCL"));
    put_text(out, FourCC("NAME"), clip.name);
    out.leaf(FourCC("CINF"), bytes_of(info));
    put_text(out, FourCC("EXTR"), clip.extras);
    put_text(out, FourCC("MORE"), clip.more);
    if (!clip.packed.empty()) out.leaf(FourCC("PACK"), clip.packed, LeafShape{.is_packed_clip = true});
    put_plays(out, clip);
    if (!tracks.empty()) {
        constexpr LeafShape kFloats{0, 0, sizeof(float), false};
        out.leaf(FourCC("TRAK"), std::as_bytes(std::span(tracks)), kFloats);
        out.leaf(FourCC("TIME"), times.bytes(), kFloats);
        out.leaf(FourCC("KEYV"), values.bytes(), kFloats);
    }
    put_markers(out, clip, info);
    put_curves(out, clip, materials);
    out.end();
}

VersionRecord make_version(const Scene& scene, std::string_view generator) {
    VersionRecord version;
    version.objects = 1;
    version.joints = static_cast<std::uint32_t>(scene.joints.size());
    version.meshes = static_cast<std::uint32_t>(scene.meshes.size());
    for (const Mesh& mesh : scene.meshes) version.vertices += mesh.positions.size();
    version.clips = static_cast<std::uint32_t>(scene.clips.size());
    version.materials = static_cast<std::uint32_t>(scene.materials.size());
    version.textures = static_cast<std::uint32_t>(scene.textures.size());
    std::copy_n(generator.begin(), std::min(generator.size(), version.generator.size()), version.generator.begin());
    return version;
}

/// The source's `asset` and its root's extras, as one JSON object.
std::string source_facts(const Scene& scene) {
    std::string facts;
    const auto add = [&](std::string_view key, const std::string& json) {
        if (json.empty()) return;
        facts.append(facts.empty() ? "{\"" : ",\"").append(key).append("\":").append(json);
    };
    add("asset", scene.asset);
    add("extras", scene.source_extras);
    return facts.empty() ? facts : facts + '}';
}

void warn_of_unused_images(const Scene& scene, Report& report) {
    std::vector<bool> used(scene.images.size());
    for (const Texture& texture : scene.textures) {
        for (const std::uint32_t image : texture.images) used[image] = true;
    }
    for (std::size_t image = 0; image < used.size(); ++image) {
        if (!used[image])
            report.warn("image that no texture uses is left out", "images[" + std::to_string(image) + "]");
    }
}

/// Size of the long lists in bytes: about their size in the file, and rarely less.
std::uint64_t bulk_of(const Mesh& mesh) {
    const auto bytes = [](const auto& list) { return std::uint64_t{list.size()} * sizeof(list[0]); };
    std::uint64_t sum = bytes(mesh.positions) + bytes(mesh.normals) + bytes(mesh.tangents) + bytes(mesh.bones) +
                        bytes(mesh.weights) + bytes(mesh.collapse) + bytes(mesh.joined) + bytes(mesh.source_numbers);
    for (const auto* streams : {&mesh.texture_coords, &mesh.colours, &mesh.attributes}) {
        for (const Stream& stream : *streams) sum += bytes(stream.values);
    }
    for (const MorphTarget& target : mesh.targets)
        sum += bytes(target.positions) + bytes(target.normals) + bytes(target.tangents);
    for (const Submesh& submesh : mesh.submeshes) sum += bytes(submesh.indices);
    return sum;
}

std::uint64_t bulk_of(const Scene& scene) {
    std::uint64_t sum = 0;
    for (const Mesh& mesh : scene.meshes) sum += bulk_of(mesh);
    for (const Image& image : scene.images) sum += image.bytes.size();
    for (const Clip& clip : scene.clips) {
        for (const Track& track : clip.tracks) sum += (track.times.size() + track.values.size()) * sizeof(float);
        for (const Curve& curve : clip.curves) sum += (curve.times.size() + curve.values.size()) * sizeof(float);
    }
    return sum;
}

/// Frees everything that later chunks do not need.
void release_streams(Mesh& mesh) {
    Mesh left;
    left.collapse = std::move(mesh.collapse);
    left.joined = std::move(mesh.joined);
    left.base = mesh.base;
    mesh = std::move(left);
}

/// \param spent  `scene` again if its long lists may be freed as soon as they are written, otherwise null
std::vector<std::byte> build(const Scene& scene, Scene* spent, std::string_view generator, Report& report,
                             const BuildOptions& options) {
    warn_of_unused_images(scene, report);
    LeafWriter out(options.compact, options.is_draft);
    // A little extra for headers. Untouched memory costs nothing.
    constexpr std::uint64_t kRoundUp = 1 << 16;
    if (!options.compact) out.reserve(bulk_of(scene) + kRoundUp);
    std::vector<AssignedPolygons> polygons;
    polygons.reserve(scene.meshes.size());
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        polygons.push_back(assign_polygons(scene.meshes[mesh]));
        if (spent != nullptr) spent->meshes[mesh].submeshes = {};
    }

    const bool embeds = std::any_of(scene.textures.begin(), scene.textures.end(), [&](const Texture& texture) {
        return std::any_of(texture.images.begin(), texture.images.end(),
                           [&](std::uint32_t image) { return !scene.images[image].bytes.empty(); });
    });
    out.begin(FourCC("HEAD"));
    out.raw_leaf(FourCC("VERS"), std::array{bytes_of(make_version(scene, generator))});
    put_text(out, FourCC("EXTR"), source_facts(scene));
    put_text(out, FourCC("EXTN"), scene.extensions);
    put_text(out, FourCC("MORE"), scene.source_more);
    if (!embeds) put_textures(out, scene);
    const MaterialPlaces materials = place_materials(scene, polygons);
    for (const std::uint32_t material : materials.of_file) put_material(out, scene.materials[material]);
    out.begin(FourCC("OBJE"));
    put_text(out, FourCC("NAME"), scene.name);
    put_text(out, FourCC("EXTR"), scene.extras);
    put_text(out, FourCC("MORE"), scene.more);
    put_joints(out, scene, sort_by_joint(scene, polygons, materials), materials);
    if (!scene.roles.empty()) out.leaf(FourCC("ROLE"), std::as_bytes(std::span(scene.roles)));
    if (scene.standing_pose)
        out.leaf(FourCC("STND"), write_standing_pose(scene.standing_pose->pose, scene.standing_pose->rotations));
    for (const Chain& chain : scene.chains) put_chain(out, chain);
    const CompactMesh exact;
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        const bool is_compact = options.geometry != nullptr;
        put_mesh(out, scene.meshes[mesh], polygons[mesh].indices, is_compact ? options.geometry->meshes[mesh] : exact);
        polygons[mesh].indices = {};
        if (spent != nullptr) release_streams(spent->meshes[mesh]);
    }
    put_collapse(out, scene);
    for (const Clip& clip : scene.clips) put_clip(out, clip, materials);
    out.end();
    if (embeds) put_textures(out, scene);
    out.end();
    return std::move(out).finish();
}

}  // namespace

std::vector<std::byte> build_chunks(const Scene& scene, std::string_view generator, Report& report,
                                    const BuildOptions& options) {
    return build(scene, nullptr, generator, report, options);
}

std::vector<std::byte> build_chunks(Scene&& scene, std::string_view generator, Report& report,
                                    const BuildOptions& options) {
    Scene spent = std::move(scene);
    return build(spent, &spent, generator, report, options);
}

}  // namespace bendy::converter
