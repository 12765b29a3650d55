#pragma once

#include "camera.h"
#include "materials.h"
#include "opengl.h"
#include "overlay.h"
#include "scene_buffers.h"

#include <bendy/runtime.h>

#include <glm/vec2.hpp>

#include <span>
#include <vector>

namespace bendy::viewer {

/// Draws one model into the bound framebuffer, for pictures and for the window. The model must outlive it.
class Renderer {
public:
    Renderer(const Model& model, const ReadableFolders& folders, const Warn& warn);

    /// Sets the box that the camera is fitted to: bones, axes and marks are drawn in proportion to it.
    void set_box(const Box& box) { overlay_.set_size(2.0f * box.radius()); }
    void set_level(float share);
    /// Loads the textures of all submeshes, before the first draw of surfaces. \param sizes  of the submeshes, as
    /// shares of the whole character's; empty: 1
    void load_textures(const TextureLimits& limits, std::span<const float> sizes = {});
    [[nodiscard]] const Lod& level() const { return level_; }

    /// Draws the pose, and the `targets` of IK chains if the options say so. `size`: of the framebuffer, pixels.
    void draw(Pose& pose, const Camera& camera, const DrawOptions& options, std::span<const TargetMark> targets,
              const glm::vec2& size);

    /// Draws every vertex as one pixel whose colour is its number (Model::first_vertex + n; red has the lowest bits;
    /// alpha 0: no vertex). Vertices hide those behind them, and so does the surface if `behind_surface`. For tests.
    void draw_numbers(Pose& pose, const Camera& camera, bool behind_surface);

private:
    void draw_surface(const Camera& camera) const;
    void draw_wireframe(const Camera& camera) const;
    void draw_range(const Submesh& submesh) const;
    void set_material(const Submesh& submesh) const;
    void draw_overlay(Pose& pose, const Camera& camera, const DrawOptions& options, std::span<const TargetMark> targets,
                      const glm::vec2& size);
    void draw_list(const std::vector<OverlayVertex>& list) const;
    void set_skin(const Program& program, const Camera& camera) const;

    [[nodiscard]] const ShownSurface& surface_of(const Submesh& submesh) const;

    const Model* model_;
    Warn warn_;
    std::vector<ShownSurface> surfaces_;  // of each material, then the default one
    Lod level_;
    SceneBuffers buffers_;
    TextureLoader textures_;
    GlTexture reflectance_;
    Overlay overlay_;
    Program surface_;
    Program flat_;
    Program numbers_;
    Program overlay_program_;
    VertexArray overlay_layout_;
    Buffer overlay_vertices_;
    OverlayList list_;
    std::vector<glm::vec3> centres_;  // of the submeshes at rest, to sort transparent ones
};

}  // namespace bendy::viewer
