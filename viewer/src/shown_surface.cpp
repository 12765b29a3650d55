#include "shown_surface.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <string_view>

namespace bendy::viewer {
namespace {

/// 1 where the extensions say nothing, or nothing that has a meaning.
float emissive_strength(std::string_view extensions) {
    if (extensions.empty()) return 1.0f;
    const auto json = nlohmann::json::parse(extensions, nullptr, false);
    const nlohmann::json* value = &json;
    for (const char* key : {"KHR_materials_emissive_strength", "emissiveStrength"}) {
        if (!value->is_object()) return 1.0f;
        const auto found = value->find(key);
        if (found == value->end()) return 1.0f;
        value = &*found;
    }
    const float strength = value->is_number() ? value->get<float>() : 1.0f;
    return std::isfinite(strength) && strength >= 0.0f ? strength : 1.0f;
}

}  // namespace

std::vector<SurfaceRecord> shown_surfaces(const Model& model) {
    std::vector<SurfaceRecord> surfaces;
    for (const auto& material : model.materials()) {
        surfaces.push_back(material.surface);
        const float strength = emissive_strength(material.extensions);
        for (float& colour : surfaces.back().emissive) colour *= strength;
    }
    surfaces.emplace_back();
    return surfaces;
}

}  // namespace bendy::viewer
