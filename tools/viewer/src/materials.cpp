#include "materials.h"

#include "image_reader.h"

#include <bendy/format/file.h>
#include <bendy/json/json.h>

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace bendy::viewer {
namespace {

/// Returns a number of an extension; nothing if it is not a finite number of at least 0.
std::optional<float> number_of(const Json& value) {
    if (!value.is_number()) return std::nullopt;
    const auto number = value.get<float>();
    return std::isfinite(number) && number >= 0.0f ? std::optional(number) : std::nullopt;
}

Json member(const Json& object, const char* key) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? Json() : *found;
}

ShownSurface shown_surface(const MaterialView& material) {
    ShownSurface surface{material.surface};
    if (material.extensions.empty()) return surface;
    const auto extensions = Json::parse(material.extensions).value_or(Json());
    const float strength =
        number_of(member(member(extensions, "KHR_materials_emissive_strength"), "emissiveStrength")).value_or(1.0f);
    for (float& colour : surface.record.emissive) colour *= strength;

    // 0 represents an infinite index: everything is reflected.
    const float ior = number_of(member(member(extensions, "KHR_materials_ior"), "ior")).value_or(1.5f);
    const float from_ahead = ior == 0.0f ? 1.0f : (ior - 1.0f) / (ior + 1.0f);
    const Json specular = member(extensions, "KHR_materials_specular");
    glm::vec3 colour(1.0f);
    const Json factors = member(specular, "specularColorFactor");
    for (int k = 0; k < 3 && factors.is_array() && factors.size() == 3; ++k)
        colour[k] = number_of(factors[static_cast<std::size_t>(k)]).value_or(1.0f);
    surface.dielectric_at_grazing = std::min(number_of(member(specular, "specularFactor")).value_or(1.0f), 1.0f);
    surface.dielectric = glm::min(from_ahead * from_ahead * colour, glm::vec3(1.0f)) * surface.dielectric_at_grazing;
    return surface;
}

constexpr const char* kCannotRead = "cannot be read";

void upload_pixels(GLuint texture, const Picture& picture, bool srgb) {
    bind_texture(kUploadUnit, GL_TEXTURE_2D, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, static_cast<GLsizei>(picture.width),
                 static_cast<GLsizei>(picture.height), 0, GL_RGBA, GL_UNSIGNED_BYTE, picture.pixels.data());
    glGenerateMipmap(GL_TEXTURE_2D);
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
}

std::size_t index_of(Texels texels) {
    return static_cast<std::size_t>(texels);
}

/// The bytes of an image in a file, or in the model's.
struct ImageBytes {
    MappedFile file;
    Bytes bytes;
};

std::optional<ImageBytes> bytes_of(const ImageView& view, const std::filesystem::path& file) {
    if (file.empty()) return ImageBytes{{}, view.bytes};
    auto read = MappedFile::read(file);
    if (!read) return std::nullopt;
    ImageBytes image{*std::move(read), {}};
    image.bytes = image.file.bytes();
    return image;
}

}  // namespace

std::vector<ShownSurface> shown_surfaces(const Model& model) {
    std::vector<ShownSurface> surfaces;
    for (const MaterialView& material : model.materials()) surfaces.push_back(shown_surface(material));
    surfaces.emplace_back();
    return surfaces;
}

TextureLoader::TextureLoader(const Model& model, ReadableFolders folders, Warn warn)
    : model_(&model), folders_(std::move(folders)), warn_(std::move(warn)) {
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

bool TextureLoader::Image::is_complete() const {
    for (std::size_t k = 0; k < textures.size(); ++k) {
        if (is_wanted[k] && !textures[k]) return false;
    }
    return true;
}

/// What its textures take that are wanted but not there yet.
std::uint64_t TextureLoader::Image::bytes() const {
    std::uint64_t copies = 0;
    for (std::size_t k = 0; k < textures.size(); ++k) copies += is_wanted[k] && !textures[k] ? 1 : 0;
    const std::uint64_t texels = std::uint64_t{halved(size.width, halvings)} * halved(size.height, halvings);
    return copies * texels * 16 / 3;  // 4 bytes; the mipmaps take a third of that
}

void TextureLoader::load(std::span<const TextureUse> uses, const TextureLimits& limits,
                         const std::function<double(const TextureUse&)>& scale) {
    std::map<std::pair<std::uint32_t, Texels>, Wanted> by_texture;
    for (const TextureUse& use : uses) {
        const std::uint32_t number = use.record->texture;
        if (number >= model_->textures().size() || loaded_.contains({number, use.texels})) continue;
        Wanted& wanted = by_texture[{number, use.texels}];
        wanted.texture = number;
        wanted.texels = use.texels;
        wanted.uses.push_back(&use);
    }
    std::vector<Wanted> left;
    left.reserve(by_texture.size());
    for (auto& [key, wanted] : by_texture) left.push_back(std::move(wanted));
    while (!left.empty()) {
        std::erase_if(left, [&](Wanted& wanted) {
            if (choose(wanted, limits, scale)) return false;
            warn_("texture " + std::to_string(wanted.texture) + " cannot be shown: " + wanted.problem);
            return true;
        });
        plan(limits);
        for (Image& image : images_) {
            if (image.size.problem.empty() && !image.is_complete()) make(image);
        }
        // If an image cannot be decoded, the next one of the texture may be.
        std::erase_if(left, [&](const Wanted& wanted) {
            if (!images_[wanted.image].size.problem.empty()) return false;
            loaded_[{wanted.texture, wanted.texels}] = wanted.image;
            return true;
        });
    }
}

/// Finds the first of a texture's images that may be decoded.
bool TextureLoader::choose(Wanted& wanted, const TextureLimits& limits,
                           const std::function<double(const TextureUse&)>& scale) {
    const auto all = model_->textures();
    const std::vector<ImageView>& alternatives = all[wanted.texture].images;
    for (; wanted.alternative < alternatives.size(); ++wanted.alternative) {
        const ImageView& view = alternatives[wanted.alternative];
        const auto found =
            find_image(view.same ? all[view.same->texture].images[view.same->image] : view, wanted.problem);
        if (!found) continue;
        wanted.image = *found;
        Image& image = images_[*found];
        image.is_wanted[index_of(wanted.texels)] = true;
        const double side = std::max(image.size.width, image.size.height);
        constexpr double kSmall = 256.0;
        if (side <= kSmall) image.needed = side;
        for (const TextureUse* use : wanted.uses) {
            if (image.needed < side) image.needed = std::max(image.needed, limits.side * scale(*use));
        }
        return true;
    }
    return false;
}

std::optional<std::size_t> TextureLoader::find_image(const ImageView& view, std::string& problem) {
    Image image;
    image.view = &view;
    std::size_t* known = nullptr;
    if (view.bytes.empty()) {
        const auto path = folders_.find(view.uri);
        problem = "its image is not in this file";
        if (!path && path.error() == LinkProblem::outside)
            problem += ", and is not read from outside its folder: --root FOLDER allows a folder that it is in";
        if (!path) return std::nullopt;
        image.file = *path;
        known = &by_file_.try_emplace(*path, images_.size()).first->second;
    } else {
        known = &by_bytes_.try_emplace(as_text(view.bytes), images_.size()).first->second;
    }
    if (*known == images_.size()) {
        const auto read = bytes_of(view, image.file);
        image.size = read ? read_image_size(read->bytes) : ImageSize{0, 0, kCannotRead};
        images_.push_back(std::move(image));
    }
    const std::string& why = images_[*known].size.problem;
    if (why.empty()) return *known;
    problem = why == kCannotRead ? "its image " + images_[*known].file.string() + ' ' + why : "its image " + why;
    return std::nullopt;
}

/// Decides how far each image is scaled down: to what can be seen of it, and then the largest ones until all of them
/// together take no more than they may.
void TextureLoader::plan(const TextureLimits& limits) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    const auto is_smaller = [](const Image* a, const Image* b) { return a->bytes() < b->bytes(); };
    std::vector<Image*> heap;
    std::uint64_t bytes = bytes_;
    for (Image& image : images_) {
        if (!image.size.problem.empty() || image.is_complete()) continue;
        const std::uint32_t side = std::max(image.size.width, image.size.height);
        image.halvings = 0;
        while (halved(side, image.halvings) > static_cast<std::uint32_t>(largest) ||
               std::ldexp(static_cast<double>(side), -static_cast<int>(image.halvings) - 1) >=
                   std::max(image.needed, 1.0))
            ++image.halvings;
        bytes += image.bytes();
        heap.push_back(&image);
    }
    const std::uint64_t all = bytes;
    std::size_t reduced = 0;
    std::make_heap(heap.begin(), heap.end(), is_smaller);
    while (bytes > limits.bytes && !heap.empty()) {
        std::pop_heap(heap.begin(), heap.end(), is_smaller);
        Image& image = *heap.back();
        if (image.size.width >> image.halvings <= 1 && image.size.height >> image.halvings <= 1) break;  // so are all
        bytes -= image.bytes();
        ++image.halvings;
        bytes += image.bytes();
        std::push_heap(heap.begin(), heap.end(), is_smaller);
        ++reduced;
    }
    require_memory(bytes - bytes_, "the textures");
    if (reduced == 0) return;
    constexpr std::uint64_t kMiB = std::uint64_t{1} << 20u;
    warn_("the textures are scaled down: they would take " + std::to_string((all + kMiB - 1) / kMiB) +
          " MiB for pictures of this size, and get " + std::to_string(limits.bytes / kMiB));
}

void TextureLoader::make(Image& image) {
    const auto read = bytes_of(*image.view, image.file);
    const bool is_colour = image.is_wanted[index_of(Texels::srgb)];
    const ReadImage made = read ? read_image(read->bytes, image.halvings, is_colour ? Texels::srgb : Texels::linear)
                                : ReadImage{{}, kCannotRead};
    image.size.problem = made.problem;
    if (!made.problem.empty()) return;
    bytes_ += image.bytes();
    for (std::size_t k = 0; k < image.textures.size(); ++k) {
        if (image.is_wanted[k] && !image.textures[k])
            upload_pixels(image.textures[k].emplace().name(), made.picture, k == index_of(Texels::srgb));
    }
    check_memory();
}

bool TextureLoader::bind(GLuint unit, std::uint32_t number, Texels texels) const {
    const auto found = loaded_.find({number, texels});
    if (found == loaded_.end()) return false;
    bind_texture(unit, GL_TEXTURE_2D, images_[found->second].textures[index_of(texels)]->name());
    set_sampler(model_->textures()[number].sampler);
    return true;
}

}  // namespace bendy::viewer
