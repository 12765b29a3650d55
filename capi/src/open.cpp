// Opening and closing models.
#include "handles.h"
#include "sized.h"

#include <bendy/format/diagnostics.h>
#include <bendy/format/text.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <type_traits>

namespace bendy::capi {
namespace {

bendy_status take_options(const bendy_open_options* options, OpenOptions& taken, bendy_error* error) {
    bendy_open_options values = BENDY_OPEN_OPTIONS_INIT;
    if (const bendy_status status = take(options, "options", values, error)) return status;
    taken.object = values.object;
    taken.sums = values.sums_later != 0 ? Sums::later : Sums::checked;
    return BENDY_OK;
}

bendy_status open_source(Source source, const bendy_open_options* options, bendy_model*& out, bendy_error* error) {
    OpenOptions taken;
    if (const bendy_status status = take_options(options, taken, error)) return status;
    const Bytes bytes = source.bytes;
    Result<Model> model = Model::from_memory(bytes, taken);
    if (!model) return fail(error, model.error(), bytes);
    out = std::make_unique<bendy_model>(
              bendy_model{std::make_shared<const Character>(std::move(source), *std::move(model))})
              .release();
    return BENDY_OK;
}

bendy_status open_memory(const void* data, std::size_t size, bool copies, const bendy_open_options* options,
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
    return open_source(std::move(source), options, out, error);
}

constexpr bool kNamesAreUnicode = std::is_same_v<std::filesystem::path::value_type, wchar_t>;  // on Windows

std::filesystem::path path_of(const char* name) {
    if constexpr (kNamesAreUnicode) return std::u8string(name, name + std::strlen(name));
    return name;
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_model* bendy_open(const char* path, const bendy_open_options* options, bendy_error* error) {
    bendy_model* model = nullptr;
    guarded(error, [&] {
        if (const bendy_status status = check_pointer(path, "path", error)) return status;
        if (kNamesAreUnicode && !bendy::is_utf8(path)) return fail(error, BENDY_BAD_ARGUMENT, "path is not UTF-8");
        auto file = bendy::MappedFile::open(path_of(path));
        if (!file) return fail(error, file.error(), {});
        Source source;
        source.file = *std::move(file);
        source.bytes = source.file.bytes();
        return open_source(std::move(source), options, model, error);
    });
    return model;
}

bendy_model* bendy_open_copy(const void* bytes, size_t size, const bendy_open_options* options, bendy_error* error) {
    bendy_model* model = nullptr;
    guarded(error, [&] { return open_memory(bytes, size, true, options, model, error); });
    return model;
}

bendy_model* bendy_open_borrowed(const void* bytes, size_t size, const bendy_open_options* options,
                                 bendy_error* error) {
    bendy_model* model = nullptr;
    guarded(error, [&] { return open_memory(bytes, size, false, options, model, error); });
    return model;
}

void bendy_close(bendy_model* model) {
    delete model;
}

bendy_status bendy_check_sums(const bendy_model* model, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        const auto checked = model->get().check_sums();
        return checked ? BENDY_OK : fail(error, checked.error(), model->character->source.bytes);
    });
}
