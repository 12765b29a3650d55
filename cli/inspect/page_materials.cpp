#include "inspect/page_materials.h"

#include "inspect/page_number.h"
#include "terminal/text.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostListed = 1'000;  // textures; materials
constexpr std::size_t kMostUses = 50;       // of a texture

struct Use {
    std::string_view slot;
    const TextureUseRecord* record;
};

std::array<Use, 5> uses_of(const SurfaceRecord& surface) {
    return {{{"base colour", &surface.base_colour_texture},
             {"metallic-roughness", &surface.metallic_roughness_texture},
             {"normal", &surface.normal_texture},
             {"occlusion", &surface.occlusion_texture},
             {"emissive", &surface.emissive_texture}}};
}

template <std::size_t N>
std::string_view name_of(const std::array<std::string_view, N>& names, std::size_t number) {
    return number < N ? names[number] : "?";
}

std::string sampler_text(const SamplerRecord& sampler) {
    constexpr std::array<std::string_view, kMinFilters> kFilters{
        "unspecified",         "nearest",           "linear", "nearest, mip nearest", "linear, mip nearest",
        "nearest, mip linear", "linear, mip linear"};
    constexpr std::array<std::string_view, kWraps> kWrapNames{"repeats", "clamped", "mirrored"};
    std::string text = "magnified " + std::string(name_of(kFilters, sampler.mag_filter));
    text.append("; minified ").append(name_of(kFilters, sampler.min_filter));
    text.append("; S ").append(name_of(kWrapNames, sampler.wrap_s));
    text.append(", T ").append(name_of(kWrapNames, sampler.wrap_t));
    return text;
}

Json image_json(const ImageView& image, std::size_t& budget) {
    constexpr std::array<std::string_view, kMediaTypes> kNames{"other", "PNG", "JPEG", "KTX2", "WebP", "AVIF"};
    constexpr std::array<std::string_view, kMediaTypes> kShown{"", "image/png",  "image/jpeg",
                                                               "", "image/webp", "image/avif"};
    if (image.same) return {{"same", image.same->texture}};
    if (image.bytes.empty() && !image.uri.empty()) return {{"uri", brief(image.uri)}};
    const auto media = static_cast<std::size_t>(image.media);
    Json json{{"media", name_of(kNames, media)}, {"bytes", image.bytes.size()}};
    if (name_of(kShown, media).empty() || media >= kMediaTypes) {
        json["why"] = "browsers do not show this kind";
    } else if (image.bytes.size() > budget) {
        json["why"] = "not embedded: the page holds up to 32 MiB of images";
    } else {
        budget -= image.bytes.size();
        json["src"] = data_uri(kShown[media], image.bytes);
    }
    return json;
}

/// Material and slot of each texture's uses.
std::vector<Json> uses_by_texture(const Document& document) {
    std::vector<Json> uses(document.textures.size(), Json::array());
    for (std::size_t number = 0; number < document.materials.size(); ++number) {
        for (const Use& use : uses_of(document.materials[number].surface)) {
            if (use.record->texture < uses.size() && uses[use.record->texture].size() < kMostUses)
                uses[use.record->texture].push_back({number, use.slot});
        }
    }
    return uses;
}

}  // namespace

std::string data_uri(std::string_view media_type, Bytes bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text("data:");
    text.append(media_type).append(";base64,");
    text.reserve(text.size() + (bytes.size() + 2) / 3 * 4);
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        const std::size_t left = bytes.size() - at;
        std::uint32_t group = 0;
        for (std::size_t i = 0; i < 3; ++i)
            group = group << 8u | (i < left ? std::to_integer<std::uint32_t>(bytes[at + i]) : 0u);
        for (std::size_t i = 0; i < 4; ++i) text += i <= left ? kDigits[group >> (18 - 6 * i) & 63u] : '=';
    }
    return text;
}

Json page_textures(const Document& document) {
    std::vector<Json> uses = uses_by_texture(document);
    std::size_t budget = kMostImageBytes;
    Json list = Json::array();
    for (std::size_t number = 0; number < document.textures.size() && number < kMostListed; ++number) {
        const TextureView& texture = document.textures[number];
        Json images = Json::array();
        for (const ImageView& image : texture.images) images.push_back(image_json(image, budget));
        list.push_back({{"name", brief(texture.name)},
                        {"chunk", texture.chunk},
                        {"sampler", sampler_text(texture.sampler)},
                        {"images", std::move(images)},
                        {"uses", std::move(uses[number])}});
    }
    return {{"total", document.textures.size()}, {"list", std::move(list)}};
}

Json page_materials(const Document& document) {
    constexpr std::array<std::string_view, kAlphaModes> kAlpha{"opaque", "mask", "blend"};
    Json list = Json::array();
    for (const MaterialView& material : document.materials) {
        if (list.size() == kMostListed) break;
        const SurfaceRecord& surface = material.surface;
        Json textures = Json::array();
        for (const Use& use : uses_of(surface)) {
            if (use.record->texture == kNone) continue;
            textures.push_back({use.slot, use.record->texture, use.record->coords});
        }
        std::string alpha(name_of(kAlpha, surface.alpha_mode));
        if (alpha == "mask") alpha += ", cut-off " + brief(surface.alpha_cutoff);
        list.push_back({{"name", brief(material.name)},
                        {"chunk", material.chunk},
                        {"base", page_numbers(surface.base_colour)},
                        {"emissive", page_numbers(surface.emissive)},
                        {"metallic", page_number(surface.metallic)},
                        {"roughness", page_number(surface.roughness)},
                        {"normalScale", page_number(surface.normal_scale)},
                        {"occlusion", page_number(surface.occlusion_strength)},
                        {"alpha", alpha},
                        {"doubleSided", surface.double_sided != 0},
                        {"unlit", surface.unlit != 0},
                        {"textures", std::move(textures)},
                        {"extensions", brief(material.extensions)}});
    }
    return {{"total", document.materials.size()}, {"list", std::move(list)}};
}

}  // namespace bendy::cli
