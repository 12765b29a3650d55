#include "scene_buffers.h"

#include <bendy/viewer/picture.h>

#include <glm/mat4x4.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <limits>

namespace bendy::viewer {
namespace {

/// The palette's first matrix; those of the joints follow, then the meshes' bind palettes.
constexpr std::uint32_t kIdentity = 0;

struct Displacement {
    glm::vec3 position{0.0f};
    float target = 0.0f;  ///< model-wide number; a float, because an integer's bits would be a denormal float
    glm::vec4 normal{0.0f};
    glm::vec4 tangent{0.0f};
};
static_assert(sizeof(Displacement) == 48, "three texels");

float number_or(const StreamView& stream, std::uint32_t vertex, std::uint32_t component, float otherwise) {
    return component < stream.components ? stream.number(vertex, component) : otherwise;
}

void fill_geometry(const Mesh& mesh, std::span<GpuVertex> out) {
    std::vector<glm::vec3> positions(mesh.vertices);
    std::vector<glm::vec3> normals(mesh.vertices);
    std::vector<glm::vec4> tangents(mesh.vertices);
    const std::vector<float> no_weights(mesh.targets.size(), 0.0f);
    (void)apply_morph_targets(mesh, no_weights, {positions, normals, tangents});
    for (std::size_t v = 0; v < out.size(); ++v) {
        out[v].position = positions[v];
        out[v].normal = normals[v];
        out[v].tangent = tangents[v];
    }
}

void fill_coords_and_colours(const Mesh& mesh, std::span<GpuVertex> out) {
    for (const StreamView& stream : mesh.texture_coords) {
        if (stream.set >= out.front().coords.size()) continue;
        for (std::uint32_t v = 0; v < out.size(); ++v)
            out[v].coords[stream.set] = {number_or(stream, v, 0, 0.0f), number_or(stream, v, 1, 0.0f)};
    }
    for (const StreamView& stream : mesh.colours) {
        if (stream.set != 0) continue;
        for (std::uint32_t v = 0; v < out.size(); ++v) {
            for (std::uint32_t c = 0; c < 4; ++c) out[v].colour[static_cast<int>(c)] = number_or(stream, v, c, 1.0f);
        }
    }
}

/// Adds the mesh's influences: any number of pairs of palette entry and weight for each vertex.
void add_influences(const Model& model, std::uint32_t number, std::uint32_t first_entry, std::span<GpuVertex> out,
                    std::vector<glm::uvec2>& list) {
    const Mesh& mesh = model.meshes()[number];
    for (std::uint32_t v = 0; v < out.size(); ++v) {
        const auto first = static_cast<std::uint32_t>(list.size());
        if (mesh.is_rigid()) {
            const std::uint32_t joint = model.rigid_mover(number, v);
            list.emplace_back(joint == kNone ? kIdentity : 1 + joint, std::bit_cast<std::uint32_t>(1.0f));
        } else {
            for (std::uint32_t k = 0; k < mesh.weights->components; ++k) {
                const float weight = mesh.weights->number(v, k);
                if (weight != 0.0f)
                    list.emplace_back(first_entry + mesh.bones->index(v, k), std::bit_cast<std::uint32_t>(weight));
            }
        }
        out[v].influences = {first, static_cast<std::uint32_t>(list.size()) - first};
    }
}

glm::vec3 vector_at(const MorphTargetView& target, const std::optional<StreamView>& stream,
                    const std::optional<StreamView>& rest, std::uint32_t entry) {
    return stream && rest ? target.displacement(*stream, *rest, entry) : glm::vec3(0.0f);
}

/// Adds all displacements of the mesh's targets, sorted by vertex.
void add_displacements(const Mesh& mesh, std::uint32_t first_morph_target, std::span<GpuVertex> out,
                       std::vector<Displacement>& list) {
    for (const MorphTargetView& target : mesh.targets) {
        for (std::uint32_t entry = 0; entry < target.touched(mesh.vertices); ++entry)
            ++out[target.vertex(entry)].displacements.y;
    }
    auto next = static_cast<std::uint32_t>(list.size());
    for (GpuVertex& vertex : out) {
        vertex.displacements.x = next;
        next += vertex.displacements.y;
        vertex.displacements.y = 0;
    }
    list.resize(next);
    for (std::uint32_t t = 0; t < mesh.targets.size(); ++t) {
        const MorphTargetView& target = mesh.targets[t];
        for (std::uint32_t entry = 0; entry < target.touched(mesh.vertices); ++entry) {
            glm::uvec2& range = out[target.vertex(entry)].displacements;
            Displacement& displacement = list[range.x + range.y++];
            displacement.target = static_cast<float>(first_morph_target + t);
            displacement.position = vector_at(target, target.positions, mesh.positions, entry);
            if (mesh.normals)
                displacement.normal = glm::vec4(vector_at(target, target.normals, mesh.normals, entry), 0.0f);
            if (mesh.tangents)
                displacement.tangent = glm::vec4(vector_at(target, target.tangents, mesh.tangents, entry), 0.0f);
        }
    }
}

template <class T>
std::size_t bytes_of(const std::vector<T>& list) {
    return list.size() * sizeof(T);
}

void describe_vertices() {
    const auto floats = [](GLuint place, GLint components, std::size_t offset) {
        describe_floats(place, components, sizeof(GpuVertex), offset);
    };
    const auto integers = [](GLuint place, std::size_t offset) {
        glEnableVertexAttribArray(place);
        glVertexAttribIPointer(
            place, 2, GL_UNSIGNED_INT, sizeof(GpuVertex),
            reinterpret_cast<const void*>(offset));  // NOLINT(performance-no-int-to-ptr): as OpenGL wants it
    };
    floats(0, 3, offsetof(GpuVertex, position));
    floats(1, 3, offsetof(GpuVertex, normal));
    floats(2, 4, offsetof(GpuVertex, tangent));
    floats(3, 4, offsetof(GpuVertex, coords));
    floats(4, 4, offsetof(GpuVertex, coords) + 2 * sizeof(glm::vec2));
    floats(5, 4, offsetof(GpuVertex, colour));
    integers(6, offsetof(GpuVertex, influences));
    integers(7, offsetof(GpuVertex, displacements));
}

/// Writes the upper three rows.
void put_rows(const glm::mat4& matrix, glm::vec4* out) {
    for (int row = 0; row < 3; ++row) out[row] = {matrix[0][row], matrix[1][row], matrix[2][row], matrix[3][row]};
}

}  // namespace

void BufferTexture::fill(const void* data, std::size_t bytes, GLenum usage) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    if (bytes / texel_ > static_cast<std::size_t>(most)) {
        throw ViewerError("the character is too large for this graphics driver: " + std::to_string(bytes / texel_) +
                          " entries in a buffer, which takes " + std::to_string(most));
    }
    constexpr std::array<std::byte, 16> kNothing{};  // an empty buffer texture is an error
    glBindBuffer(GL_TEXTURE_BUFFER, buffer_.name());
    glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(bytes == 0 ? kNothing.size() : bytes),
                 bytes == 0 ? kNothing.data() : data, usage);
    bind_texture(kUploadUnit, GL_TEXTURE_BUFFER, texture_.name());
    glTexBuffer(GL_TEXTURE_BUFFER, format_, buffer_.name());
}

void BufferTexture::bind(GLuint unit) const {
    bind_texture(unit, GL_TEXTURE_BUFFER, texture_.name());
}

SceneBuffers::SceneBuffers(const Model& model) : model_(&model) {
    constexpr std::uint64_t kMostVertices = std::numeric_limits<std::int32_t>::max();
    if (model.vertex_count() > kMostVertices) throw ViewerError("the character has too many vertices to be drawn");
    std::vector<GpuVertex> vertices(model.vertex_count());
    std::vector<glm::uvec2> influences;
    std::vector<Displacement> displacements;
    std::uint64_t entries = 1 + model.joints().size();
    for (std::uint32_t number = 0; number < model.meshes().size(); ++number) {
        const Mesh& mesh = model.meshes()[number];
        first_palette_.push_back(static_cast<std::uint32_t>(entries));
        entries += mesh.palette.joints.size();
        if (mesh.vertices == 0) continue;
        const auto part = std::span(vertices).subspan(model.first_vertex(number), mesh.vertices);
        fill_geometry(mesh, part);
        fill_coords_and_colours(mesh, part);
        add_influences(model, number, first_palette_.back(), part, influences);
        add_displacements(mesh, model.first_morph_target(number), part, displacements);
    }
    rows_.resize(3 * entries);

    glBindVertexArray(layout_.name());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes_of(vertices)), vertices.data(), GL_STATIC_DRAW);
    describe_vertices();
    influences_.fill(influences.data(), bytes_of(influences), GL_STATIC_DRAW);
    displacements_.fill(displacements.data(), bytes_of(displacements), GL_STATIC_DRAW);
    check_memory();
}

void SceneBuffers::set_pose(Pose& pose) {
    put_rows(glm::mat4(1.0f), rows_.data());
    const auto joints = pose.model_space();
    for (std::size_t joint = 0; joint < joints.size(); ++joint) put_rows(joints[joint], &rows_[3 * (1 + joint)]);
    for (std::size_t number = 0; number < model_->meshes().size(); ++number) {
        glm::vec4* to = rows_.data() + std::size_t{3} * first_palette_[number];
        for (const PaletteMatrix& matrix : pose.palette(static_cast<std::uint32_t>(number))) {
            std::memcpy(to, matrix.rows, sizeof matrix.rows);
            to += 3;
        }
    }
    palette_.fill(rows_.data(), bytes_of(rows_), GL_STREAM_DRAW);
    weight_list_.assign(pose.morph_weights().begin(), pose.morph_weights().end());
    weights_.fill(weight_list_.data(), bytes_of(weight_list_), GL_STREAM_DRAW);
}

void SceneBuffers::set_level(const Lod& lod) {
    std::vector<std::uint32_t> indices;
    first_index_.clear();
    for (std::uint32_t mesh = 0; mesh < model_->meshes().size(); ++mesh) {
        first_index_.push_back(static_cast<std::uint32_t>(indices.size()));
        const auto first = static_cast<std::uint32_t>(model_->first_vertex(mesh));
        for (const std::uint32_t index : lod.indices(mesh)) indices.push_back(first + index);
    }
    glBindVertexArray(layout_.name());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes_of(indices)), indices.data(), GL_STATIC_DRAW);
}

void SceneBuffers::bind() const {
    glBindVertexArray(layout_.name());
    palette_.bind(kPaletteUnit);
    influences_.bind(kInfluenceUnit);
    displacements_.bind(kDisplacementUnit);
    weights_.bind(kWeightUnit);
}

}  // namespace bendy::viewer
