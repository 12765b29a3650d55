#pragma once

#include <bendy/runtime.h>

#include <glm/vec3.hpp>

#include <vector>

namespace bendy::viewer {

/// A material's surface as it is drawn: also what the numbers of some extensions say, which the file keeps as text.
struct ShownSurface {
    SurfaceRecord record;                ///< its emissive colour with KHR_materials_emissive_strength
    glm::vec3 dielectric{0.04f};         ///< what a surface that is no metal mirrors, seen from straight ahead, ...
    float dielectric_at_grazing = 1.0f;  ///< ... and at a grazing angle: KHR_materials_ior, KHR_materials_specular
};

/// Of each material; and one more at the end, glTF's default one, for what has no material.
std::vector<ShownSurface> shown_surfaces(const Model& model);

}  // namespace bendy::viewer
