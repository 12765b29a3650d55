#include "made_models.h"

#include <bendy/format/chunk_writer.h>
#include <bendy/format/codec.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/mesh.h>
#include <bendy/format/records.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <set>
#include <span>
#include <string>
#include <utility>

namespace bendy::bench {
namespace {

constexpr std::uint32_t kChain = 10;  // joints
constexpr std::uint32_t kKeys = 31;
constexpr std::uint32_t kInfluences = 4;

/// The numbers of all vertices.
struct MeshNumbers {
    std::vector<float> positions, normals, tangents, weights;
    std::vector<std::uint16_t> bones;
};

std::unique_ptr<const MadeModel> open(std::vector<std::byte> bytes) {
    Result<Model> model = Model::from_memory(bytes);
    if (!model) {
        std::fprintf(stderr, "%s\n", describe_with_place(model.error(), bytes).c_str());
        std::abort();
    }
    return std::make_unique<const MadeModel>(MadeModel{std::move(bytes), *std::move(model)});
}

void begin_file(ChunkWriter& out, std::uint32_t joints, std::uint32_t vertices, std::uint32_t clips) {
    VersionRecord version;
    version.objects = 1;
    version.joints = joints;
    version.meshes = vertices == 0 ? 0 : 1;
    version.vertices = vertices;
    version.clips = clips;
    out.begin(FourCC("HEAD"));
    out.leaf(FourCC("VERS"), bytes_of(version));
    out.begin(FourCC("OBJE"));
}

std::vector<std::byte> end_file(ChunkWriter&& out) {
    out.end();
    out.end();
    return std::move(out).finish();
}

/// Begins a joint's chunk and leaves it open.
void begin_joint(ChunkWriter& out, std::uint32_t joint, const RestRecord& rest,
                 const ConstraintRecord* constraint = nullptr) {
    out.begin(FourCC("SKIN"));
    out.text_leaf(FourCC("NAME"), "joint" + std::to_string(joint));
    out.begin(FourCC("PIVO"));
    out.leaf(FourCC("REST"), bytes_of(rest));
    if (constraint != nullptr) out.leaf(FourCC("LIMT"), bytes_of(*constraint));
    out.end();
}

/// Returns a rest transform: a rotation about x and a translation.
RestRecord rest_of(float radians, const glm::vec3& place) {
    RestRecord rest;
    rest.rotation = {std::sin(radians / 2), 0.0f, 0.0f, std::cos(radians / 2)};
    rest.translation = {place.x, place.y, place.z};
    return rest;
}

std::uint32_t parent_of(std::uint32_t joint) {
    return joint == 0 ? kNone : joint % kChain == 0 ? 0 : joint - 1;
}

/// Writes chains of ten joints on one root.
void put_joints(ChunkWriter& out, std::uint32_t joints) {
    std::vector<std::uint32_t> ancestors;
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
        for (; !ancestors.empty() && ancestors.back() != parent_of(joint); ancestors.pop_back()) out.end();
        ancestors.push_back(joint);
        const float y = joint % kChain == 0 ? 0.01f * static_cast<float>(joint) : 0.1f;
        begin_joint(out, joint, rest_of(0.0f, {0.0f, y, 0.0f}));
    }
    for (; !ancestors.empty(); ancestors.pop_back()) out.end();
}

/// Writes a boxed stream of vec3: each component is minimum + step * integer.
void put_boxed(ChunkWriter& out, FourCC id, const std::vector<std::int16_t>& steps, StreamBox box) {
    StreamRecord record;
    record.component_type = static_cast<std::uint8_t>(ComponentType::i16);
    record.normalised = static_cast<std::uint8_t>(Numbers::boxed);
    record.components = 3;
    record.elements = static_cast<std::uint32_t>(steps.size() / 3);
    const std::array boxes{box, box, box};
    const std::vector<std::byte> gap(padded(sizeof(boxes)) - sizeof(boxes));
    const Bytes pieces[] = {bytes_of(record), std::as_bytes(std::span(boxes)), gap, std::as_bytes(std::span(steps))};
    out.leaf(id, pieces);
}

/// Writes a mesh whose palette contains all joints.
void put_mesh(ChunkWriter& out, std::uint32_t vertices, std::uint32_t joints, const MeshNumbers& numbers) {
    std::vector<std::uint32_t> palette(joints);
    for (std::uint32_t joint = 0; joint < joints; ++joint) palette[joint] = joint;
    const std::vector<glm::mat4> inverse_bind(joints, glm::mat4(1.0f));
    PaletteRecord record;
    record.entries = joints;
    const std::vector<std::byte> gap(padded(joints * sizeof(std::uint32_t)) - joints * sizeof(std::uint32_t));
    const std::array pieces{bytes_of(record), std::as_bytes(std::span(palette)), Bytes(gap),
                            std::as_bytes(std::span(inverse_bind))};
    out.begin(FourCC("VECT"));
    out.leaf(FourCC("VINF"), bytes_of(MeshRecord{vertices, 0}));
    out.leaf(FourCC("PALT"), pieces);
    put_stream(out, FourCC("POSI"), ComponentType::f32, 3, numbers.positions);
    put_stream(out, FourCC("NORM"), ComponentType::f32, 3, numbers.normals);
    if (!numbers.tangents.empty()) put_stream(out, FourCC("TANG"), ComponentType::f32, 4, numbers.tangents);
    put_stream(out, FourCC("BONE"), ComponentType::u16, kInfluences, numbers.bones);
    put_stream(out, FourCC("WGHT"), ComponentType::f32, kInfluences, numbers.weights);
    out.end();
}

/// Makes a sheet; each vertex follows four consecutive bones, the same ones for sixty-four vertices.
MeshNumbers make_sheet(std::uint32_t vertices, std::uint32_t joints) {
    MeshNumbers numbers;
    for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
        const std::uint32_t row = vertex / 1000;
        numbers.positions.insert(numbers.positions.end(),
                                 {0.001f * static_cast<float>(vertex % 1000), 0.001f * static_cast<float>(row), 0.0f});
        numbers.normals.insert(numbers.normals.end(), {0.0f, 0.0f, 1.0f});
        numbers.weights.insert(numbers.weights.end(), {0.4f, 0.3f, 0.2f, 0.1f});
        for (std::uint32_t k = 0; k < kInfluences; ++k)
            numbers.bones.push_back(static_cast<std::uint16_t>((vertex / 64 + k) % joints));
    }
    return numbers;
}

/// Makes random positions; each vertex follows four of six near bones.
MeshNumbers make_cloud(std::uint32_t vertices, std::uint32_t joints) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    MeshNumbers numbers;
    for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
        numbers.positions.insert(numbers.positions.end(), {number(random), number(random), number(random)});
        numbers.normals.insert(numbers.normals.end(), {0.0f, 0.6f, 0.8f});
        numbers.tangents.insert(numbers.tangents.end(), {1.0f, 0.0f, 0.0f, 1.0f});
        numbers.weights.insert(numbers.weights.end(), {0.25f, 0.25f, 0.25f, 0.25f});
        const auto near = static_cast<std::uint32_t>(std::uint64_t{vertex} * joints / vertices);
        for (std::uint32_t k = 0; k < kInfluences; ++k)
            numbers.bones.push_back(static_cast<std::uint16_t>((near + random() % 6) % joints));
    }
    return numbers;
}

void put_clip(ChunkWriter& out, std::uint32_t joints) {
    std::vector<TrackRecord> tracks(joints);
    std::vector<float> times;
    std::vector<float> values;
    for (std::uint32_t key = 0; key < kKeys; ++key) times.push_back(static_cast<float>(key) / 30.0f);
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
        TrackRecord& track = tracks[joint];
        track.target = joint;
        track.path = static_cast<std::uint8_t>(TrackPath::rotation);
        track.interpolation = static_cast<std::uint8_t>(Interpolation::linear);
        track.components = 4;
        track.keys = kKeys;
        track.first_value = values.size();
        for (std::uint32_t key = 0; key < kKeys; ++key) {
            const float half = 0.01f * static_cast<float>(key);
            values.insert(values.end(), {0.0f, 0.0f, std::sin(half), std::cos(half)});
        }
    }
    ClipRecord info;
    info.end = times.back();
    out.begin(FourCC("CYCL"));
    out.leaf(FourCC("CINF"), bytes_of(info));
    out.leaf(FourCC("TRAK"), std::as_bytes(std::span(tracks)));
    out.leaf(FourCC("TIME"), std::as_bytes(std::span(times)));
    out.leaf(FourCC("KEYV"), std::as_bytes(std::span(values)));
    out.end();
}

}  // namespace

std::vector<std::byte> make_character(std::uint32_t joints, std::uint32_t vertices) {
    ChunkWriter out;
    out.reserve(std::uint64_t{vertices} * 48 + std::uint64_t{joints} * 1024 + 65536);
    begin_file(out, joints, vertices, 1);
    put_joints(out, joints);
    if (vertices != 0) put_mesh(out, vertices, joints, make_sheet(vertices, joints));
    put_clip(out, joints);
    return end_file(std::move(out));
}

std::unique_ptr<const MadeModel> make_mesh(std::uint32_t vertices) {
    constexpr std::uint32_t kJoints = 64;
    ChunkWriter out;
    begin_file(out, kJoints, vertices, 0);
    put_joints(out, kJoints);
    put_mesh(out, vertices, kJoints, make_cloud(vertices, kJoints));
    return open(end_file(std::move(out)));
}

std::unique_ptr<const MadeModel> make_face(std::uint32_t vertices, std::uint32_t targets, std::uint32_t touched,
                                           bool is_packed) {
    constexpr std::uint32_t kRun = 8;
    std::mt19937 random(1);
    ChunkWriter out;
    begin_file(out, 1, vertices, 0);
    begin_joint(out, 0, rest_of(0.0f, {}));
    out.end();
    const MeshNumbers numbers = make_sheet(vertices, 1);
    out.begin(FourCC("VECT"));
    out.leaf(FourCC("VINF"), bytes_of(MeshRecord{vertices, 0}));
    put_stream(out, FourCC("POSI"), ComponentType::f32, 3, numbers.positions);
    put_stream(out, FourCC("NORM"), ComponentType::f32, 3, numbers.normals);
    for (std::uint32_t target = 0; target < targets; ++target) {
        std::set<std::uint16_t> chosen;
        while (chosen.size() < touched) {
            const auto first = static_cast<std::uint32_t>(random() % (vertices - kRun));
            for (std::uint32_t k = 0; k < kRun && chosen.size() < touched; ++k)
                chosen.insert(static_cast<std::uint16_t>(first + k));
        }
        out.begin(FourCC("TARG"));
        out.leaf(FourCC("TINF"), bytes_of(MorphTargetRecord{}));
        put_stream(out, FourCC("INDX"), ComponentType::u16, 1,
                   std::vector<std::uint16_t>(chosen.begin(), chosen.end()));
        for (const FourCC id : {FourCC("POSI"), FourCC("NORM")}) {
            if (is_packed) {
                std::vector<std::int16_t> steps(std::size_t{touched} * 3);
                for (std::int16_t& step : steps) step = static_cast<std::int16_t>(random());
                put_boxed(out, id, steps, StreamBox{0.0f, 1e-6f});
            } else {
                std::vector<float> shifts(std::size_t{touched} * 3);
                for (float& shift : shifts) shift = 1e-6f * static_cast<float>(static_cast<std::int16_t>(random()));
                put_stream(out, id, ComponentType::f32, 3, shifts);
            }
        }
        out.end();
    }
    out.end();
    return open(end_file(std::move(out)));
}

std::unique_ptr<const MadeModel> make_chain(Solver solver, bool is_limited) {
    constexpr std::uint32_t kJoints = 3;
    ConstraintRecord constraint;
    constraint.model = static_cast<std::uint8_t>(ConstraintModel::hinge);
    constraint.rotation_min[0] = -0.5f;
    constraint.rotation_max[0] = 2.6f;
    ChunkWriter out;
    begin_file(out, kJoints, 0, 0);
    for (std::uint32_t joint = 0; joint < kJoints; ++joint) {
        const RestRecord rest = rest_of(joint == 1 ? 0.44f : 0.09f, {0.0f, joint == 0 ? 0.0f : 0.5f, 0.0f});
        begin_joint(out, joint, rest, is_limited && joint == 1 ? &constraint : nullptr);
    }
    for (std::uint32_t joint = 0; joint < kJoints; ++joint) out.end();
    ChainRecord chain;
    chain.solver = static_cast<std::uint8_t>(solver);
    chain.effector = solver == Solver::aim ? 0 : 2;
    chain.pole_vector = {0.0f, 0.0f, 1.0f};
    out.begin(FourCC("IKCH"));
    out.text_leaf(FourCC("NAME"), "chain");
    out.leaf(FourCC("KINF"), bytes_of(chain));
    out.end();
    return open(end_file(std::move(out)));
}

}  // namespace bendy::bench
