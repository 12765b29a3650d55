#include "materials.h"

#include "image_reader.h"

#include <bendy/format/file.h>

#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace bendy::viewer {
namespace {

/// Returns a number of an extension; nothing if it is not a finite number of at least 0.
std::optional<float> number_of(const nlohmann::json& value) {
    if (!value.is_number()) return std::nullopt;
    const auto number = value.get<float>();
    return std::isfinite(number) && number >= 0.0f ? std::optional(number) : std::nullopt;
}

nlohmann::json member(const nlohmann::json& object, const char* key) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? nlohmann::json() : *found;
}

ShownSurface shown_surface(const MaterialView& material) {
    ShownSurface surface{material.surface};
    if (material.extensions.empty()) return surface;
    const auto extensions = nlohmann::json::parse(material.extensions, nullptr, false);
    const float strength =
        number_of(member(member(extensions, "KHR_materials_emissive_strength"), "emissiveStrength")).value_or(1.0f);
    for (float& colour : surface.record.emissive) colour *= strength;

    // 0 represents an infinite index: everything is reflected.
    const float ior = number_of(member(member(extensions, "KHR_materials_ior"), "ior")).value_or(1.5f);
    const float from_ahead = ior == 0.0f ? 1.0f : (ior - 1.0f) / (ior + 1.0f);
    const nlohmann::json specular = member(extensions, "KHR_materials_specular");
    glm::vec3 colour(1.0f);
    const nlohmann::json factors = member(specular, "specularColorFactor");
    for (int k = 0; k < 3 && factors.is_array() && factors.size() == 3; ++k)
        colour[k] = number_of(factors[static_cast<std::size_t>(k)]).value_or(1.0f);
    surface.dielectric_at_grazing = std::min(number_of(member(specular, "specularFactor")).value_or(1.0f), 1.0f);
    surface.dielectric = glm::min(from_ahead * from_ahead * colour, glm::vec3(1.0f)) * surface.dielectric_at_grazing;
    return surface;
}

/// For all textures together: half a gigabyte.
constexpr std::uint64_t kMostTexels = 1u << 27u;

void upload_pixels(GLuint texture, const Picture& picture, bool srgb) {
    bind_texture(kUploadUnit, GL_TEXTURE_2D, texture);
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

std::vector<ShownSurface> shown_surfaces(const Model& model) {
    std::vector<ShownSurface> surfaces;
    for (const MaterialView& material : model.materials()) surfaces.push_back(shown_surface(material));
    surfaces.emplace_back();
    return surfaces;
}

TextureLoader::TextureLoader(const Model& model, ReadableFolders folders, Warn warn)
    : model_(&model), folders_(std::move(folders)), warn_(std::move(warn)), pixels_left_(kMostTexels) {
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
        const auto path = folders_.find(image.uri);
        problem = "its image is not in this file";
        if (!path && path.error() == LinkProblem::control)
            problem += ", and its link, which holds a control character, is not followed";
        if (!path && path.error() == LinkProblem::outside)
            problem += ", and is not read from outside its folder: --root FOLDER allows a folder that it is in";
        if (!path) return false;
        auto opened = MappedFile::read(*path);
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
