// Materials, textures, and the images of textures.
#include "fail.h"
#include "handles.h"
#include "lookup.h"

#include <algorithm>

namespace bendy::capi {
namespace {

bendy_texture_use to_c(const TextureUseRecord& use) {
    return {use.texture, use.coords, {use.offset[0], use.offset[1]}, {use.scale[0], use.scale[1]}, use.rotation};
}

void describe_surface(const SurfaceRecord& surface, bendy_material& out) {
    out.metallic = surface.metallic;
    out.roughness = surface.roughness;
    std::copy(surface.base_colour.begin(), surface.base_colour.end(), out.base_colour);
    std::copy(surface.emissive.begin(), surface.emissive.end(), out.emissive);
    out.double_sided = surface.double_sided != 0 ? 1 : 0;
    out.normal_scale = surface.normal_scale;
    out.occlusion_strength = surface.occlusion_strength;
    out.alpha_cutoff = surface.alpha_cutoff;
    out.alpha_mode = surface.alpha_mode;
    out.unlit = surface.unlit != 0 ? 1 : 0;
    out.base_colour_texture = to_c(surface.base_colour_texture);
    out.metallic_roughness_texture = to_c(surface.metallic_roughness_texture);
    out.normal_texture = to_c(surface.normal_texture);
    out.occlusion_texture = to_c(surface.occlusion_texture);
    out.emissive_texture = to_c(surface.emissive_texture);
}

/// Describes an image, or the image of another texture that it refers to.
void describe_image(const Character& character, std::uint32_t texture, std::uint32_t image, bendy_image& out) {
    const auto textures = character.model.textures();
    if (const auto& same = textures[texture].images[image].same) {
        texture = same->texture;
        image = same->image;
    }
    const ImageView& view = textures[texture].images[image];
    out.texture = texture;
    out.image = image;
    if (view.bytes.data() == nullptr) {
        out.uri = character.names.uris[texture][image].c_str();
        return;
    }
    out.media = static_cast<std::uint32_t>(view.media);
    out.bytes = view.bytes.data();
    out.byte_count = view.bytes.size();
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy_get_material(const bendy_model* model, uint32_t material, bendy_material* out, bendy_error* error) {
    return get(model, &Names::materials, "material", material, out, error,
               [&](const bendy::Model& from, bendy_material& value) {
                   describe_surface(from.materials()[material].surface, value);
                   value.extensions = model->character->names.material_extensions[material].c_str();
                   put_json(model->character->names.material_json[material], value);
               });
}

bendy_status bendy_get_texture(const bendy_model* model, uint32_t texture, bendy_texture* out, bendy_error* error) {
    return get(model, &Names::textures, "texture", texture, out, error,
               [&](const bendy::Model& from, bendy_texture& value) {
                   const bendy::Texture& view = from.textures()[texture];
                   value.images = static_cast<std::uint32_t>(view.images.size());
                   value.mag_filter = view.sampler.mag_filter;
                   value.min_filter = view.sampler.min_filter;
                   value.wrap_s = view.sampler.wrap_s;
                   value.wrap_t = view.sampler.wrap_t;
                   put_json(model->character->names.texture_json[texture], value);
               });
}

bendy_status bendy_get_image(const bendy_model* model, uint32_t texture, uint32_t image, bendy_image* out,
                             bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        const auto textures = model->get().textures();
        if (const bendy_status status = check_index(texture, textures.size(), "texture", error)) return status;
        if (const bendy_status status =
                check_index(image, textures[texture].images.size(), "image", error, "the texture"))
            return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        bendy_image value{};
        describe_image(*model->character, texture, image, value);
        put(*out, value);
        return BENDY_OK;
    });
}
