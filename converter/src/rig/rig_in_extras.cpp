#include "rig_in_extras.h"

#include "failure.h"
#include "json_text.h"
#include "parse_rig.h"

#include <string>

namespace bendy::converter {

std::optional<Rig> take_rig_from_extras(Scene& scene, Report& report) {
    if (scene.extras.find(kRigInExtras) == std::string::npos) return std::nullopt;
    const std::string place = "scene.extras." + std::string(kRigInExtras);
    try {
        auto extras = parse_json_text<Json>(scene.extras, report);
        if (!extras.is_object() || !extras.contains(kRigInExtras)) return std::nullopt;
        Rig rig = parse_rig(extras[kRigInExtras].dump(), report);
        rig.source = place + '.';
        extras.erase(kRigInExtras);
        scene.extras = extras.empty() ? std::string() : extras.dump();
        return rig;
    } catch (const Failure& failure) {
        report.warn("rig left out: " + failure.error.message,
                    failure.error.place.empty() ? place : place + '.' + failure.error.place);
        return std::nullopt;
    }
}

}  // namespace bendy::converter
