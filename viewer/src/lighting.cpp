#include "lighting.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace bendy::viewer {
namespace {

glm::vec3 towards(float yaw, float height) {
    return glm::normalize(glm::vec3(std::sin(yaw), height, std::cos(yaw)));
}

}  // namespace

Lighting lighting_for(const Camera& camera) {
    Lighting lighting;
    lighting.directions = {towards(camera.yaw() - 0.7f, 0.85f), towards(camera.yaw() + 2.4f, 0.6f)};
    lighting.irradiance = {2.4f, 1.2f};
    return lighting;
}

}  // namespace bendy::viewer
