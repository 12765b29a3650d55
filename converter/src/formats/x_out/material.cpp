#include "formats/x/conventions.h"
#include "formats/x/parts.h"
#include "parts.h"
#include "scene/failure.h"
#include "scene/source/image_bytes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

namespace bendy::converter::x_out {
namespace {

std::string ending_of(const Image& image) {
    const std::string media_type = image.media_type.empty() ? media_type_of(image.bytes) : image.media_type;
    const auto kinds = image_kinds();
    const auto found =
        std::find_if(kinds.begin(), kinds.end(), [&](const ImageKind& kind) { return kind.media_type == media_type; });
    if (!media_type.empty() && found != kinds.end()) return std::string(found->suffix);
    return may_be_tga(image.bytes) ? ".tga" : ".bin";
}

/// Replaces backslashes: strings of X-files have no escapes, and readers interpret a backslash differently.
std::string file_name(std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '"' || c == '\\' || static_cast<unsigned char>(c) < 0x20; },
        '_');
    return name;
}

/// Decodes a URI's percent escapes.
std::string decode_uri(const std::string& uri) {
    return file_name(x::decode_text(uri));
}

bool is_transformed(const TextureUse& use) {
    const TextureUse usual;
    return use.offset != usual.offset || use.rotation != usual.rotation || use.scale != usual.scale;
}

bool is_same(const TextureUse& a, const TextureUse& b) {
    return a.texture == b.texture && a.coords == b.coords && a.offset == b.offset && a.rotation == b.rotation &&
           a.scale == b.scale;
}

/// Materials that stand in a mesh: joints' own that only rigid meshes on this joint use.
std::vector<bool> materials_in_meshes(const Scene& scene) {
    std::vector<bool> is_used(scene.materials.size());
    std::vector<bool> is_shared(scene.materials.size());
    for (const Mesh& mesh : scene.meshes) {
        for (const Submesh& submesh : mesh.submeshes) {
            if (submesh.material == kNone || submesh.topology != Topology::triangles || submesh.indices.empty())
                continue;
            is_used[submesh.material] = true;
            if (mesh.influences != 0 || mesh.joint != scene.materials[submesh.material].joint)
                is_shared[submesh.material] = true;
        }
    }
    std::vector<bool> found(scene.materials.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        found[i] = scene.materials[i].joint != kNone && is_used[i] && !is_shared[i];
    return found;
}

}  // namespace

MaterialExporter::MaterialExporter(const Scene& scene, const Names& names, const std::string& image_stem, Text& text,
                                   std::vector<XAsset::File>& images, Report& report)
    : scene_(scene),
      names_(names),
      image_stem_(image_stem),
      text_(text),
      images_(images),
      report_(report),
      is_due_(materials_in_meshes(scene)) {}

void MaterialExporter::write_shared() {
    for (std::uint32_t i = 0; i < scene_.materials.size(); ++i) {
        if (is_due_[i]) continue;
        write(i);
        if (scene_.materials[i].joint != kNone) report_.warn(std::string(kOwnMaterialShared), at("materials", i));
    }
}

void MaterialExporter::write_entry(std::uint32_t material) {
    if (is_due_[material]) {
        write(material);
    } else {
        text_.line("{ " + names_.materials[material] + " }");
    }
    is_due_[material] = false;
}

void MaterialExporter::write(std::uint32_t number) {
    const Material& material = scene_.materials[number];
    const std::string& identifier = names_.materials[number];
    const std::string place = at("materials", number);
    report_losses(material, place);
    text_.open("Material", identifier);
    line(x::to_display(material.base_colour));
    text_.begin_line();
    text_.add(x::power_of(material.roughness)).add(";");
    text_.end_line();
    glm::vec3 specular(0.0f);
    for (int i = 0; i < 3; ++i)
        specular[i] = x::kDielectric + material.metallic * (material.base_colour[i] - x::kDielectric);
    line(material.roughness < 1.0f ? x::to_display(specular) : glm::vec3(0.0f));
    line(x::to_display(material.emissive));
    if (material.base_colour_texture.texture != kNone) write_texture(material.base_colour_texture.texture, place);
    write_name(identifier, material.name, text_);
    text_.close();
}

template <class Vector>
void MaterialExporter::line(const Vector& vector) {
    text_.begin_line();
    text_.add_vector(vector).add(";");
    text_.end_line();
}

void MaterialExporter::write_texture(std::uint32_t number, const std::string& place) {
    const Texture& texture = scene_.textures[number];
    if (texture.images.size() > 1) report_.warn("further image of a texture left out", place);
    if (texture.wrap_s != Wrap::repeat || texture.wrap_t != Wrap::repeat || texture.mag_filter != Filter::unspecified ||
        texture.min_filter != Filter::unspecified)
        report_.warn("how a texture is sampled is left out", place);
    if (!texture.extras.empty() || !texture.more.empty())
        report_.warn("extras of a texture left out: X-files have no place for it", place);
    if (texture.images.empty()) return;
    text_.open("TextureFilename");
    text_.line('"' + file_of(texture.images.front()) + "\";");
    text_.close();
}

std::string MaterialExporter::file_of(std::uint32_t number) {
    const Image& image = scene_.images[number];
    if (image.bytes.empty()) return decode_uri(image.uri);
    std::string name = file_name(image_stem_) + '_' + std::to_string(number) + ending_of(image);
    if (is_written_.insert(number).second) images_.push_back({name, image.bytes});
    return name;
}

void MaterialExporter::report_losses(const Material& material, const std::string& place) {
    const auto lose = [&](bool is_lost, const char* what) {
        if (is_lost) report_.warn(std::string(what) + " left out: X-files have no place for it", place);
    };
    if (material.metallic != 0.0f || material.roughness != 1.0f) {
        report_.warn("metallic and roughness are written as specular colour and power, which only resemble them",
                     place);
    }
    lose(material.metallic_roughness_texture.texture != kNone, "metallic-roughness texture");
    lose(material.normal_texture.texture != kNone, "normal texture");
    lose(material.occlusion_texture.texture != kNone, "occlusion texture");
    const TextureUse& colour = material.base_colour_texture;
    const TextureUse& glow = material.emissive_texture;
    lose(glow.texture != kNone && !is_same(glow, colour), "emissive texture");
    lose(glow.texture == kNone && colour.texture != kNone && material.emissive != glm::vec3(0.0f),
         "that the texture has no part in a material's own light");
    lose(colour.texture != kNone && colour.coords != 0, "the choice of a further set of texture coordinates");
    lose(colour.texture != kNone && is_transformed(colour), "texture transform");
    lose(material.alpha_mode == AlphaMode::mask, "alpha mask");
    lose(material.double_sided, "that a material has two sides");
    lose(material.unlit, "that a material is unlit");
    lose(!material.extensions.empty(), "extensions of a material");
    lose(!material.extras.empty() || !material.more.empty(), "extras of a material");
}

}  // namespace bendy::converter::x_out
