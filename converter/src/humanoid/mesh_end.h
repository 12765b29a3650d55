#pragma once

#include "rest_frames.h"

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>

namespace bendy::converter {

/// Where what a joint carries ends, at rest in model space: the point as far from the joint as the vertices that it
/// moves most reach, towards their middle. For a last bone that has no joint at its tip. Nothing if it carries nothing.
std::optional<glm::dvec3> find_mesh_end(const Scene& scene, const RestFrames& rest, std::uint32_t joint);

}  // namespace bendy::converter
