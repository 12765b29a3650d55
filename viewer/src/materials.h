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

// A model's materials as they are drawn.

namespace bendy::viewer {

/// A material's surface as it is drawn: also what the numbers of some extensions say, which the file keeps as text.
struct ShownSurface {
    SurfaceRecord record;                ///< its emissive colour with KHR_materials_emissive_strength
    glm::vec3 dielectric{0.04f};         ///< what a surface that is no metal mirrors, seen from straight ahead, ...
    float dielectric_at_grazing = 1.0f;  ///< ... and at a grazing angle: KHR_materials_ior, KHR_materials_specular
};

/// Of each material; and one more at the end, glTF's default one, for what has no material.
std::vector<ShownSurface> shown_surfaces(const Model& model);

/// A model's textures in the graphics processor's memory.
class TextureLoader {
public:
    /// `folder`: where images that the file only names are looked for; nothing outside it is read. Empty: nowhere.
    TextureLoader(const Model& model, std::filesystem::path folder, Warn warn);

    /// Loads a texture, once, as sRGB or as plain numbers; warns of one that cannot be shown. Not while something is
    /// drawn: what is uploaded is bound.
    void load(std::uint32_t number, bool srgb);
    /// A texture that was loaded so; nothing for any other number, and for one that cannot be shown.
    [[nodiscard]] std::optional<GLuint> texture(std::uint32_t number, bool srgb) const;
    [[nodiscard]] GLuint white() const { return white_.name(); }
    /// In place of a colour that cannot be shown: a grey check.
    [[nodiscard]] GLuint check() const { return check_.name(); }

private:
    bool upload(std::uint32_t number, const ImageView& image, bool srgb, GlTexture& texture, std::string& problem);

    const Model* model_;
    std::filesystem::path folder_;
    Warn warn_;
    GlTexture white_;
    GlTexture check_;
    std::map<std::pair<std::uint32_t, bool>, std::optional<GlTexture>> loaded_;  ///< nothing: cannot be shown
    std::uint64_t pixels_left_;
};

}  // namespace bendy::viewer
