// Opening and closing models; the version of the library.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/text.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <type_traits>

#define BENDY_TEXT_OF(number) #number
#define BENDY_DOTTED(major, minor, patch) BENDY_TEXT_OF(major) "." BENDY_TEXT_OF(minor) "." BENDY_TEXT_OF(patch)

namespace bendy::capi {
namespace {

/// Returns text(thing) for each thing.
template <class Things, class Text>
std::vector<std::string> texts_of(const Things& things, const Text& text) {
    std::vector<std::string> texts;
    texts.reserve(things.size());
    for (const auto& thing : things) texts.emplace_back(text(thing));
    return texts;
}

template <class Things>
std::vector<std::string> names_of(const Things& things) {
    return texts_of(things, [](const auto& thing) { return thing.name; });
}

template <class Things>
std::vector<std::string> extras_of(const Things& things) {
    return texts_of(things, [](const auto& thing) { return thing.extras; });
}

template <class Things>
std::vector<Json> json_of(const Things& things) {
    std::vector<Json> json;
    json.reserve(things.size());
    for (const auto& thing : things) json.push_back({std::string(thing.extras), std::string(thing.more)});
    return json;
}

Names names_in(const Model& model) {
    Names names;
    names.model = model.name();
    names.model_extras = model.extras();
    names.file_extras = model.file_extras();
    names.joints = names_of(model.joints());
    names.clips = names_of(model.clips());
    names.chains = names_of(model.chains());
    names.meshes = names_of(model.meshes());
    names.materials = names_of(model.materials());
    names.textures = names_of(model.textures());
    names.joint_extras = extras_of(model.joints());
    names.chain_extras = extras_of(model.chains());
    names.material_extensions = texts_of(model.materials(), [](const Material& from) { return from.extensions; });
    names.clip_json = json_of(model.clips());
    names.mesh_json = json_of(model.meshes());
    names.material_json = json_of(model.materials());
    names.texture_json = json_of(model.textures());
    for (const Mesh& mesh : model.meshes()) {
        for (const MorphTargetView& target : mesh.targets) names.targets.emplace_back(target.name);
        names.attributes.push_back(names_of(mesh.attributes));
    }
    for (const Clip& clip : model.clips()) {
        std::vector<CurveNames>& curves = names.curves.emplace_back();
        for (const CurveView& curve : clip.curves) curves.push_back({std::string(curve.name), std::string(curve.path)});
        names.markers.push_back(names_of(clip.markers));
    }
    // As a C string, a URI would end at a zero, and name another file.
    const auto whole_uri = [](const ImageView& image) {
        return image.uri.find('\0') == std::string_view::npos ? image.uri : std::string_view();
    };
    for (const Texture& texture : model.textures()) names.uris.push_back(texts_of(texture.images, whole_uri));
    return names;
}

OpenOptions from_c(const bendy_open_options& options) {
    OpenOptions taken;
    taken.object = options.object;
    taken.sums = options.sums_later != 0 ? Sums::later : Sums::checked;
    taken.storage = options.copied != 0 ? Storage::copied : Storage::mapped;
    return taken;
}

bendy_status open_source(Source source, const OpenOptions& options, bendy_model*& out, bendy_error* error) {
    const Bytes bytes = source.bytes;
    Result<Model> model = Model::from_memory(bytes, options);
    if (!model) return fail(error, model.error(), bytes);
    out = std::make_unique<bendy_model>(
              bendy_model{std::make_shared<const Character>(std::move(source), *std::move(model))})
              .release();
    return BENDY_OK;
}

bendy_status open_memory(const void* data, std::size_t size, bool copies, const bendy_open_options& options,
                         bendy_model*& out, bendy_error* error) {
    if (size != 0) {
        if (const bendy_status status = check_pointer(data, "bytes", error)) return status;
    }
    Source source;
    source.bytes = {static_cast<const std::byte*>(data), size};
    if (copies && size != 0) {
        source.copy = AlignedBytes(size);
        std::memcpy(source.copy.span().data(), data, size);
        source.bytes = source.copy.bytes();
    }
    return open_source(std::move(source), from_c(options), out, error);
}

constexpr bool kNamesAreUnicode = std::is_same_v<std::filesystem::path::value_type, wchar_t>;  // on Windows

std::filesystem::path path_of(const char* name) {
    if constexpr (kNamesAreUnicode) return std::u8string(name, name + std::strlen(name));
    return name;
}

}  // namespace

Character::Character(Source from, Model loaded)
    : source(std::move(from)), model(std::move(loaded)), names(names_in(model)) {
    for (std::uint32_t mesh = 0; mesh < model.meshes().size(); ++mesh)
        target_meshes.insert(target_meshes.end(), model.meshes()[mesh].targets.size(), mesh);
}

}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy::capi::open(const char* path, const bendy_open_options& options, bendy_model*& made,
                               bendy_error* error) {
    if (kNamesAreUnicode && !bendy::is_utf8(path)) return fail(error, BENDY_BAD_ARGUMENT, "path is not UTF-8");
    const bendy::OpenOptions taken = from_c(options);
    const bool copies = taken.storage == bendy::Storage::copied;
    auto file = copies ? bendy::MappedFile::read(path_of(path)) : bendy::MappedFile::open(path_of(path));
    if (!file) return fail(error, file.error(), {});
    Source source;
    source.file = *std::move(file);
    source.bytes = source.file.bytes();
    return open_source(std::move(source), taken, made, error);
}

bendy_status bendy::capi::open_copy(const void* bytes, size_t size, const bendy_open_options& options,
                                    bendy_model*& made, bendy_error* error) {
    return open_memory(bytes, size, true, options, made, error);
}

bendy_status bendy::capi::open_borrowed(const void* bytes, size_t size, const bendy_open_options& options,
                                        bendy_model*& made, bendy_error* error) {
    return open_memory(bytes, size, false, options, made, error);
}

bendy_status bendy::capi::check_sums(const bendy_model* model, bendy_error* error) {
    const auto checked = model->get().check_sums();
    return checked ? BENDY_OK : fail(error, checked.error(), model->character->source.bytes);
}

uint32_t bendy_version() {
    return BENDY_VERSION_MAJOR << 16U | BENDY_VERSION_MINOR << 8U | BENDY_VERSION_PATCH;
}

const char* bendy_version_string() {
    return BENDY_DOTTED(BENDY_VERSION_MAJOR, BENDY_VERSION_MINOR, BENDY_VERSION_PATCH);
}
