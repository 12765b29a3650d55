#include "materials.h"

#include "display_colour.h"
#include "encoded_text.h"
#include "failure.h"
#include "source/media_type.h"
#include "source/read_file.h"
#include "source/uri.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>

namespace bendy::converter::x {
namespace {

constexpr float kMostPower = 1e6f;

/// A file name as writers on Windows leave it: backslashes, doubled ones, often the whole path.
std::filesystem::path path_of(const std::string& name) {
    std::string path = to_utf8(name);
    std::replace(path.begin(), path.end(), '\\', '/');
    const bool is_absolute = path.starts_with('/') || path.find(':') != std::string::npos;
    if (is_absolute) path.erase(0, path.find_last_of("/:") + 1);
    return std::filesystem::path(std::u8string(path.begin(), path.end())).lexically_normal();
}

class MaterialImporter {
public:
    MaterialImporter(const std::filesystem::path& file, bool embed_images, Scene& scene, Report& report)
        : file_(file), embed_images_(embed_images), scene_(scene), report_(report) {}

    void import(const Material& source) {
        converter::Material material;
        material.name = source.name;
        material.base_colour = to_light(source.colour);
        material.metallic = 0.0f;
        material.roughness = roughness_of(source.power);
        material.emissive = to_light(source.emissive);
        if (source.colour.w < 1.0f) material.alpha_mode = AlphaMode::blend;
        if (source.specular != glm::vec3(0.0f) && source.specular != glm::vec3(to_display(kDielectric)))
            report_.warn("specular colour of a material left out, its power is kept as roughness", source.place);
        if (!source.texture.empty()) material.base_colour_texture.texture = texture_of(source);
        // Direct3D multiplies all light with the texture, the surface's own too.
        if (source.emissive != glm::vec3(0.0f))
            material.emissive_texture.texture = material.base_colour_texture.texture;
        scene_.materials.push_back(std::move(material));
    }

private:
    std::uint32_t texture_of(const Material& source) {
        const auto number = static_cast<std::uint32_t>(scene_.textures.size());
        const auto [known, is_new] = texture_of_.try_emplace(source.texture, number);
        if (!is_new) return known->second;
        Image image;
        image.uri = uri_of(path_of(source.texture));
        if (embed_images_) embed(image, source.place);
        Texture texture;
        texture.images.push_back(static_cast<std::uint32_t>(scene_.images.size()));
        scene_.images.push_back(std::move(image));
        scene_.textures.push_back(std::move(texture));
        return number;
    }

    void embed(Image& image, const std::string& place) {
        try {
            const auto file = resolve_uri(image.uri, file_, place);
            report_.add_source(file);
            image.bytes = read_file(file, place);
            image.media_type = media_type_of(image.bytes);
            image.uri.clear();
        } catch (const Failure& failure) {  // the character converts without it
            report_.warn("image could not be read (" + failure.error.message + ')', place);
        }
    }

    const std::filesystem::path& file_;
    bool embed_images_;
    Scene& scene_;
    Report& report_;
    std::unordered_map<std::string, std::uint32_t> texture_of_;  ///< by file name
};

}  // namespace

float roughness_of(float power) {
    return std::sqrt(std::sqrt(2.0f / (std::clamp(power, 0.0f, kMostPower) + 2.0f)));
}

float power_of(float roughness) {
    const float square = roughness * roughness;
    const float power = 2.0f / std::max(square * square, 1e-9f) - 2.0f;
    return std::clamp(power, 0.0f, kMostPower);
}

void import_materials(const XFile& source, const std::filesystem::path& file, bool embed_images, Scene& scene,
                      Report& report) {
    MaterialImporter importer(file, embed_images, scene, report);
    for (const Material& material : source.materials) importer.import(material);
}

}  // namespace bendy::converter::x
