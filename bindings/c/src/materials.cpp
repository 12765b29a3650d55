// Materials, textures, and the images of textures.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"

#include <algorithm>

namespace bendy::capi {
namespace {

/// Describes an image, or the image of another texture that it shares.
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

bendy_status bendy::capi::get_material(const bendy_model* model, uint32_t material, bendy_material& out,
                                       bendy_error* /*error*/) {
    const Names& names = model->character->names;
    to_c(model->get().materials()[material].surface, out);
    out.name = names.materials[material].c_str();
    out.extensions = names.material_extensions[material].c_str();
    put_json(names.material_json[material], out);
    return BENDY_OK;
}

bendy_status bendy::capi::get_texture(const bendy_model* model, uint32_t texture, bendy_texture& out,
                                      bendy_error* /*error*/) {
    const bendy::Texture& view = model->get().textures()[texture];
    to_c(view.sampler, out);
    out.name = model->character->names.textures[texture].c_str();
    out.images = static_cast<std::uint32_t>(view.images.size());
    put_json(model->character->names.texture_json[texture], out);
    return BENDY_OK;
}

bendy_status bendy::capi::get_image(const bendy_model* model, uint32_t texture, uint32_t image, bendy_image& out,
                                    bendy_error* /*error*/) {
    describe_image(*model->character, texture, image, out);
    return BENDY_OK;
}
