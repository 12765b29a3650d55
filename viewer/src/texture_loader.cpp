#include "texture_loader.h"

#include "image_reader.h"
#include "texture_units.h"

#include <bendy/format/file.h>
#include <bendy/viewer/linked_file.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::viewer {
namespace {

/// Of all textures together: half a gigabyte.
constexpr std::uint64_t kMostTexels = 1u << 27u;

void upload_pixels(GLuint texture, const Picture& picture, bool srgb) {
    glActiveTexture(GL_TEXTURE0 + kUploadUnit);
    glBindTexture(GL_TEXTURE_2D, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, static_cast<GLsizei>(picture.width),
                 static_cast<GLsizei>(picture.height), 0, GL_RGBA, GL_UNSIGNED_BYTE, picture.pixels.data());
}

void set_parameter(GLenum what, GLint value) {
    glTexParameteri(GL_TEXTURE_2D, what, value);
}

GLint wrap_of(std::uint8_t wrap) {
    constexpr std::array<GLint, kWraps> kAll{GL_REPEAT, GL_CLAMP_TO_EDGE, GL_MIRRORED_REPEAT};
    return kAll.at(wrap);
}

void set_sampler(const SamplerRecord& sampler) {
    constexpr std::array<GLint, kMinFilters> kFilters{GL_LINEAR_MIPMAP_LINEAR,
                                                      GL_NEAREST,
                                                      GL_LINEAR,
                                                      GL_NEAREST_MIPMAP_NEAREST,
                                                      GL_LINEAR_MIPMAP_NEAREST,
                                                      GL_NEAREST_MIPMAP_LINEAR,
                                                      GL_LINEAR_MIPMAP_LINEAR};
    set_parameter(GL_TEXTURE_MIN_FILTER, kFilters.at(sampler.min_filter));
    set_parameter(GL_TEXTURE_MAG_FILTER,
                  static_cast<Filter>(sampler.mag_filter) == Filter::nearest ? GL_NEAREST : GL_LINEAR);
    set_parameter(GL_TEXTURE_WRAP_S, wrap_of(sampler.wrap_s));
    set_parameter(GL_TEXTURE_WRAP_T, wrap_of(sampler.wrap_t));
    if (sampler.min_filter == 0 || sampler.min_filter >= static_cast<std::uint8_t>(Filter::nearest_mipmap_nearest))
        glGenerateMipmap(GL_TEXTURE_2D);
}

}  // namespace

TextureLoader::TextureLoader(const Model& model, std::filesystem::path folder, Warn warn)
    : model_(&model), folder_(std::move(folder)), warn_(std::move(warn)), pixels_left_(kMostTexels) {
    constexpr std::uint8_t kLight = 170;
    constexpr std::uint8_t kDark = 110;
    upload_pixels(white_.name(), {1, 1, {255, 255, 255, 255}}, false);
    set_sampler({});
    Picture check{8, 8, {}};
    for (unsigned k = 0; k < 64; ++k) {
        const std::uint8_t grey = ((k / 8 + k) & 1u) != 0 ? kLight : kDark;
        check.pixels.insert(check.pixels.end(), {grey, grey, grey, 255});
    }
    upload_pixels(check_.name(), check, true);
    SamplerRecord coarse;
    coarse.mag_filter = static_cast<std::uint8_t>(Filter::nearest);
    set_sampler(coarse);
}

void TextureLoader::load(std::uint32_t number, bool srgb) {
    const auto all = model_->textures();
    if (number >= all.size()) return;
    const auto [entry, is_new] = loaded_.try_emplace({number, srgb});
    if (!is_new) return;
    std::string problem = "has no image";
    for (const ImageView& image : all[number].images) {
        const ImageView& source = image.same ? all[image.same->texture].images[image.same->image] : image;
        GlTexture texture;
        if (!upload(number, source, srgb, texture, problem)) continue;
        entry->second = std::move(texture);
        return;
    }
    warn_("texture " + std::to_string(number) + " cannot be shown: " + problem);
}

std::optional<GLuint> TextureLoader::texture(std::uint32_t number, bool srgb) const {
    const auto found = loaded_.find({number, srgb});
    if (found == loaded_.end() || !found->second) return std::nullopt;
    return found->second->name();
}

bool TextureLoader::upload(std::uint32_t number, const ImageView& image, bool srgb, GlTexture& texture,
                           std::string& problem) {
    MappedFile linked;
    Bytes bytes = image.bytes;
    if (bytes.empty()) {
        const auto path = linked_file(folder_, image.uri);
        problem = "its image is not in this file, and is not read from outside its folder";
        if (!path) return false;
        auto opened = MappedFile::open(*path);
        problem = "its image " + path->string() + " cannot be read";
        if (!opened) return false;
        linked = *std::move(opened);
        bytes = linked.bytes();
    }
    const ReadImage read = read_image(bytes, pixels_left_);
    if (!read.problem.empty()) {
        problem = "its image " + read.problem;
        return false;
    }
    pixels_left_ -= std::uint64_t{read.picture.width} * read.picture.height;
    upload_pixels(texture.name(), read.picture, srgb);
    set_sampler(model_->textures()[number].sampler);
    return true;
}

}  // namespace bendy::viewer
