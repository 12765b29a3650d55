#pragma once

#include "image_reader.h"
#include "opengl.h"

#include <bendy/runtime.h>
#include <bendy/viewer/render.h>

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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

/// A use of a texture by a material.
struct TextureUse {
    const Submesh* submesh = nullptr;
    const TextureUseRecord* record = nullptr;
    Texels texels = Texels::srgb;
};

/// How large textures may be. What is larger is scaled down while it is decoded.
struct TextureLimits {
    double side = 0.0;        ///< texels that can be seen along a side of an image that covers the whole character
    std::uint64_t bytes = 0;  ///< of all textures together, with their mipmaps
};

/// A model's textures on the graphics processor. An image is decoded once, also if several textures share it or have
/// the same bytes, and only one is in memory at a time.
class TextureLoader {
public:
    /// `folders`: those of the images that the file links to; nothing outside them is read.
    TextureLoader(const Model& model, ReadableFolders folders, Warn warn);

    /// Loads the textures, or warns of those that cannot be shown. Do not call it while drawing: uploading binds them.
    /// \param scale  what a use needs of the side in `limits`: less for a small part of the character, more if it shows
    /// only a part of the image. Not asked of small images
    void load(std::span<const TextureUse> uses, const TextureLimits& limits,
              const std::function<double(const TextureUse&)>& scale);
    /// Binds a loaded texture, with its sampler, to a unit. Returns false for any other number and for a texture that
    /// cannot be shown.
    [[nodiscard]] bool bind(GLuint unit, std::uint32_t number, Texels texels) const;
    [[nodiscard]] GLuint white() const { return white_.name(); }
    /// A grey check, drawn in place of a base colour that cannot be shown.
    [[nodiscard]] GLuint check() const { return check_.name(); }

private:
    struct Image {
        const ImageView* view = nullptr;
        std::filesystem::path file;  // empty: its bytes are in the model's file
        ImageSize size;              // with a problem: it cannot be decoded
        double needed = 0.0;         // texels along its longest side
        unsigned halvings = 0;
        std::array<bool, 2> is_wanted{};  // by Texels
        std::array<std::optional<GlTexture>, 2> textures;

        [[nodiscard]] bool is_complete() const;
        [[nodiscard]] std::uint64_t bytes() const;
    };
    struct Wanted {
        std::uint32_t texture = 0;
        Texels texels = Texels::srgb;
        std::vector<const TextureUse*> uses;
        std::size_t alternative = 0;  // into the texture's images
        std::size_t image = 0;        // into images_
        std::string problem = "has no image";
    };

    bool choose(Wanted& wanted, const TextureLimits& limits, const std::function<double(const TextureUse&)>& scale);
    std::optional<std::size_t> find_image(const ImageView& view, std::string& problem);
    void plan(const TextureLimits& limits);
    void make(Image& image);

    const Model* model_;
    ReadableFolders folders_;
    Warn warn_;
    GlTexture white_;
    GlTexture check_;
    std::vector<Image> images_;
    std::map<std::string_view, std::size_t> by_bytes_;
    std::map<std::filesystem::path, std::size_t> by_file_;
    std::map<std::pair<std::uint32_t, Texels>, std::size_t> loaded_;  // texture to image
    std::uint64_t bytes_ = 0;                                         // of all textures
};

}  // namespace bendy::viewer
