#include <bendy/format/material.h>

#include <bendy/format/read_record.h>
#include <bendy/format/text.h>

#include <cstddef>

namespace bendy {

MaterialView read_material(const ChunkTree& tree, std::uint32_t chunk, std::uint32_t textures, Faults& faults) {
    MaterialView material;
    material.chunk = chunk;
    material.name = read_text(tree, chunk, FourCC("NAME"), faults);
    material.extensions = read_text(tree, chunk, FourCC("EXTN"), faults);
    material.extras = read_text(tree, chunk, FourCC("EXTR"), faults);
    material.more = read_text(tree, chunk, FourCC("MORE"), faults);
    material.surface = read_child_record<SurfaceRecord>(tree, chunk, FourCC("SURF"), faults).value_or(SurfaceRecord{});

    const std::uint64_t offset = offset_of(tree, chunk, FourCC("SURF"));
    SurfaceRecord& surface = material.surface;
    if (!check_enum(surface.alpha_mode, kAlphaModes, offset, faults)) surface.alpha_mode = 0;
    check_enum(surface.double_sided, 2, offset, faults);
    check_enum(surface.unlit, 2, offset, faults);
    check_reserved(surface.reserved, offset, faults);
    for (TextureUseRecord* use : {&surface.base_colour_texture, &surface.metallic_roughness_texture,
                                  &surface.normal_texture, &surface.occlusion_texture, &surface.emissive_texture}) {
        check_reserved(std::array{use->reserved}, offset, faults);
        if (use->texture == kNone || use->texture < textures) continue;
        faults.add({ErrorCode::kTextureRange, offset, use->texture, textures});
        use->texture = kNone;
    }
    return material;
}

TextureView read_texture(const ChunkTree& tree, std::uint32_t chunk, Faults& faults) {
    TextureView texture;
    texture.chunk = chunk;
    texture.name = read_text(tree, chunk, FourCC("NAME"), faults);
    texture.extras = read_text(tree, chunk, FourCC("EXTR"), faults);
    texture.more = read_text(tree, chunk, FourCC("MORE"), faults);
    texture.sampler = read_child_record<SamplerRecord>(tree, chunk, FourCC("SAMP"), faults).value_or(SamplerRecord{});
    SamplerRecord& sampler = texture.sampler;
    const std::uint64_t offset = offset_of(tree, chunk, FourCC("SAMP"));
    if (!check_enum(sampler.mag_filter, kMagFilters, offset, faults)) sampler.mag_filter = 0;
    if (!check_enum(sampler.min_filter, kMinFilters, offset, faults)) sampler.min_filter = 0;
    if (!check_enum(sampler.wrap_s, kWraps, offset, faults)) sampler.wrap_s = 0;
    if (!check_enum(sampler.wrap_t, kWraps, offset, faults)) sampler.wrap_t = 0;

    for (const std::uint32_t number : tree.children(chunk)) {
        const Chunk& child = tree[number];
        if (child.is_container()) continue;
        ImageView image;
        image.chunk = number;
        if (child.id == FourCC("IMAG")) {
            const Result<ImageRecord> record = read_record<ImageRecord>(tree, number);
            if (!record) {
                faults.add(record.error());
                continue;
            }
            check_reserved(record->reserved, child.offset, faults);
            if (!check_enum(record->media, kMediaTypes, child.offset, faults)) continue;
            image.media = static_cast<MediaType>(record->media);
            image.bytes = tree.payload(number).subspan(sizeof(ImageRecord));
        } else if (child.id == FourCC("LINK")) {
            if (const auto fault = tree.encoding_fault(number)) {
                faults.add(*fault);
                continue;
            }
            image.uri = as_text(tree.payload(number));
            if (!is_utf8(image.uri)) {
                faults.add({ErrorCode::kNotUtf8, child.offset});
                continue;
            }
        } else if (child.id == FourCC("SAME")) {
            const Result<SameRecord> record = read_record<SameRecord>(tree, number);
            if (!record) {
                faults.add(record.error());
                continue;
            }
            image.same = *record;
        } else {
            continue;
        }
        texture.images.push_back(image);
    }
    return texture;
}

void check_texture_references(const ChunkTree& tree, std::vector<TextureView>& textures, Faults& faults) {
    for (const TextureView& texture : textures) {
        for (const ImageView& image : texture.images) {
            if (!image.same) continue;
            const SameRecord& same = *image.same;
            const std::uint64_t offset = tree[image.chunk].offset;
            if (same.texture >= textures.size()) {
                faults.add({ErrorCode::kTextureRange, offset, same.texture, textures.size()});
            } else if (same.image >= textures[same.texture].images.size() ||
                       textures[same.texture].images[same.image].same.has_value()) {
                faults.add({ErrorCode::kIndexRange, offset, same.image, textures[same.texture].images.size()});
            }
        }
    }
}

std::string mime_type(MediaType media) {
    if (media == MediaType::other) return {};
    return std::string("image/").append(kValueNames<MediaType>[static_cast<std::size_t>(media)]);
}

void check_texture_values(const ChunkTree& tree, const TextureView& texture, Faults& faults) {
    for (const ImageView& image : texture.images) {
        const std::size_t at = find_control(image.uri);
        if (at != std::string_view::npos) faults.add({ErrorCode::kLinkControl, tree[image.chunk].offset, at});
    }
}

void check_material_values(const ChunkTree& tree, const MaterialView& material, Faults& faults) {
    const std::uint64_t offset = offset_of(tree, material.chunk, FourCC("SURF"));
    const SurfaceRecord& surface = material.surface;
    const std::array scalars{surface.metallic, surface.roughness, surface.normal_scale, surface.occlusion_strength,
                             surface.alpha_cutoff};
    check_finite(surface.base_colour, offset, faults);
    check_finite(surface.emissive, offset, faults);
    check_finite(scalars, offset, faults);
    for (const TextureUseRecord& use : {surface.base_colour_texture, surface.metallic_roughness_texture,
                                        surface.normal_texture, surface.occlusion_texture, surface.emissive_texture}) {
        check_finite(std::array{use.offset[0], use.offset[1], use.scale[0], use.scale[1], use.rotation}, offset,
                     faults);
    }
}

}  // namespace bendy
