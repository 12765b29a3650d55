#include "error_place.h"

namespace bendy::converter {

std::string quoted_name(std::string_view name, std::uint32_t number) {
    return name.empty() ? '#' + std::to_string(number) : '"' + std::string(name) + '"';
}

std::string place_of(const Scene& scene, const MeasuredError& error) {
    std::string place;
    if (error.mesh != kNone) {
        place = "mesh " + quoted_name(scene.meshes[error.mesh].name, error.mesh) + ", vertex " +
                std::to_string(error.vertex);
    } else if (error.joint != kNone) {
        place = "joint " + quoted_name(scene.joints[error.joint].name, error.joint);
    } else {
        return {};
    }
    if (error.cycle == kNone) return place + ", at rest";
    std::string seconds = std::to_string(error.seconds);
    seconds.resize(seconds.size() - 3);  // milliseconds
    return place + ", cycle " + quoted_name(scene.cycles[error.cycle].name, error.cycle) + " at " + seconds + " s";
}

}  // namespace bendy::converter
