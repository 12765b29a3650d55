#include "compressed_file.h"
#include "failure.h"
#include "object_reader.h"
#include "parts.h"
#include "source/source_file.h"

#include <bendy/converter/import.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

namespace bendy::converter {

namespace x {
namespace {

/// How long the file's last key is after its first tick.
double last_tick(const XFile& file) {
    double last = 0.0;
    for (const AnimationSet& set : file.sets) {
        for (const Animation& animation : set.animations) {
            for (const Keys& keys : animation.keys) {
                if (!keys.times.empty()) last = std::max(last, keys.times.back());
            }
        }
    }
    return last;
}

/// Says what is assumed where the file does not say how long a tick is. \param stated  by the user; 0: nothing
void set_tick(XFile& file, double stated, Report& report) {
    const bool is_known = file.ticks_per_second != 0.0;
    if (stated != 0.0) {
        file.ticks_per_second = stated;
    } else if (!is_known) {
        constexpr double kDirectX = 4800.0;
        file.ticks_per_second = kDirectX;
        const double last = last_tick(file);
        if (last == 0.0) return;
        std::array<char, 160> text{};
        std::snprintf(
            text.data(), text.size(),
            "AnimTicksPerSecond is missing: 4,800 ticks a second are assumed, as DirectX does, so that the last "
            "key is at %.3g s; --ticks-per-second sets another rate",
            last / kDirectX);
        report.warn(text.data(), {});
    }
}

Scene import(std::string_view bytes, const std::filesystem::path& file, const XOptions& options, Report& report) {
    Budget budget;
    budget.add_source(bytes.size());
    std::string plain;
    if (is_compressed(bytes)) bytes = plain = decompress(bytes, budget);
    XFile source = read_x_file(bytes, report);
    set_tick(source, options.ticks_per_second, report);
    Scene scene;
    const FrameIndex frames(source);
    import_joints(source, scene, report);
    import_rig(source, frames, scene, report);
    import_materials(source, file, options.embed_images, scene, report);
    import_clips(source, frames, scene, report);
    import_meshes(source, frames, budget, scene, report);
    if (scene.joints.empty()) fail({}, "there is nothing to convert: the file has neither frames nor meshes");
    return scene;
}

}  // namespace
}  // namespace x

Result<Scene, ImportError> import_x(std::string_view bytes, const std::filesystem::path& file, const XOptions& options,
                                    Report& report) {
    return without_throwing<Scene>(
        [&]() -> Result<Scene, ImportError> { return x::import(bytes, file, options, report); });
}

Result<Scene, ImportError> import_x(const std::filesystem::path& file, const XOptions& options, Report& report) {
    return without_throwing<Scene>([&]() -> Result<Scene, ImportError> {
        const std::vector<std::byte> bytes = read_file(file, {});
        return import_x({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file, options, report);
    });
}

}  // namespace bendy::converter
