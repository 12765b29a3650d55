#include "extensions.h"
#include "parts.h"
#include "scene/failure.h"
#include "scene/source/image_bytes.h"
#include "scene/source/source_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace bendy::converter::gltf {
namespace {

/// Reads a texture use; index and texCoord of its JSON object have been checked, the rest not.
TextureUse read_texture_use(const Document& document, const Json* json, const std::string& place) {
    TextureUse use;
    if (json == nullptr) return use;
    use.texture = (*json)["index"].get<std::uint32_t>();
    if (const Json* coords = find(*json, "texCoord"); coords != nullptr) use.coords = coords->get<std::uint32_t>();
    const Json* extensions = find(*json, "extensions");
    if (extensions == nullptr || !extensions->is_object()) return use;
    for (auto extension = extensions->begin(); extension != extensions->end(); ++extension) {
        if (extension.key() != "KHR_texture_transform")
            document.report.warn("kept as JSON, not interpreted: " + key(extension.key()), place + ".extensions");
    }
    const Json* transform = find(*extensions, "KHR_texture_transform");
    if (transform == nullptr) return use;
    const std::string here = place + ".extensions.KHR_texture_transform";
    if (!transform->is_object()) fail(here, "it must be an object");
    const auto number = [&](const Json& value, const std::string& where) {
        constexpr double kMax = std::numeric_limits<float>::max();
        if (!value.is_number() || !(std::abs(value.get<double>()) <= kMax)) fail(where, "expected a finite number");
        return static_cast<float>(value.get<double>());
    };
    const auto read_pair = [&](const char* name, glm::vec2& pair) {
        const Json* value = find(*transform, name);
        if (value == nullptr) return;
        if (!value->is_array() || value->size() != 2) fail(here + '.' + name, "expected an array of two numbers");
        pair = {number((*value)[0], here + '.' + name), number((*value)[1], here + '.' + name)};
    };
    read_pair("offset", use.offset);
    read_pair("scale", use.scale);
    if (const Json* rotation = find(*transform, "rotation"); rotation != nullptr) {
        use.rotation = number(*rotation, here + ".rotation");
    }
    if (const Json* coords = find(*transform, "texCoord"); coords != nullptr) {
        if (!coords->is_number_unsigned() || coords->get<std::uint64_t>() >= kNone) {
            fail(here + ".texCoord", "expected a set number");
        }
        use.coords = coords->get<std::uint32_t>();
    }
    return use;
}

constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";

/// Reads a texture use in an extension, whose JSON is unchecked; nothing if it is faulty.
std::optional<TextureUse> read_unchecked_use(const Document& document, const Json& json, const std::string& place) {
    const auto is_below = [](const Json* number, std::uint64_t end) {
        return number != nullptr && number->is_number_unsigned() && number->get<std::uint64_t>() < end;
    };
    if (!json.is_object() || !is_below(find(json, "index"), document.model.textures.size())) return std::nullopt;
    if (const Json* coords = find(json, "texCoord"); coords != nullptr && !is_below(coords, kNone)) return std::nullopt;
    try {
        return read_texture_use(document, &json, place);
    } catch (const Failure&) {
        return std::nullopt;
    }
}

/// A number from 0 to 1; `usual` if it is missing; nothing if it is faulty.
std::optional<float> read_share(const Json* json, float usual) {
    if (json == nullptr) return usual;
    if (!json->is_number() || !(json->get<double>() >= 0.0 && json->get<double>() <= 1.0)) return std::nullopt;
    return json->get<float>();
}

/// Uses the diffuse colour of KHR_materials_pbrSpecularGlossiness as the base colour of a material without one: readers
/// that do not support the extension would show it white.
/// \return true if the extension is present and valid
bool take_diffuse_colour(const Document& document, const Json& json, const std::string& place, Material& material) {
    const Json* pbr = find(json, "pbrMetallicRoughness");
    if (pbr != nullptr && (pbr->contains("baseColorFactor") || pbr->contains("baseColorTexture"))) return false;
    const Json* extensions = find(json, "extensions");
    const Json* extension =
        extensions != nullptr && extensions->is_object() ? find(*extensions, kSpecularGlossiness) : nullptr;
    if (extension == nullptr || !extension->is_object()) return false;
    glm::vec4 colour(1.0f);
    if (const Json* factor = find(*extension, "diffuseFactor"); factor != nullptr) {
        if (!factor->is_array() || factor->size() != 4) return false;
        for (int i = 0; i < 4; ++i) {
            const auto share = read_share(&(*factor)[static_cast<std::size_t>(i)], 1.0f);
            if (!share) return false;
            colour[i] = *share;
        }
    }
    TextureUse use;
    if (const Json* texture = find(*extension, "diffuseTexture"); texture != nullptr) {
        const auto read =
            read_unchecked_use(document, *texture, place + ".extensions." + kSpecularGlossiness + ".diffuseTexture");
        if (!read) return false;
        use = *read;
    }
    const auto glossiness = read_share(find(*extension, "glossinessFactor"), 1.0f);
    if (!glossiness) return false;
    material.base_colour = colour;
    material.base_colour_texture = use;
    if (pbr == nullptr || !pbr->contains("metallicFactor")) material.metallic = 0.0f;
    // A texture's glossiness varies over the surface: use the roughest value.
    if ((pbr == nullptr || !pbr->contains("roughnessFactor")) && !extension->contains("specularGlossinessTexture"))
        material.roughness = 1.0f - *glossiness;
    document.report.warn(
        std::string(kSpecularGlossiness) +
            " is approximated: its diffuse colour is drawn as the base colour, the rest is kept as JSON",
        place + ".extensions");
    return true;
}

/// The extensions of a material that have no fields, as JSON text.
/// \param approximated  an extension that has its own warning, or empty
std::string keep_extensions(const Document& document, const Json& material, const std::string& place,
                            std::string_view approximated) {
    const Json* extensions = find(material, "extensions");
    if (extensions == nullptr || !extensions->is_object()) return {};
    Json kept = Json::object();
    for (auto extension = extensions->begin(); extension != extensions->end(); ++extension) {
        if (is_interpreted_material_extension(extension.key())) continue;
        kept.emplace(extension.key(), extension.value());
        if (extension.key() == approximated || is_drawn_material_extension(extension.key(), extension.value()))
            continue;
        document.report.warn("kept as JSON, not interpreted: " + key(extension.key()), place + ".extensions");
    }
    return kept.empty() ? std::string() : kept.dump();
}

Material read_material(const Document& document, std::size_t index) {
    const tinygltf::Material& source = document.model.materials[index];
    const Json& json = document.json["materials"][index];
    const std::string place = at("materials", index);
    const auto& pbr = source.pbrMetallicRoughness;
    Material material;
    material.name = source.name;
    for (int i = 0; i < 4; ++i)
        material.base_colour[i] = static_cast<float>(pbr.baseColorFactor[static_cast<std::size_t>(i)]);
    for (int i = 0; i < 3; ++i)
        material.emissive[i] = static_cast<float>(source.emissiveFactor[static_cast<std::size_t>(i)]);
    material.metallic = static_cast<float>(pbr.metallicFactor);
    material.roughness = static_cast<float>(pbr.roughnessFactor);
    material.normal_scale = static_cast<float>(source.normalTexture.scale);
    material.occlusion_strength = static_cast<float>(source.occlusionTexture.strength);
    material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
    material.alpha_mode = source.alphaMode == "MASK"    ? AlphaMode::mask
                          : source.alphaMode == "BLEND" ? AlphaMode::blend
                                                        : AlphaMode::opaque;
    material.double_sided = source.doubleSided;
    const Json* extensions = find(json, "extensions");
    material.unlit = extensions != nullptr && extensions->is_object() && extensions->contains("KHR_materials_unlit");

    const auto use = [&](const Json* owner, const char* name, const std::string& owner_place) {
        return read_texture_use(document, owner == nullptr ? nullptr : find(*owner, name), owner_place + '.' + name);
    };
    const Json* pbr_json = find(json, "pbrMetallicRoughness");
    const std::string pbr_place = place + ".pbrMetallicRoughness";
    material.base_colour_texture = use(pbr_json, "baseColorTexture", pbr_place);
    material.metallic_roughness_texture = use(pbr_json, "metallicRoughnessTexture", pbr_place);
    material.normal_texture = use(&json, "normalTexture", place);
    material.occlusion_texture = use(&json, "occlusionTexture", place);
    material.emissive_texture = use(&json, "emissiveTexture", place);
    const bool is_approximated = take_diffuse_colour(document, json, place, material);
    material.extensions =
        keep_extensions(document, json, place, is_approximated ? kSpecularGlossiness : std::string_view());
    material.extras = extras_text(json);
    return material;
}

Filter filter_of(int code) {
    switch (code) {
        case TINYGLTF_TEXTURE_FILTER_NEAREST:
            return Filter::nearest;
        case TINYGLTF_TEXTURE_FILTER_LINEAR:
            return Filter::linear;
        case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
            return Filter::nearest_mipmap_nearest;
        case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
            return Filter::linear_mipmap_nearest;
        case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
            return Filter::nearest_mipmap_linear;
        case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
            return Filter::linear_mipmap_linear;
        default:
            return Filter::unspecified;
    }
}

Wrap wrap_of(int code) {
    switch (code) {
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Wrap::clamp_to_edge;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Wrap::mirrored_repeat;
        default:
            return Wrap::repeat;
    }
}

Texture read_texture(const Document& document, std::size_t index) {
    const tinygltf::Texture& source = document.model.textures[index];
    const Json& json = document.json["textures"][index];
    Texture texture;
    texture.name = source.name;
    const auto add_image = [&](std::uint32_t image) {
        if (std::find(texture.images.begin(), texture.images.end(), image) == texture.images.end()) {
            texture.images.push_back(image);
        }
    };
    // An extension's image is preferred to the fallback that every reader can show.
    if (const Json* extensions = find(json, "extensions"); extensions != nullptr && extensions->is_object()) {
        for (const char* name : {"KHR_texture_basisu", "EXT_texture_avif", "EXT_texture_webp"}) {
            const Json* extension = find(*extensions, name);
            const Json* image = extension == nullptr ? nullptr : find(*extension, "source");
            if (image != nullptr) add_image(image->get<std::uint32_t>());
        }
    }
    if (source.source >= 0) add_image(static_cast<std::uint32_t>(source.source));
    if (source.sampler >= 0) {
        const tinygltf::Sampler& sampler = document.model.samplers[static_cast<std::size_t>(source.sampler)];
        texture.mag_filter = filter_of(sampler.magFilter);
        texture.min_filter = filter_of(sampler.minFilter);
        texture.wrap_s = wrap_of(sampler.wrapS);
        texture.wrap_t = wrap_of(sampler.wrapT);
    }
    texture.extras = extras_text(json);
    return texture;
}

}  // namespace

void import_materials(const Document& document, Scene& scene) {
    for (std::size_t i = 0; i < document.model.textures.size(); ++i)
        scene.textures.push_back(read_texture(document, i));
    for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
        scene.materials.push_back(read_material(document, i));
    }
}

namespace {

class ImageImporter {
public:
    ImageImporter(const Document& document, bool embed) : document_(document), embed_(embed) {}

    Image import(std::size_t index) const {
        const Json& source = document_.json["images"][index];
        const std::string place = at("images", index);
        Image image;
        if (const Json* name = find(source, "name"); name != nullptr) image.name = name->get<std::string>();
        if (const Json* type = find(source, "mimeType"); type != nullptr) image.media_type = type->get<std::string>();
        const Json* view = find(source, "bufferView");
        const Json* uri = find(source, "uri");
        if (view != nullptr) {
            const auto bytes = document_.buffers.view(view->get<std::size_t>(), document_.budget);
            document_.budget.take(bytes.size(), 1, place);
            image.bytes.assign(bytes.begin(), bytes.end());
        } else if (uri != nullptr) {
            read_uri(uri->text(), place + ".uri", image);
        } else {
            document_.report.warn("image with neither bufferView nor uri", place);
        }
        if (const std::string seen = media_type_of(image.bytes); !seen.empty()) image.media_type = seen;
        return image;
    }

private:
    void read_uri(const std::string& uri, const std::string& place, Image& image) const {
        if (!is_data_uri(uri)) {
            image.uri = without_controls(uri, place, document_.report);
            if (embed_) document_.files.embed(image, place);
            return;
        }
        try {
            DataUri data = decode_data_uri(uri, place);
            if (image.media_type.empty()) image.media_type = std::move(data.media_type);
            image.bytes = std::move(data.bytes);
        } catch (const Failure& failure) {
            // An image does not affect motion: the character is converted without it.
            document_.report.warn("image could not be read (" + failure.error.message + ')', place);
        }
    }

    const Document& document_;
    bool embed_;
};

}  // namespace

void import_images(const Document& document, bool embed, Scene& scene) {
    const ImageImporter importer(document, embed);
    for (std::size_t i = 0; i < array_of(document.json, "images").size(); ++i)
        scene.images.push_back(importer.import(i));
}

}  // namespace bendy::converter::gltf
