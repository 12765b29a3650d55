#include <bendy/converter/export_x.h>

#include "animation.h"
#include "failure.h"
#include "frames.h"
#include "material.h"
#include "names.h"
#include "passes/keep_level.h"
#include "passes/move_links.h"
#include "rig.h"
#include "templates.h"
#include "without_throwing.h"

#include <bendy/converter/import_bendy.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/file.h>

#include <utility>

namespace bendy::converter {
namespace x_out {
namespace {

XAsset write(const Scene& scene, const std::string& image_stem, Report& report) {
    XAsset asset;
    Text text;
    text.line("xof 0303txt 0032");
    text.line("// bendy " BENDY_VERSION);
    write_templates(text);
    const Names names(scene);
    write_materials(scene, names, image_stem, text, asset.images, report);
    write_frames(scene, names, text, report);
    write_chains(scene, names, text);
    write_cycles(scene, names, text, report);
    if (!scene.levels.empty()) report.warn("levels of detail left out: X-files have no place for them");
    if (!scene.extras.empty() || !scene.source_extras.empty() || !scene.extensions.empty() || !scene.more.empty() ||
        !scene.source_more.empty())
        report.warn("extras or extensions of the scene left out: X-files have no place for them");
    if (!scene.asset.empty()) report.warn("what the file says of its source left out: author, copyright, generator");
    asset.text = std::move(text).take();
    return asset;
}

}  // namespace
}  // namespace x_out

namespace {

XAsset export_bytes(Bytes bytes, const std::string& image_stem, Report& report, const ExportOptions& options,
                    const std::filesystem::path& bendy_file) {
    Result<Scene, ImportError> scene = import_bendy(bytes, report);
    if (!scene) throw Failure{scene.error()};
    if (!bendy_file.empty() && !options.output.empty()) move_links(*scene, bendy_file, options.output, report);
    if (!options.vertices.empty()) keep_level(*scene, options.vertices);
    return x_out::write(*scene, image_stem, report);
}

}  // namespace

Result<XAsset, ImportError> export_x(Bytes bytes, const std::string& image_stem, Report& report,
                                     const ExportOptions& options) {
    return without_throwing<XAsset>(
        [&]() -> Result<XAsset, ImportError> { return export_bytes(bytes, image_stem, report, options, {}); });
}

Result<XAsset, ImportError> export_x(const std::filesystem::path& bendy_file, const std::string& image_stem,
                                     Report& report, const ExportOptions& options) {
    const Result<MappedFile> mapped = MappedFile::open(bendy_file);
    if (!mapped) return ImportError{{}, describe(mapped.error())};
    return without_throwing<XAsset>([&]() -> Result<XAsset, ImportError> {
        return export_bytes(mapped->bytes(), image_stem, report, options, bendy_file);
    });
}

}  // namespace bendy::converter
