#include <bendy/converter/convert.h>

#include "failure.h"
#include "passes/attach_rigs.h"
#include "passes/collapse_vertices.h"
#include "rig/parse_rig.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/validate.h>

#include <new>

namespace bendy::converter {
namespace {

constexpr std::string_view kGenerator = "bendy " BENDY_VERSION;

}  // namespace

Result<std::vector<std::byte>, ImportError> convert(const std::filesystem::path& file, const ConvertOptions& options,
                                                    Report& report) {
    std::optional<Rig> rig;
    try {
        if (options.rig) rig = read_rig(*options.rig, report);
        auto scene = import_gltf(file, options.gltf, report);
        if (!scene) return scene.error();
        attach_rigs(*scene, rig, options.auto_rig, report);
        if (options.lod) collapse_vertices(*scene);
        std::vector<std::byte> bytes = build_chunks(*scene, kGenerator, report);
        // The importer has checked the source; this checks the importer, before anything is written.
        const Faults faults = validate(bytes);
        if (!faults.empty())
            return ImportError{{}, "cannot be held: " + describe_with_place(faults.list().front(), bytes)};
        return bytes;
    } catch (const Failure& failure) {  // only of the rig: import_gltf throws nothing
        return ImportError{failure.error.place, failure.error.message, options.rig.value_or(file)};
    } catch (const std::bad_alloc&) {
        return ImportError{{}, "there is not enough memory"};
    }
}

}  // namespace bendy::converter
