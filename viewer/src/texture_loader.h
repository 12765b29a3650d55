#pragma once

#include "gl_object.h"

#include <bendy/runtime.h>
#include <bendy/viewer/render.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

namespace bendy::viewer {

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
