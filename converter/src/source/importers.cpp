#include "importers.h"

#include <bendy/converter/import_bendy.h>
#include <bendy/converter/import_gltf.h>
#include <bendy/converter/import_md2.h>
#include <bendy/converter/import_x.h>
#include <bendy/format/byte_reader.h>

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

namespace bendy::converter {
namespace {

using Buffer = std::vector<std::byte>;
using Path = std::filesystem::path;
using Imported = Result<Scene, ImportError>;

Imported from_gltf(Buffer bytes, const Path& file, const ConvertOptions& options, Report& report) {
    return import_gltf(std::move(bytes), file, options.gltf, report);
}

Imported from_bendy(Buffer bytes, const Path& /*file*/, const ConvertOptions& /*options*/, Report& report) {
    return import_bendy(Bytes(bytes), report);
}

#ifdef BENDY_X_FILES
Imported from_x(Buffer bytes, const Path& file, const ConvertOptions& options, Report& report) {
    return import_x(as_text(bytes), file, {options.gltf.embed_images, options.ticks_per_second}, report);
}
#endif

#ifdef BENDY_MD2
Imported from_md2(Buffer bytes, const Path& file, const ConvertOptions& /*options*/, Report& report) {
    const std::u8string stem = file.stem().u8string();
    return import_md2(bytes, std::string(stem.begin(), stem.end()), report);
}
#endif

constexpr std::array kImporters{
    Importer{SourceFormat::gltf, "a glTF file", "", {".gltf"}, true, false, from_gltf},
    Importer{SourceFormat::gltf, "a glTF binary file", "glTF", {".glb", ".vrm"}, true, false, from_gltf},
#ifdef BENDY_X_FILES
    Importer{SourceFormat::x, "a DirectX X-file", "xof ", {".x"}, false, true, from_x},
#endif
#ifdef BENDY_MD2
    Importer{SourceFormat::md2, "a Quake II model", "IDP2", {".md2"}, false, false, from_md2},
#endif
    Importer{SourceFormat::bendy, "a bendy file", "HEAD", {".bendy"}, false, false, from_bendy},
};

}  // namespace

std::span<const Importer> importers() {
    return kImporters;
}

const Importer& importer_of(SourceFormat format) {
    const auto found = std::find_if(kImporters.begin(), kImporters.end(),
                                    [&](const Importer& importer) { return importer.format == format; });
    assert(found != kImporters.end());
    return *found;
}

}  // namespace bendy::converter
