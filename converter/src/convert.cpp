#include <bendy/converter/convert.h>

#include "humanoid/auto_rig.h"
#include "humanoid/vrm.h"
#include "rig/articulations.h"

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
    auto scene = import_gltf(file, options.gltf, report);
    if (!scene) return scene.error();
    try {
        add_vrm_chains(*scene, report);
        add_articulations(*scene, {}, report);
        if (options.auto_rig) auto_rig(*scene, {}, report);
        std::vector<std::byte> bytes = build_chunks(*scene, kGenerator, report);
        // The importer has checked the source; this checks the importer, before anything is written.
        const Faults faults = validate(bytes);
        if (!faults.empty())
            return ImportError{{}, "cannot be held: " + describe_with_place(faults.list().front(), bytes)};
        return bytes;
    } catch (const std::bad_alloc&) {
        return ImportError{{}, "there is not enough memory"};
    }
}

}  // namespace bendy::converter
