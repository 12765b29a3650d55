#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/chunk_writer.h>
#include <bendy/format/records.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

// A small file that holds at least one of every chunk of exact files but ROLE, STND, MARK and CURV, and is good in
// every respect:
//
//     HEAD
//      VERS
//      TEXT      a link, with a name and its author's data
//      TEXT[1]   embedded bytes
//      TEXT[2]   the image of TEXT[1]
//      MATE      global material
//      OBJE
//       SKIN     joint 0 "hip", a local MATE, POLY: triangle of mesh 0, PULL: 0.5 in chain 0
//        SKIN    joint 1 "spine", POLY: triangle of mesh 0, POLY[1]: point of mesh 1, LIMT: a hinge for every pose,
//                LIMT[1]: swing and twist for IK
//         SKIN   joint 2 "head", POLY: triangle of mesh 1 in the global material, POLY[1]: line of mesh 1
//        SKIN[1] joint 3 "tail", with a node's extensions, PULL: 0.25 in chain 1
//       IKCH     chain 0 "back": from hip to head, to be reached: tail
//       IKCH[1]  chain 1: tail alone
//       VECT     mesh 0: skinned by joints 0 and 1, four vertices, a dense and a sparse target
//       VECT[1]  mesh 1: rigid, six vertices
//       LODD     mesh 0: vertex 3 collapses to vertex 1; two levels
//       CYCL     translation linear, rotation cubic, scale step, weights linear, rotation in fixed frames
//      EXTN
//      EXTR
namespace bendy::test {

using Buffer = std::vector<std::byte>;

/// The numbers as payload bytes.
template <class T>
Bytes bytes_of_all(const std::vector<T>& numbers) {
    return std::as_bytes(std::span(numbers));
}

template <class T>
constexpr ComponentType component_type_of() {
    if (std::is_same_v<T, std::uint8_t>) return ComponentType::u8;
    if (std::is_same_v<T, std::int8_t>) return ComponentType::i8;
    if (std::is_same_v<T, std::uint16_t>) return ComponentType::u16;
    if (std::is_same_v<T, std::int16_t>) return ComponentType::i16;
    if (std::is_same_v<T, std::uint32_t>) return ComponentType::u32;
    return ComponentType::f32;
}

/// A stream's payload: its record, then its numbers.
template <class T>
Buffer stream_payload(std::uint16_t components, const std::vector<T>& numbers, bool normalised = false,
                      std::uint32_t set = 0) {
    StreamRecord record;
    record.component_type = static_cast<std::uint8_t>(component_type_of<T>());
    record.normalised = normalised ? 1 : 0;
    record.components = components;
    record.elements = static_cast<std::uint32_t>(numbers.size() / components);
    record.set = set;
    const Bytes head = bytes_of(record);
    const Bytes tail = bytes_of_all(numbers);
    Buffer payload(head.begin(), head.end());
    payload.insert(payload.end(), tail.begin(), tail.end());
    return payload;
}

/// A palette's payload: record, joints, zeros up to 16 bytes, matrices.
inline Buffer palette_payload(const std::vector<std::uint32_t>& joints) {
    PaletteRecord record;
    record.entries = static_cast<std::uint32_t>(joints.size());
    const Bytes head = bytes_of(record);
    const Bytes numbers = bytes_of_all(joints);
    Buffer payload(head.begin(), head.end());
    payload.insert(payload.end(), numbers.begin(), numbers.end());
    payload.resize(padded(payload.size()));
    for (std::size_t entry = 0; entry < joints.size(); ++entry) {
        std::array<float, 16> matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        matrix[13] = -static_cast<float>(entry);  // down by one metre a joint
        const Bytes bytes = bytes_of(matrix);
        payload.insert(payload.end(), bytes.begin(), bytes.end());
    }
    return payload;
}

/// A MARK's payload: record, markers, names. \param names  as they stand in the file
inline Buffer markers_payload(const std::vector<MarkerRecord>& markers, std::string_view names) {
    const MarkersRecord record{static_cast<std::uint32_t>(markers.size()), 0};
    Buffer payload;
    for (const Bytes bytes : {bytes_of(record), bytes_of_all(markers), as_byte_span(names)})
        payload.insert(payload.end(), bytes.begin(), bytes.end());
    return payload;
}

inline void begin_joint(ChunkWriter& writer, std::string_view name, float up,
                        const std::vector<ConstraintRecord>& constraints = {},
                        const std::vector<ChainWeightRecord>& pulls = {}) {
    writer.begin(FourCC("SKIN"));
    writer.text_leaf(FourCC("NAME"), name);
    writer.begin(FourCC("PIVO"));
    RestRecord rest;
    rest.translation = {0.0f, up, 0.0f};
    writer.leaf(FourCC("REST"), bytes_of(rest));
    for (const ConstraintRecord& constraint : constraints) writer.leaf(FourCC("LIMT"), bytes_of(constraint));
    for (const ChainWeightRecord& chain_weight : pulls) writer.leaf(FourCC("PULL"), bytes_of(chain_weight));
    writer.end();
}

/// From 0 to 2 radians about X.
inline ConstraintRecord hinge() {
    ConstraintRecord constraint;
    constraint.model = static_cast<std::uint8_t>(ConstraintModel::hinge);
    constraint.rotation_min[0] = 0.0f;
    constraint.rotation_max[0] = 2.0f;
    constraint.soft_zone = 0.125f;
    constraint.preferred = {0.25f, 0.0f, 0.0f};
    return constraint;
}

inline ConstraintRecord swing_and_twist() {
    ConstraintRecord constraint;
    constraint.model = static_cast<std::uint8_t>(ConstraintModel::swing_twist_ellipse);
    constraint.scope = static_cast<std::uint8_t>(ConstraintScope::ik_only);
    constraint.flags = kProposed;
    constraint.frame = {0.5f, 0.5f, 0.5f, 0.5f};
    constraint.rotation_min = {-0.5f, -0.25f, 0.0f};
    constraint.rotation_max = {0.5f, 0.75f, 1.0f};
    constraint.translation_min = {0.0f, -0.125f, 0.0f};
    constraint.translation_max = {0.0f, 0.125f, ConstraintRecord::kFree};
    constraint.stiffness = {0.0f, 0.5f, 1.0f};
    return constraint;
}

inline void put_submesh(ChunkWriter& writer, std::uint32_t mesh, std::uint32_t material, Topology topology,
                        std::uint32_t first, std::uint32_t count) {
    SubmeshRecord record;
    record.mesh = mesh;
    record.material = material;
    record.topology = static_cast<std::uint8_t>(topology);
    record.first = first;
    record.count = count;
    writer.leaf(FourCC("POLY"), bytes_of(record));
}

inline void put_skeleton(ChunkWriter& writer) {
    begin_joint(writer, "hip", 1.0f, {}, {{0, 0.5f}});
    writer.text_leaf(FourCC("EXTR"), R"({"mass":3})");
    put_submesh(writer, 0, kLocalMaterial | 0u, Topology::triangles, 0, 3);
    writer.begin(FourCC("MATE"));
    SurfaceRecord local;
    local.metallic = 0.25f;
    writer.leaf(FourCC("SURF"), bytes_of(local));
    writer.end();

    begin_joint(writer, "spine", 0.5f, {hinge(), swing_and_twist()});
    put_submesh(writer, 0, kNone, Topology::triangles, 3, 3);
    put_submesh(writer, 1, kNone, Topology::points, 5, 1);

    begin_joint(writer, "head", 0.25f);
    put_submesh(writer, 1, 0, Topology::triangles, 0, 3);
    put_submesh(writer, 1, 0, Topology::lines, 3, 2);
    writer.end();  // head
    writer.end();  // spine
    begin_joint(writer, "tail \xc3\xa9", -0.25f, {}, {{1, 0.25f}});
    writer.text_leaf(FourCC("EXTN"), R"({"KHR_y":[]})");
    writer.end();  // tail
    writer.end();  // hip
}

inline void put_chains(ChunkWriter& writer) {
    ChainRecord back;
    back.start = 0;
    back.effector = 2;
    back.target = 3;
    back.solver = static_cast<std::uint8_t>(Solver::fabrik);
    back.flags = kApproximated;
    back.iterations = 12;
    back.priority = 7;
    back.tolerance = 0.0625f;
    back.pole_vector = {0.0f, 0.0f, 1.0f};
    back.pole_angle = -0.5f;
    back.tip_offset = {0.0f, 0.25f, 0.0f};
    back.tip_rotation = {0.0f, 1.0f, 0.0f, 0.0f};
    back.position_weight = 0.75f;
    back.rotation_weight = 0.25f;
    back.influence = 0.5f;
    back.stretch = 1.5f;
    back.compress = 0.125f;
    writer.begin(FourCC("IKCH"));
    writer.text_leaf(FourCC("NAME"), "back");
    writer.leaf(FourCC("KINF"), bytes_of(back));
    writer.text_leaf(FourCC("EXTR"), "[1]");
    writer.end();

    ChainRecord wag;
    wag.start = 3;
    wag.effector = 3;
    wag.pole = 0;
    writer.begin(FourCC("IKCH"));
    writer.leaf(FourCC("KINF"), bytes_of(wag));
    writer.end();
}

inline void put_skinned_mesh(ChunkWriter& writer) {
    writer.begin(FourCC("VECT"));
    writer.text_leaf(FourCC("NAME"), "fur");
    writer.text_leaf(FourCC("EXTR"), "{}");
    MeshRecord info;
    info.vertices = 4;
    writer.leaf(FourCC("VINF"), bytes_of(info));
    writer.leaf(FourCC("POSI"), stream_payload<float>(3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}));
    writer.leaf(FourCC("NORM"), stream_payload<float>(3, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
    writer.leaf(FourCC("TANG"), stream_payload<float>(4, {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1, 1, 0, 0, -1}));
    writer.leaf(FourCC("TEXC"), stream_payload<float>(2, {0, 0, 1, 0, 0, 1, 1, 1}));
    writer.leaf(FourCC("TEXC"), stream_payload<std::uint16_t>(2, {0, 0, 65535, 0, 0, 65535, 65535, 65535}, true, 1));
    writer.leaf(FourCC("COLR"), stream_payload<std::uint8_t>(3, {255, 0, 0, 0, 255, 0, 0, 0, 255, 51, 51, 51}, true));
    writer.leaf(FourCC("BONE"), stream_payload<std::uint8_t>(2, {0, 1, 0, 1, 1, 0, 1, 1}));
    writer.leaf(FourCC("WGHT"), stream_payload<float>(2, {1, 0, 0.75f, 0.25f, 0.5f, 0.5f, 1, 0}));
    writer.leaf(FourCC("PALT"), palette_payload({0, 1}));
    writer.begin(FourCC("USER"));
    writer.text_leaf(FourCC("NAME"), "_WIND");
    writer.leaf(FourCC("VALS"), stream_payload<std::int16_t>(1, {-32768, 0, 1, 32767}));
    writer.end();

    MorphTargetRecord target;
    target.rest_weight = 0.125f;
    writer.begin(FourCC("TARG"));  // dense
    writer.text_leaf(FourCC("NAME"), "smile");
    writer.leaf(FourCC("TINF"), bytes_of(target));
    writer.leaf(FourCC("POSI"), stream_payload<float>(3, {0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4}));
    writer.leaf(FourCC("NORM"), stream_payload<float>(3, {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}));
    writer.end();
    writer.begin(FourCC("TARG"));  // sparse
    writer.leaf(FourCC("TINF"), bytes_of(MorphTargetRecord{}));
    writer.leaf(FourCC("INDX"), stream_payload<std::uint16_t>(1, {1, 3}));
    writer.leaf(FourCC("POSI"), stream_payload<float>(3, {9, 0, 0, 0, 9, 0}));
    writer.leaf(FourCC("TANG"), stream_payload<float>(3, {0, 0, 9, 0, 0, 8}));
    writer.end();
    writer.leaf(FourCC("INDX"), stream_payload<std::uint16_t>(1, {0, 1, 2, 2, 1, 3}));
    writer.end();
}

inline void put_rigid_mesh(ChunkWriter& writer) {
    writer.begin(FourCC("VECT"));
    MeshRecord info;
    info.vertices = 6;
    info.joint = 2;
    writer.leaf(FourCC("VINF"), bytes_of(info));
    writer.leaf(FourCC("POSI"), stream_payload<float>(3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2}));
    writer.leaf(FourCC("INDX"), stream_payload<std::uint32_t>(1, {0, 1, 2, 3, 4, 5}));
    writer.end();
}

/// An array of LODD, and zeros up to 16 bytes.
template <class T>
void append_padded(Buffer& payload, const std::vector<T>& numbers) {
    const Bytes bytes = bytes_of_all(numbers);
    payload.insert(payload.end(), bytes.begin(), bytes.end());
    payload.resize(padded(payload.size()));
}

/// LODD of one mesh: levels as {error, alive}.
template <class Target>
Buffer collapse_payload(std::uint32_t mesh, std::uint32_t base, const std::vector<Target>& targets,
                        const std::vector<std::pair<float, std::uint32_t>>& levels = {},
                        const std::vector<std::uint8_t>& joined = {}) {
    CollapseRecord record;
    record.meshes = 1;
    record.levels = static_cast<std::uint32_t>(levels.size());
    MeshCollapseRecord part;
    part.mesh = mesh;
    part.base = base;
    part.target_type = static_cast<std::uint8_t>(component_type_of<Target>());
    Buffer payload;
    append_padded(payload, std::vector{record});
    append_padded(payload, std::vector{part});
    append_padded(payload, levels);
    append_padded(payload, targets);
    std::vector<std::uint8_t> bits = joined;
    bits.resize((targets.size() + 7) / 8);
    append_padded(payload, bits);
    return payload;
}

/// One line of a TRAK table.
inline TrackRecord track(std::uint32_t target, TrackPath path, Interpolation interpolation, std::uint16_t components,
                         std::uint32_t keys, std::uint32_t first_time, std::uint64_t first_value) {
    TrackRecord record;
    record.target = target;
    record.path = static_cast<std::uint8_t>(path);
    record.interpolation = static_cast<std::uint8_t>(interpolation);
    record.components = components;
    record.keys = keys;
    record.first_time = first_time;
    record.first_value = first_value;
    return record;
}

inline void put_clip(ChunkWriter& writer) {
    writer.begin(FourCC("CYCL"));
    writer.text_leaf(FourCC("NAME"), "run");
    writer.text_leaf(FourCC("EXTR"), "[]");
    ClipRecord info;
    info.start = 0.5f;
    info.end = 1.0f;
    info.frame_rate = 4.0f;
    info.loop = 1;
    writer.leaf(FourCC("CINF"), bytes_of(info));
    const std::vector<TrackRecord> tracks{
        track(0, TrackPath::translation, Interpolation::linear, 3, 3, 0, 0),
        track(1, TrackPath::rotation, Interpolation::cubic, 4, 2, 3, 9),
        track(2, TrackPath::scale, Interpolation::step, 3, 3, 0, 0),
        track(0, TrackPath::weights, Interpolation::linear, 2, 2, 3, 33),
        track(2, TrackPath::rotation, Interpolation::linear, 4, 3, kNone, 37),
    };
    writer.leaf(FourCC("TRAK"), bytes_of_all(tracks));
    writer.leaf(FourCC("TIME"), bytes_of_all<float>({0.5f, 0.75f, 1.0f, 0.5f, 1.0f}));
    writer.leaf(FourCC("KEYV"), bytes_of_all<float>({
                                    1, 1,    1, 2,     2, 2, 3, 3, 3,  // 0: translation of joint 0, scale of joint 2
                                    0, 0,    0, 5,     0, 0, 0, 1, 0, 0, 0, 6,  // 9: in-tangent, rotation, out-tangent
                                    0, 0,    0, 7,     0, 0, 1, 0, 0, 0, 0, 8,  //
                                    0, 0.5f, 1, 0.25f,                          // 33: weights of two targets
                                    0, 0,    0, 1,     0, 1, 0, 0, 1, 0, 0, 0,  // 37: three rotations
                                }));
    writer.end();
}

inline void put_textures(ChunkWriter& writer) {
    SamplerRecord sampler;
    sampler.mag_filter = static_cast<std::uint8_t>(Filter::linear);
    sampler.min_filter = static_cast<std::uint8_t>(Filter::linear_mipmap_linear);
    sampler.wrap_t = static_cast<std::uint8_t>(Wrap::mirrored_repeat);
    writer.begin(FourCC("TEXT"));
    writer.text_leaf(FourCC("NAME"), "skin");
    writer.text_leaf(FourCC("EXTR"), "1");
    writer.leaf(FourCC("SAMP"), bytes_of(sampler));
    writer.text_leaf(FourCC("LINK"), "skin.png");
    writer.end();

    ImageRecord image;
    image.media = static_cast<std::uint8_t>(MediaType::webp);
    writer.begin(FourCC("TEXT"));
    writer.leaf(FourCC("SAMP"), bytes_of(SamplerRecord{}));
    writer.leaf(FourCC("IMAG"), std::array{bytes_of(image), as_byte_span("RIFF?")});
    writer.end();

    SameRecord same;
    same.texture = 1;
    writer.begin(FourCC("TEXT"));
    writer.leaf(FourCC("SAMP"), bytes_of(SamplerRecord{}));
    writer.leaf(FourCC("SAME"), bytes_of(same));
    writer.end();
}

inline VersionRecord sample_version() {
    VersionRecord version;
    version.objects = 1;
    version.joints = 4;
    version.meshes = 2;
    version.vertices = 10;
    version.clips = 1;
    version.materials = 2;
    version.textures = 3;
    std::memcpy(version.generator.data(), "sample", 6);
    return version;
}

inline Buffer sample_file() {
    ChunkWriter writer;
    writer.begin(FourCC("HEAD"));
    writer.leaf(FourCC("VERS"), bytes_of(sample_version()));
    put_textures(writer);

    SurfaceRecord surface;
    surface.alpha_mode = static_cast<std::uint8_t>(AlphaMode::blend);
    surface.base_colour_texture.texture = 2;
    surface.emissive_texture.texture = 0;
    writer.begin(FourCC("MATE"));
    writer.text_leaf(FourCC("NAME"), "red");
    writer.leaf(FourCC("SURF"), bytes_of(surface));
    writer.text_leaf(FourCC("EXTN"), "{\"KHR_x\":{}}");
    writer.text_leaf(FourCC("EXTR"), "null");
    writer.end();

    writer.begin(FourCC("OBJE"));
    writer.text_leaf(FourCC("NAME"), "fox");
    writer.text_leaf(FourCC("EXTR"), "{\"a\":1}");
    put_skeleton(writer);
    put_chains(writer);
    put_skinned_mesh(writer);
    put_rigid_mesh(writer);
    writer.leaf(FourCC("LODD"), collapse_payload<std::uint16_t>(0, 3, {1}, {{0.0f, 4}, {0.5f, 3}}));
    put_clip(writer);
    writer.end();
    writer.text_leaf(FourCC("EXTN"), "{\"KHR_z\":{}}");
    writer.text_leaf(FourCC("EXTR"), "{\"file\":true}");
    writer.end();
    return std::move(writer).finish();
}

/// A file whose one object is a rope of `joints` joints, each inside the one before.
inline Buffer rope_file(std::uint32_t joints) {
    ChunkWriter writer;
    writer.begin(FourCC("HEAD"));
    VersionRecord version;
    version.objects = 1;
    version.joints = joints;
    writer.leaf(FourCC("VERS"), bytes_of(version));
    writer.begin(FourCC("OBJE"));
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
        writer.begin(FourCC("SKIN"));
        writer.begin(FourCC("PIVO"));
        writer.leaf(FourCC("REST"), bytes_of(RestRecord{}));
        writer.end();
    }
    for (std::uint32_t joint = 0; joint < joints; ++joint) writer.end();
    writer.end();
    writer.end();
    return std::move(writer).finish();
}

}  // namespace bendy::test
