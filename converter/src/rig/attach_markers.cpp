#include "attach_markers.h"

#include "failure.h"

#include <string_view>
#include <unordered_map>

namespace bendy::converter {

void attach_markers(Scene& scene, const Rig& rig, Report& report) {
    if (!rig.cycles) return;
    std::unordered_map<std::string_view, std::size_t> by_name;  // the first of a name
    for (std::size_t i = 0; i < scene.cycles.size(); ++i) by_name.try_emplace(scene.cycles[i].name, i);
    std::vector<bool> is_taken(scene.cycles.size());
    for (const RigCycle& entry : *rig.cycles) {
        std::uint64_t number = 0;
        const bool is_number = parse_joint_number(entry.key, number);
        const auto named = by_name.find(entry.key);
        if (!is_number && named != by_name.end()) number = named->second;
        if (is_number ? number >= scene.cycles.size() : named == by_name.end()) {
            report.warn("no cycle takes " + quote(entry.key), rig.source + entry.place);
            continue;
        }
        if (is_taken[number]) fail(entry.place, "cycle " + quote(entry.key) + " has an earlier entry");
        is_taken[number] = true;
        set_markers(scene.cycles[number], entry.markers, rig.source, WrongMarkers::fail, report);
    }
    for (std::size_t i = 0; i < is_taken.size(); ++i) {
        if (rig.complete && !is_taken[i]) scene.cycles[i].markers.clear();
    }
}

}  // namespace bendy::converter
