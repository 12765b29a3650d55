#pragma once

#include <bendy/format/error.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// MATE: a material; TEXT: a texture, which is a sampler and one or more encodings of an image.
namespace BENDY_PUBLIC bendy {

struct MaterialView {
    std::uint32_t chunk = 0;
    std::string_view name;
    SurfaceRecord surface;
    std::string_view extensions;  ///< JSON object, or empty
    std::string_view extras;
    std::string_view more;  ///< JSON object, or empty
};

/// One encoding of a texture's image: embedded bytes, or a URI, or a reference to the image of another texture.
struct ImageView {
    std::uint32_t chunk = 0;
    MediaType media = MediaType::other;
    Bytes bytes;                     ///< of an IMAG
    std::string_view uri;            ///< of a LINK
    std::optional<SameRecord> same;  ///< of a SAME
};

struct TextureView {
    std::uint32_t chunk = 0;
    std::string_view name;
    SamplerRecord sampler;
    std::vector<ImageView> images;  ///< in order of preference
    std::string_view extras;
    std::string_view more;  ///< JSON object, or empty
};

/// Reads a MATE chunk; checks texture numbers against `textures`.
MaterialView read_material(const ChunkTree& tree, std::uint32_t chunk, std::uint32_t textures, Faults& faults);
/// Reads a TEXT chunk.
TextureView read_texture(const ChunkTree& tree, std::uint32_t chunk, Faults& faults);
/// Checks every SAME against the textures that it refers to.
void check_texture_references(const ChunkTree& tree, std::vector<TextureView>& textures, Faults& faults);
/// Returns "image/png", "image/jpeg", ...; empty for MediaType::other.
std::string mime_type(MediaType media);
/// Adds faults of content: numbers that are not finite.
void check_material_values(const ChunkTree& tree, const MaterialView& material, Faults& faults);
/// Checks the URIs of a texture's images.
void check_texture_values(const ChunkTree& tree, const TextureView& texture, Faults& faults);

}  // namespace bendy
