#include "edit/edit_work.h"

#include <numbers>

namespace bendy::tools {
namespace {

Json list_of(const std::vector<std::string>& lines) {
    Json list = Json::array();
    for (const std::string& line : lines) list.push_back(line);
    return list;
}

double degrees(double radians) {
    return radians * 180.0 / std::numbers::pi;
}

/// \param unit  the name of the amount, as in "degrees"
Json as_json(const motion::Worst& worst, const char* unit, double amount) {
    return Json{{"joint", worst.joint}, {"seconds", worst.seconds}, {unit, amount}};
}

Json as_json(const std::string& file, const motion::RetargetedClip& clip) {
    Json json{{"source", file}, {"clip", clip.clip}, {"frames", clip.frames}, {"frames_limited", clip.limited}};
    json["mean_error_m"] = clip.mean_error;
    json["error_m"] = clip.error;
    if (!clip.off.joint.empty()) {
        json["directions"] = as_json(clip.off, "degrees", degrees(clip.off.amount));
        json["directions"]["mean_degrees"] = degrees(clip.mean_off);
    }
    if (!clip.missed.joint.empty()) json["missed"] = as_json(clip.missed, "metres", clip.missed.amount);
    json["hips_lowered_m"] = clip.lowered;
    json["pops"] = Json::array();
    for (const motion::Pop& pop : clip.pops) {
        Json one = as_json(pop, "degrees", degrees(pop.amount));
        one["source_degrees"] = degrees(pop.of_source);
        json["pops"].push_back(std::move(one));
    }
    return json;
}

}  // namespace

Json edited_report(const std::filesystem::path& output, std::size_t size, const EditReport& report) {
    Json json{{"file", output.string()},
              {"bytes", size},
              {"done", list_of(report.log.done)},
              {"warnings", list_of(report.log.warnings)}};
    if (report.clips.empty()) return json;
    json["retargeted"] = Json::array();
    for (const auto& [file, clip] : report.clips) json["retargeted"].push_back(as_json(file, clip));
    return json;
}

}  // namespace bendy::tools
