#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace bendy::converter::x {

// Colours in X-files are those of the screen: Direct3D's fixed pipeline adds and multiplies them as they are, and shows
// the result (docs/decisions/0029). Here, as in glTF, factors and colours of vertices are linear light. Only sums,
// products, quotients and square roots: the same bits on every machine.

/// sRGB to linear light. Above 1 the curve goes on; below 0 the number stays.
float to_light(float display);
/// Linear light to sRGB.
float to_display(float light);

glm::vec3 to_light(const glm::vec3& display);
glm::vec3 to_display(const glm::vec3& light);
/// Alpha stays.
glm::vec4 to_light(const glm::vec4& display);
glm::vec4 to_display(const glm::vec4& light);

}  // namespace bendy::converter::x
