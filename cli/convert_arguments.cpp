#include "convert_arguments.h"

#include <nlohmann/json.hpp>

namespace bendy::cli {

converter::ConvertOptions options_of(const ConvertArguments& arguments) {
    converter::ConvertOptions options;
    if (!arguments.scene.empty()) options.gltf.scene = arguments.scene;
    options.gltf.embed_images = arguments.images == "embed";
    options.gltf.instances = arguments.instances;
    if (!arguments.rig.empty()) options.rig = arguments.rig;
    options.ticks_per_second = arguments.ticks_per_second;
    options.merge_clips = arguments.merge_clips;
    options.auto_rig = arguments.auto_rig;
    options.auto_skin = arguments.auto_skin || !arguments.skeleton.empty();
    options.skeleton = arguments.skeleton;
    if (arguments.compact) options.compact = converter::ErrorBound();
    if (!arguments.max_error.empty()) options.compact = *converter::parse_error_bound(arguments.max_error);
    options.lod = arguments.lod;
    options.sort_vertices = arguments.sort_vertices;
    return options;
}

std::string recipe_of(const ConvertArguments& arguments) {
    const nlohmann::json recipe{{"bendy", BENDY_VERSION},
                                {"scene", arguments.scene},
                                {"images", arguments.images},
                                {"instances", arguments.instances},
                                {"rig", arguments.rig.empty() ? "" : std::filesystem::absolute(arguments.rig).string()},
                                {"ticks_per_second", arguments.ticks_per_second},
                                {"merge_clips", arguments.merge_clips},
                                {"auto_rig", arguments.auto_rig},
                                {"auto_skin", arguments.auto_skin},
                                {"skeleton", arguments.skeleton},
                                {"compact", arguments.compact},
                                {"max_error", arguments.max_error},
                                {"lod", arguments.lod},
                                {"sort_vertices", arguments.sort_vertices}};
    return recipe.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace bendy::cli
