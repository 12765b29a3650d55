#include "convert_report.h"

#include <bendy/runtime.h>

#include <cstdint>
#include <iostream>

namespace bendy::cli {
namespace {

using Json = nlohmann::ordered_json;

Json start(const std::filesystem::path& input, const std::filesystem::path& output, const char* status) {
    return {{"status", status}, {"input", input.string()}, {"output", output.string()}};
}

void add_remarks(Json& json, const converter::Report& report) {
    Json warnings = Json::array();
    for (const converter::Warning& warning : report.warnings())
        warnings.push_back({{"message", warning.message}, {"place", warning.first_place}, {"count", warning.count}});
    json["warnings"] = std::move(warnings);
    json["proposals"] = report.proposals();
    json["suggestions"] = report.suggestions();
}

Json list_clips(const Model& model) {
    Json clips = Json::array();
    for (const Cycle& cycle : model.cycles()) {
        const double start = cycle.start;
        clips.push_back({{"name", cycle.name}, {"start", start}, {"seconds", static_cast<double>(cycle.end) - start}});
    }
    return clips;
}

Json describe_compact(const converter::CompactReport& report) {
    std::uint64_t exact = 0;
    std::uint64_t compact = 0;
    Json kinds = Json::array();
    for (std::size_t k = 0; k < report.compact.size(); ++k) {
        exact += report.exact[k].bytes;
        compact += report.compact[k].bytes;
        if (report.exact[k].bytes + report.compact[k].bytes == 0) continue;
        kinds.push_back({{"kind", report.compact[k].kind},
                         {"exactBytes", report.exact[k].bytes},
                         {"compactBytes", report.compact[k].bytes}});
    }
    Json json{{"maxError", report.max_error}, {"measuredError", report.measured_error},
              {"place", report.place},        {"height", report.height},
              {"exactBytes", exact},          {"compactBytes", compact},
              {"kinds", std::move(kinds)}};
    if (report.curves != 0) {
        json["curves"] = {
            {"count", report.curves}, {"packed", report.packed_curves}, {"largestError", report.curve_error}};
    }
    return json;
}

void add_contents(Json& json, const Model& model) {
    std::uint64_t images = 0;
    for (const Texture& texture : model.textures()) {
        for (const ImageView& image : texture.images) images += image.bytes.size();
    }
    Lod lod(model);
    json["imageBytes"] = images;
    json["joints"] = model.joints().size();
    json["constraints"] = model.constraints().size();
    json["chains"] = model.chains().size();
    json["meshes"] = model.pools().size();
    json["vertices"] = model.vertex_count();
    json["triangles"] = lod.triangles();
    if (model.collapse() != nullptr) {
        lod.set_share(0.0f);
        json["fewestTriangles"] = lod.triangles();
    }
    json["morphTargets"] = model.target_count();
    json["materials"] = model.materials().size();
    json["textures"] = model.textures().size();
    json["clips"] = list_clips(model);
}

}  // namespace

Json converted_report(const std::filesystem::path& input, const std::filesystem::path& output,
                      const converter::Report& report, Bytes bytes) {
    Json json = start(input, output, "converted");
    json["bytes"] = bytes.size();
    if (const Result<Model> model = Model::from_memory(bytes)) add_contents(json, *model);
    if (report.compact) json["compact"] = describe_compact(*report.compact);
    add_remarks(json, report);
    return json;
}

Json up_to_date_report(const std::filesystem::path& input, const std::filesystem::path& output) {
    return start(input, output, "upToDate");
}

Json failed_report(const std::filesystem::path& input, const std::filesystem::path& output,
                   const converter::Report& report, const std::filesystem::path& file, const std::string& what) {
    Json json = start(input, output, "failed");
    json["error"] = {{"file", file.string()}, {"message", what}};
    add_remarks(json, report);
    return json;
}

void print_report(const Json& report) {
    std::cout << report.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace bendy::cli
