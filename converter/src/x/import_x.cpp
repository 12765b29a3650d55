#include <bendy/converter/import_x.h>

#include "cycles.h"
#include "failure.h"
#include "gltf/container.h"
#include "joints.h"
#include "materials.h"
#include "meshes.h"
#include "read_x_file.h"
#include "without_throwing.h"

#include <string>

namespace bendy::converter {
namespace x {
namespace {

Scene import(std::string_view bytes, const std::filesystem::path& file, bool embed_images, Report& report) {
    const XFile source = read_x_file(bytes, report);
    gltf::Budget budget;
    budget.add_source(bytes.size());
    Scene scene;
    const FrameIndex frames(source);
    import_joints(source, scene, report);
    import_rig(source, frames, scene, report);
    import_materials(source, file, embed_images, scene, report);
    import_cycles(source, frames, scene, report);
    import_meshes(source, frames, budget, scene, report);
    if (scene.joints.empty()) fail({}, "there is nothing to convert: the file has neither frames nor meshes");
    return scene;
}

}  // namespace
}  // namespace x

Result<Scene, ImportError> import_x(std::string_view bytes, const std::filesystem::path& file, bool embed_images,
                                    Report& report) {
    return without_throwing<Scene>(
        [&]() -> Result<Scene, ImportError> { return x::import(bytes, file, embed_images, report); });
}

Result<Scene, ImportError> import_x(const std::filesystem::path& file, bool embed_images, Report& report) {
    return without_throwing<Scene>([&]() -> Result<Scene, ImportError> {
        const std::vector<std::byte> bytes = gltf::read_file(file, {});
        return import_x({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file, embed_images, report);
    });
}

}  // namespace bendy::converter
