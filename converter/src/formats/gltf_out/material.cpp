#include "formats/gltf_out/parts.h"
#include "scene/failure.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <unordered_map>
#include <utility>

namespace bendy::converter::gltf_out {
namespace {

template <class Vector>
Json list_of(const Vector& vector) {
    return json_numbers({glm::value_ptr(vector), static_cast<std::size_t>(Vector::length())});
}

Json write_use(const TextureUse& use) {
    Json written{{"index", use.texture}};
    if (use.coords != 0) written["texCoord"] = use.coords;
    const TextureUse usual;
    Json transform = Json::object();
    if (use.offset != usual.offset) transform["offset"] = list_of(use.offset);
    if (use.rotation != usual.rotation) transform["rotation"] = json_number(use.rotation);
    if (use.scale != usual.scale) transform["scale"] = list_of(use.scale);
    if (!transform.empty()) written["extensions"]["KHR_texture_transform"] = std::move(transform);
    return written;
}

/// Adds a number unless it has glTF's default value.
void add_number(Json& object, const char* member, float value, float usual) {
    if (value != usual) object[member] = json_number(value);
}

const char* alpha_name(AlphaMode mode) {
    return mode == AlphaMode::mask ? "MASK" : mode == AlphaMode::blend ? "BLEND" : "OPAQUE";
}

Json write_material(const Material& material, const extensions::NewNumber& numbers, const std::string& place,
                    Report& report) {
    const Material usual;
    Json written = Json::object();
    if (!material.name.empty()) written["name"] = material.name;
    Json pbr = Json::object();
    if (material.base_colour != usual.base_colour) pbr["baseColorFactor"] = list_of(material.base_colour);
    add_number(pbr, "metallicFactor", material.metallic, usual.metallic);
    add_number(pbr, "roughnessFactor", material.roughness, usual.roughness);
    const auto add_use = [&](Json& owner, const char* member, const TextureUse& use) {
        if (use.texture == kNone) return;
        constexpr std::uint32_t kMostCoords = 0x7fffffff;  // largest integer that glTF readers accept
        if (use.coords > kMostCoords) {
            report.warn("texture left out: glTF has no set " + std::to_string(use.coords) + " of texture coordinates",
                        place + '.' + member);
            return;
        }
        owner[member] = write_use(use);
    };
    add_use(pbr, "baseColorTexture", material.base_colour_texture);
    add_use(pbr, "metallicRoughnessTexture", material.metallic_roughness_texture);
    if (!pbr.empty()) written["pbrMetallicRoughness"] = std::move(pbr);
    add_use(written, "normalTexture", material.normal_texture);
    add_use(written, "occlusionTexture", material.occlusion_texture);
    add_use(written, "emissiveTexture", material.emissive_texture);
    if (written.contains("normalTexture"))
        add_number(written["normalTexture"], "scale", material.normal_scale, usual.normal_scale);
    if (written.contains("occlusionTexture"))
        add_number(written["occlusionTexture"], "strength", material.occlusion_strength, usual.occlusion_strength);
    if (material.emissive != usual.emissive) written["emissiveFactor"] = list_of(material.emissive);
    add_number(written, "alphaCutoff", material.alpha_cutoff, usual.alpha_cutoff);
    if (material.alpha_mode != usual.alpha_mode ||
        written.contains("alphaCutoff"))  // glTF allows it only together with a mode
        written["alphaMode"] = alpha_name(material.alpha_mode);
    if (material.double_sided) written["doubleSided"] = true;
    add_extras(written, material.extras, place, report);
    add_extensions(written, material.extensions, extensions::Host::material, numbers, place, report);
    if (material.unlit) written["extensions"]["KHR_materials_unlit"] = Json::object();
    add_members(written, read_members(material.more, place, report), gltf::Element::material, place, report);
    return written;
}

/// glTF's codes, which are OpenGL's.
int code_of(Filter filter) {
    constexpr std::array kCodes{0, 9728, 9729, 9984, 9985, 9986, 9987};
    return kCodes[static_cast<std::size_t>(filter)];
}

int code_of(Wrap wrap) {
    constexpr std::array kCodes{10497, 33071, 33648};
    return kCodes[static_cast<std::size_t>(wrap)];
}

Json write_sampler(const Texture& texture) {
    Json sampler = Json::object();
    if (texture.mag_filter == Filter::nearest || texture.mag_filter == Filter::linear)
        sampler["magFilter"] = code_of(texture.mag_filter);
    if (texture.min_filter != Filter::unspecified) sampler["minFilter"] = code_of(texture.min_filter);
    if (texture.wrap_s != Wrap::repeat) sampler["wrapS"] = code_of(texture.wrap_s);
    if (texture.wrap_t != Wrap::repeat) sampler["wrapT"] = code_of(texture.wrap_t);
    return sampler;
}

/// The extension by which a texture refers to an image of this type; null if it needs none.
const char* extension_of(const std::string& media_type) {
    if (media_type == "image/ktx2") return "KHR_texture_basisu";
    if (media_type == "image/webp") return "EXT_texture_webp";
    if (media_type == "image/avif") return "EXT_texture_avif";
    return nullptr;
}

class MaterialExporter {
public:
    MaterialExporter(const Scene& scene, const extensions::NewNumber& numbers, Json& root, Buffer& buffer,
                     Report& report)
        : scene_(scene), numbers_(numbers), root_(root), buffer_(buffer), report_(report) {}

    void run() {
        for (std::size_t i = 0; i < scene_.images.size(); ++i) root_["images"].push_back(write_image(i));
        for (std::size_t i = 0; i < scene_.textures.size(); ++i) root_["textures"].push_back(write_texture(i));
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
            root_["materials"].push_back(write_material(scene_.materials[i], numbers_, at("materials", i), report_));
            if (scene_.materials[i].joint != kNone) report_.warn(std::string(kOwnMaterialShared), at("materials", i));
        }
    }

private:
    Json write_image(std::size_t index) {
        const Image& image = scene_.images[index];
        Json written = Json::object();
        if (!image.name.empty()) written["name"] = image.name;
        if (!image.bytes.empty()) {
            written["bufferView"] = buffer_.add_bytes(image.bytes);
            written["mimeType"] = image.media_type.empty() ? "application/octet-stream" : image.media_type;
            if (image.media_type.empty())
                report_.warn("image of a kind that glTF does not know, written as it is", at("images", index));
        } else {
            written["uri"] = image.uri;
            if (!image.media_type.empty()) written["mimeType"] = image.media_type;
        }
        return written;
    }

    Json write_texture(std::size_t index) {
        const Texture& texture = scene_.textures[index];
        Json written = Json::object();
        if (!texture.name.empty()) written["name"] = texture.name;
        for (const std::uint32_t image : texture.images) add_image(written, image, index);
        const std::string place = at("textures", index);
        const Json more = read_members(texture.more, place, report_);
        Json sampler = write_sampler(texture);
        if (const auto said = more.find("sampler"); said != more.end())
            add_members(sampler, *said, gltf::Element::sampler, place + ".sampler", report_);
        if (!sampler.empty()) written["sampler"] = sampler_number(sampler);
        if (const auto said = more.find("source"); said != more.end() && said->is_array())
            add_to_images(texture, *said, place);
        if (written.contains("extensions") && !written.contains("source")) required_of(written["extensions"]);
        add_extras(written, texture.extras, place, report_);
        add_members(written, more, gltf::Element::texture, place, report_);
        return written;
    }

    /// Adds a texture's members for its images, in their order.
    void add_to_images(const Texture& texture, const Json& said, const std::string& place) {
        for (std::size_t i = 0; i < std::min(texture.images.size(), said.size()); ++i)
            add_members(root_["images"][texture.images[i]], said[i], gltf::Element::image, place + ".source", report_);
    }

    void add_image(Json& texture, std::uint32_t image, std::size_t index) {
        const char* extension = extension_of(scene_.images[image].media_type);
        if (extension != nullptr && !(texture.contains("extensions") && texture["extensions"].contains(extension))) {
            texture["extensions"][extension]["source"] = image;
        } else if (!texture.contains("source")) {
            texture["source"] = image;
        } else {
            report_.warn("further image of a texture left out", at("textures", index));
        }
    }

    std::size_t sampler_number(const Json& sampler) {
        const auto [known, is_new] = samplers_.try_emplace(sampler.dump(), samplers_.size());
        if (is_new) root_["samplers"].push_back(sampler);
        return known->second;
    }

    /// Marks extensions as required for a texture that has no other image.
    void required_of(const Json& extensions) {
        Json& required = root_["extensionsRequired"];
        for (const auto& [name, value] : extensions.items()) {
            if (std::find(required.begin(), required.end(), name) == required.end()) required.push_back(name);
        }
    }

    const Scene& scene_;
    const extensions::NewNumber& numbers_;
    Json& root_;
    Buffer& buffer_;
    Report& report_;
    std::unordered_map<std::string, std::size_t> samplers_;  ///< by their JSON text
};

}  // namespace

void export_materials(const Scene& scene, const extensions::NewNumber& numbers, Json& root, Buffer& buffer,
                      Report& report) {
    MaterialExporter(scene, numbers, root, buffer, report).run();
}

}  // namespace bendy::converter::gltf_out
