#pragma once

#include "opengl.h"

#include <bendy/runtime.h>
#include <bendy/viewer/render.h>

#include <glm/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Drawing a model's materials: surface parameters and textures.

namespace bendy::viewer {

/// The surface parameters of a material, including those of some extensions, which the file keeps as JSON.
struct ShownSurface {
    SurfaceRecord record;                ///< emissive includes KHR_materials_emissive_strength
    glm::vec3 dielectric{0.04f};         ///< reflectance of a non-metal at normal incidence, ...
    float dielectric_at_grazing = 1.0f;  ///< ... and at a grazing angle: KHR_materials_ior, KHR_materials_specular
};

/// Returns one for each material, and glTF's default material at the end, for submeshes without a material.
std::vector<ShownSurface> shown_surfaces(const Model& model);

/// A model's textures on the graphics processor.
class TextureLoader {
public:
    /// `folders`: those of the images that the file links to; nothing outside them is read.
    TextureLoader(const Model& model, ReadableFolders folders, Warn warn);

    /// Loads a texture once, as sRGB or as plain numbers, or warns that it cannot be shown. Do not call it while
    /// drawing: uploading binds the texture.
    void load(std::uint32_t number, bool srgb);
    /// Returns a loaded texture; nothing for any other number and for a texture that cannot be shown.
    [[nodiscard]] std::optional<GLuint> texture(std::uint32_t number, bool srgb) const;
    [[nodiscard]] GLuint white() const { return white_.name(); }
    /// A grey check, drawn in place of a base colour that cannot be shown.
    [[nodiscard]] GLuint check() const { return check_.name(); }

private:
    bool upload(std::uint32_t number, const ImageView& image, bool srgb, GlTexture& texture, std::string& problem);

    const Model* model_;
    ReadableFolders folders_;
    Warn warn_;
    GlTexture white_;
    GlTexture check_;
    std::map<std::pair<std::uint32_t, bool>, std::optional<GlTexture>> loaded_;  ///< nothing: cannot be shown
    std::uint64_t pixels_left_;
};

}  // namespace bendy::viewer
