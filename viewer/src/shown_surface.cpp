#include "shown_surface.h"

#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>

namespace bendy::viewer {
namespace {

/// A number of an extension, at least 0; nothing where there is none that has a meaning.
std::optional<float> number_of(const nlohmann::json& value) {
    if (!value.is_number()) return std::nullopt;
    const auto number = value.get<float>();
    return std::isfinite(number) && number >= 0.0f ? std::optional(number) : std::nullopt;
}

nlohmann::json member(const nlohmann::json& object, const char* key) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? nlohmann::json() : *found;
}

ShownSurface shown_surface(const MaterialView& material) {
    ShownSurface surface{material.surface};
    if (material.extensions.empty()) return surface;
    const auto extensions = nlohmann::json::parse(material.extensions, nullptr, false);
    const float strength =
        number_of(member(member(extensions, "KHR_materials_emissive_strength"), "emissiveStrength")).value_or(1.0f);
    for (float& colour : surface.record.emissive) colour *= strength;

    // 0 stands for an index without end: everything is mirrored.
    const float ior = number_of(member(member(extensions, "KHR_materials_ior"), "ior")).value_or(1.5f);
    const float from_ahead = ior == 0.0f ? 1.0f : (ior - 1.0f) / (ior + 1.0f);
    const nlohmann::json specular = member(extensions, "KHR_materials_specular");
    glm::vec3 colour(1.0f);
    const nlohmann::json factors = member(specular, "specularColorFactor");
    for (int k = 0; k < 3 && factors.is_array() && factors.size() == 3; ++k)
        colour[k] = number_of(factors[static_cast<std::size_t>(k)]).value_or(1.0f);
    surface.dielectric_at_grazing = std::min(number_of(member(specular, "specularFactor")).value_or(1.0f), 1.0f);
    surface.dielectric = glm::min(from_ahead * from_ahead * colour, glm::vec3(1.0f)) * surface.dielectric_at_grazing;
    return surface;
}

}  // namespace

std::vector<ShownSurface> shown_surfaces(const Model& model) {
    std::vector<ShownSurface> surfaces;
    for (const MaterialView& material : model.materials()) surfaces.push_back(shown_surface(material));
    surfaces.emplace_back();
    return surfaces;
}

}  // namespace bendy::viewer
