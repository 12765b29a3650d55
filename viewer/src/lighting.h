#pragma once

#include "camera.h"

#include <glm/vec3.hpp>

#include <array>

namespace bendy::viewer {

/// The light that characters stand in: docs/viewer.md tells its numbers, so that others can draw the same picture.
struct Lighting {
    std::array<glm::vec3, 2> directions;  ///< towards the lights, unit
    std::array<float, 2> irradiance;      ///< of a surface that faces the light
    float sky = 0.6f;                     ///< irradiance of a surface that faces up, ...
    float ground = 0.15f;                 ///< ... and of one that faces down
    float environment = 0.22f;            ///< radiance from everywhere, mirrored too
};

/// Both lights turn with the camera: one from over its left shoulder, a weaker one from behind the character.
Lighting lighting_for(const Camera& camera);

}  // namespace bendy::viewer
