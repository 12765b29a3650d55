#pragma once

#include "opengl.h"

#include <bendy/runtime.h>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace bendy::viewer {

/// The vertex layout on the graphics processor. All meshes are in one buffer, one after another.
struct GpuVertex {
    glm::vec3 position{0.0f};
    glm::vec3 normal{0.0f};             ///< zero if the source has none
    glm::vec4 tangent{0.0f};            ///< likewise
    std::array<glm::vec2, 4> coords{};  ///< sets 0 to 3
    glm::vec4 colour{1.0f};             ///< set 0
    glm::uvec2 influences{0};           ///< first and count, in the list of influences
    glm::uvec2 displacements{0};        ///< first and count, in the list of displacements
};

/// A buffer that shaders read by index. Drivers allow at least 65,536 texels.
class BufferTexture {
public:
    /// `format`: such as GL_RGBA32F; `texel`: the bytes of one texel.
    BufferTexture(GLenum format, std::size_t texel) : format_(format), texel_(texel) {}
    /// Replaces the content. Throws ViewerError if it is too large for the driver.
    void fill(const void* data, std::size_t bytes, GLenum usage);
    void bind(GLuint unit) const;

private:
    Buffer buffer_;
    GlTexture texture_;
    GLenum format_;
    std::size_t texel_;
};

/// A model on the graphics processor. The model must outlive it.
class SceneBuffers {
public:
    explicit SceneBuffers(const Model& model);

    /// Uploads what changes from frame to frame: matrices and weights of morph targets.
    void set_pose(Pose& pose);
    void set_level(const Lod& lod);
    /// Binds vertices, indices, and the buffers to their texture units.
    void bind() const;

    /// Returns the position of a mesh's first index in the bound index buffer.
    [[nodiscard]] std::uint32_t first_index(std::uint32_t mesh) const { return first_index_[mesh]; }
    [[nodiscard]] std::uint32_t vertices() const { return static_cast<std::uint32_t>(model_->vertex_count()); }

private:
    const Model* model_;
    VertexArray layout_;
    Buffer vertices_;
    Buffer indices_;
    BufferTexture palette_{GL_RGBA32F, 16};
    BufferTexture influences_{GL_RG32UI, 8};
    BufferTexture displacements_{GL_RGBA32F, 16};
    BufferTexture weights_{GL_R32F, 4};
    std::vector<std::uint32_t> first_index_;    // one per mesh
    std::vector<std::uint32_t> first_palette_;  // of each mesh's entries, counted in matrices
    std::vector<glm::vec4> rows_;               // scratch memory for the palette
    std::vector<float> weight_list_;
};

}  // namespace bendy::viewer
