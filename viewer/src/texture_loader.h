#pragma once

#include "gl_object.h"

#include <bendy/runtime.h>
#include <bendy/viewer/render.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>

namespace bendy::viewer {

/// A model's textures in the graphics processor's memory, each loaded when it is first asked for.
class TextureLoader {
public:
    /// `folder`: where images that the file only names are looked for; nothing outside it is read. Empty: nowhere.
    TextureLoader(const Model& model, std::filesystem::path folder, Warn warn);

    /// The texture of that number, as sRGB or as plain numbers. White for kNone; a grey check, and one warning, for one
    /// that cannot be shown.
    GLuint texture(std::uint32_t number, bool srgb);

private:
    GLuint load(std::uint32_t number, bool srgb);
    bool upload(std::uint32_t number, const ImageView& image, bool srgb, GlTexture& texture, std::string& problem);

    const Model* model_;
    std::filesystem::path folder_;
    Warn warn_;
    GlTexture white_;
    GlTexture check_;
    std::map<std::pair<std::uint32_t, bool>, GlTexture> loaded_;
    std::map<std::pair<std::uint32_t, bool>, GLuint> names_;
    std::uint64_t pixels_left_;
};

}  // namespace bendy::viewer
