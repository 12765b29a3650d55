#include "joint_transforms.h"
#include "made_models.h"
#include "sections.h"

#include <bendy/format/chunk_writer.h>
#include <bendy/format/codec.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/records.h>

#include <glm/geometric.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <utility>

namespace bendy::bench {
namespace {

void put_joints(ChunkWriter& out, const Model& model) {
    std::vector<std::uint32_t> ancestors;
    for (std::uint32_t joint = 0; joint < model.joints().size(); ++joint) {
        const Joint& from = model.joints()[joint];
        for (; !ancestors.empty() && ancestors.back() != from.parent; ancestors.pop_back()) out.end();
        ancestors.push_back(joint);
        const auto& [rotation, translation, scale] = from.rest;
        RestRecord rest;
        rest.rotation = {rotation.x, rotation.y, rotation.z, rotation.w};
        rest.translation = {translation.x, translation.y, translation.z};
        rest.scale = {scale.x, scale.y, scale.z};
        out.begin(FourCC("SKIN"));
        out.text_leaf(FourCC("NAME"), "joint" + std::to_string(joint));
        out.begin(FourCC("PIVO"));
        out.leaf(FourCC("REST"), bytes_of(rest));
        out.end();
    }
    for (; !ancestors.empty(); ancestors.pop_back()) out.end();
}

void put_mesh(ChunkWriter& out, const Mesh& mesh) {
    std::vector<float> positions, normals, tangents, weights;
    std::vector<std::uint16_t> bones;
    for (std::uint32_t vertex = 0; vertex < mesh.vertices; ++vertex) {
        const glm::vec3 p = mesh.positions.vec3(vertex);
        const glm::vec3 n = glm::normalize(p + glm::vec3(1e-3f, 2e-3f, 3e-3f));
        const glm::vec3 t = glm::normalize(glm::cross(n, glm::vec3(0.36f, 0.48f, 0.8f)));
        positions.insert(positions.end(), {p.x, p.y, p.z});
        normals.insert(normals.end(), {n.x, n.y, n.z});
        tangents.insert(tangents.end(), {t.x, t.y, t.z, 1.0f});
        for (std::uint32_t k = 0; k < mesh.bones->components; ++k) {
            bones.push_back(static_cast<std::uint16_t>(mesh.bones->index(vertex, k)));
            weights.push_back(mesh.weights->number(vertex, k));
        }
    }
    PaletteRecord palette;
    palette.entries = static_cast<std::uint32_t>(mesh.palette.joints.size());
    const std::size_t bytes = mesh.palette.joints.size_bytes();
    const std::vector<std::byte> gap(padded(bytes) - bytes);
    const std::array pieces{bytes_of(palette), std::as_bytes(mesh.palette.joints), Bytes(gap),
                            std::as_bytes(mesh.palette.inverse_bind())};
    out.begin(FourCC("VECT"));
    out.leaf(FourCC("VINF"), bytes_of(MeshRecord{mesh.vertices, 0}));
    out.leaf(FourCC("PALT"), pieces);
    bench::put_stream(out, FourCC("POSI"), ComponentType::f32, 3, positions);
    bench::put_stream(out, FourCC("NORM"), ComponentType::f32, 3, normals);
    bench::put_stream(out, FourCC("TANG"), ComponentType::f32, 4, tangents);
    bench::put_stream(out, FourCC("BONE"), ComponentType::u16, mesh.bones->components, bones);
    bench::put_stream(out, FourCC("WGHT"), ComponentType::f32, mesh.bones->components, weights);
    out.end();
}

/// The model's joints and skinned meshes, with a normal and a tangent for every vertex; nothing else.
std::vector<std::byte> make_dressed(const Model& model) {
    VersionRecord version;
    version.objects = 1;
    version.joints = static_cast<std::uint32_t>(model.joints().size());
    for (const Mesh& mesh : model.meshes()) {
        if (mesh.is_rigid()) continue;
        ++version.meshes;
        version.vertices += mesh.vertices;
    }
    ChunkWriter out;
    out.begin(FourCC("HEAD"));
    out.leaf(FourCC("VERS"), bytes_of(version));
    out.begin(FourCC("OBJE"));
    put_joints(out, model);
    for (const Mesh& mesh : model.meshes()) {
        if (!mesh.is_rigid()) put_mesh(out, mesh);
    }
    out.end();
    out.end();
    return std::move(out).finish();
}

/// Turns each joint a little, so that no matrix of the palette is the identity.
void disturb(Pose& pose) {
    for (std::uint32_t joint = 0; joint < pose.model().joints().size(); ++joint) {
        JointTransform transform = local_of(pose, joint);
        transform.rotation = transform.rotation * glm::quat(0.9950042f, 0.0998334f, 0.0f, 0.0f);
        set_local(pose, joint, transform);
    }
    clear_morph_weights(pose);
}

void race_skinning(Table& table, const std::string& name, const Model& model) {
    const OzzCharacter character = make_ozz(model);
    Pose pose(model);
    disturb(pose);
    OzzState state(character);
    state.local_to_model();
    state.make_palettes();
    const auto vertices = static_cast<std::size_t>(model.vertex_count());
    std::vector<glm::vec3> our_positions(vertices), our_normals(vertices);
    std::vector<glm::vec4> our_tangents(vertices);
    std::vector<float> positions(3 * vertices), normals(3 * vertices), tangents(3 * vertices);
    constexpr std::array kNames{"skin P", "skin P, N", "skin P, N, T"};
    for (int attributes = 1; attributes <= 3; ++attributes) {
        VertexBuffer out{.positions = our_positions};
        if (attributes > 1) out.normals = our_normals;
        if (attributes > 2) out.tangents = our_tangents;
        table.compare({name, kNames[static_cast<std::size_t>(attributes - 1)], "vertex", static_cast<double>(vertices)},
                      {{"ours", [&] { check(skin(pose, {.out = out}).has_value(), "skin"); }},
                       {"ozz, by influences",
                        [&] { state.skin(attributes, positions.data(), normals.data(), tangents.data()); }}});
    }
}

}  // namespace

void measure_skinning(Table& table, const Character& character) {
    const std::vector<std::byte> bytes = make_dressed(character.model);
    const auto model = Model::from_memory(bytes);
    if (!model) fail(character.name + ": " + describe_with_place(model.error(), bytes));
    if (model->vertex_count() != 0) race_skinning(table, character.name, *model);
}

void measure_large(Table& table) {
    constexpr std::uint32_t kVertices = 1'000'000;
    race_skinning(table, "1 M, 4 of 6 near bones at random", make_mesh(kVertices)->model);
    constexpr std::uint32_t kJoints = 100;
    const std::vector<std::byte> bytes = make_character(kJoints, kVertices);
    const auto sheet = Model::from_memory(bytes);
    if (!sheet) fail(describe_with_place(sheet.error(), bytes));
    const std::vector<std::byte> dressed = make_dressed(*sheet);
    const auto model = Model::from_memory(dressed);
    if (!model) fail(describe_with_place(model.error(), dressed));
    race_skinning(table, "1 M, 64 neighbours the same 4", *model);
}

}  // namespace bendy::bench
