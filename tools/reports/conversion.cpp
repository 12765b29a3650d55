#include "reports/conversion.h"

#include "reports/json.h"

#include <bendy/runtime.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <thread>
#include <type_traits>

namespace bendy::tools {
namespace {

using Json = OrderedJson;

Json start(const std::filesystem::path& input, const std::filesystem::path& output, const char* status) {
    return {{"status", status}, {"input", input.string()}, {"output", output.string()}};
}

void add_remarks(Json& json, const converter::Report& report) {
    Json warnings = Json::array();
    for (const converter::Warning& warning : report.warnings())
        warnings.push_back({{"message", warning.message}, {"place", warning.first_place}, {"count", warning.count}});
    json["warnings"] = std::move(warnings);
    Json& proposals = json["proposals"] = Json::array();
    for (const converter::Proposal& proposal : report.proposals()) proposals.push_back(proposal.line);
    json["suggestions"] = report.suggestions();
}

Json list_clips(const Model& model) {
    Json clips = Json::array();
    for (const Clip& clip : model.clips()) {
        const double start = clip.start;
        clips.push_back({{"name", clip.name}, {"start", start}, {"seconds", static_cast<double>(clip.end) - start}});
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
    if (report.lod_bytes) json["lodBytes"] = *report.lod_bytes;
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
    json["meshes"] = model.meshes().size();
    json["vertices"] = model.vertex_count();
    json["triangles"] = lod.triangles();
    if (model.collapse() != nullptr) {
        lod.set_share(0.0f);
        json["fewestTriangles"] = lod.triangles();
    }
    json["morphTargets"] = model.morph_target_count();
    json["materials"] = model.materials().size();
    json["textures"] = model.textures().size();
    json["clips"] = list_clips(model);
}

}  // namespace

converter::ConvertOptions options_of(const ConvertArguments& arguments) {
    converter::ConvertOptions options;
    if (!arguments.scene.empty()) options.gltf.scene = arguments.scene;
    options.gltf.embed_images = arguments.images == "embed";
    options.gltf.instances = arguments.instances;
    options.gltf.root = arguments.root;
    if (!arguments.rig.empty()) options.rig = arguments.rig;
    options.texture = arguments.texture;
    options.ticks_per_second = arguments.ticks_per_second;
    options.unit = arguments.unit;
    options.up = arguments.up == "y"   ? converter::SourceUp::y
                 : arguments.up == "z" ? converter::SourceUp::z
                                       : converter::SourceUp::found;
    options.faces_front = arguments.face == "front";
    options.merge_clips = arguments.merge_clips;
#ifdef BENDY_AUTO_RIG
    options.auto_rig = arguments.auto_rig;
#endif
    options.auto_skin = arguments.auto_skin || !arguments.skeleton.empty();
    options.skeleton = arguments.skeleton;
    if (arguments.compact) options.compact = converter::ErrorBound();
    if (!arguments.max_error.empty()) options.compact = *converter::parse_error_bound(arguments.max_error);
    options.exact = arguments.exact;
    options.drop_unused = arguments.drop_unused;
    options.lod = arguments.lod;
    options.keep_order = arguments.keep_order;
    options.threads = jobs_of(arguments.jobs);
    return options;
}

unsigned jobs_of(unsigned asked) {
    return std::max(asked != 0 ? asked : std::thread::hardware_concurrency(), 1u);
}

std::string recipe_of(const ConvertArguments& arguments) {
    Json recipe{{"bendy", BENDY_VERSION}};
    visit_options(arguments, [&](const ConvertOption& option, const auto& value) {
        Json& place = recipe[std::string(option.name)];
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, option::path>) {
            place = value.empty() ? std::string() : std::filesystem::absolute(value).string();
        } else {
            place = value;
        }
    });
    return json_text(recipe);
}

Json converted_report(const std::filesystem::path& input, const std::filesystem::path& output,
                      const converter::Report& report, Bytes bytes) {
    Json json = start(input, output, "converted");
    json["bytes"] = bytes.size();
    if (const Result<Model> model = Model::from_memory(bytes)) add_contents(json, *model);
    if (report.compact) json["compact"] = describe_compact(*report.compact);
    Json embedded = Json::array();
    for (const converter::EmbeddedFile& file : report.embedded())
        embedded.push_back({{"file", file.file.string()}, {"bytes", file.size}, {"mediaType", file.media_type}});
    json["embedded"] = std::move(embedded);
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

}  // namespace bendy::tools
