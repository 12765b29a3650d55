#pragma once

#include "x_file.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <filesystem>

namespace bendy::converter::x {

/// Fills Scene::materials, textures and images. \param file  beside which images are looked for
void import_materials(const XFile& source, const std::filesystem::path& file, bool embed_images, Scene& scene,
                      Report& report);

/// How much of the light a surface that is no metal throws straight back.
inline constexpr float kDielectric = 0.04f;

/// Phong's exponent and the roughness that shines as wide, 0 to 1 (Blinn-Phong and Beckmann: n = 2 / r^4 - 2).
float roughness_of(float power);
float power_of(float roughness);

}  // namespace bendy::converter::x
