#include "convert/importers.h"

#include <bendy/converter/import.h>
#include <bendy/format/byte_reader.h>

#include <algorithm>
#include <array>
#include <cassert>
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
    return import_x(as_text(bytes), file, {options.gltf.embed_images, options.gltf.root, options.ticks_per_second},
                    report);
}
#endif

#ifdef BENDY_MD2
Imported from_md2(Buffer bytes, const Path& file, const ConvertOptions& options, Report& report) {
    return import_md2(bytes, file, {options.gltf.embed_images, options.gltf.root, options.texture}, report);
}
#endif

#ifdef BENDY_BVH
Imported from_bvh(Buffer bytes, const Path& file, const ConvertOptions& options, Report& report) {
    return import_bvh(as_text(bytes), file, {options.unit}, report);
}
#endif

constexpr std::array kImporters{
    Importer{.format = SourceFormat::gltf, .takes_scene = true, .import = from_gltf},
#ifdef BENDY_X_FILES
    Importer{.format = SourceFormat::x, .takes_ticks = true, .import = from_x},
#endif
#ifdef BENDY_MD2
    Importer{.format = SourceFormat::md2, .takes_texture = true, .import = from_md2},
#endif
#ifdef BENDY_BVH
    Importer{.format = SourceFormat::bvh, .takes_unit = true, .import = from_bvh},
#endif
    Importer{.format = SourceFormat::bendy, .import = from_bendy},
};

}  // namespace

const Importer& importer_of(SourceFormat format) {
    const auto found = std::find_if(kImporters.begin(), kImporters.end(),
                                    [&](const Importer& importer) { return importer.format == format; });
    assert(found != kImporters.end());
    return *found;
}

}  // namespace bendy::converter
