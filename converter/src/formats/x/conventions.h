#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace bendy::converter::x {

/// Encodes text as a string of an X-file. Such strings have no escapes, and some readers treat them as code: every byte
/// except letters, digits, `-_.:+` and spaces becomes a percent sign and two hexadecimal digits; non-ASCII UTF-8 is
/// kept.
std::string encode_text(std::string_view text);

/// Decodes the text; a percent sign without two digits is kept.
std::string decode_text(std::string_view text);

// Colours in X-files are display colours: Direct3D's fixed pipeline adds and multiplies them as they are, and shows the
// result (docs/decisions/0029). Here, as in glTF, factors and vertex colours are linear light. Uses only sums,
// products, quotients and square roots: the same bits on every machine.

/// sRGB to linear light. Above 1 the curve is continued; values below 0 are unchanged.
float to_light(float display);
/// Linear light to sRGB.
float to_display(float light);

glm::vec3 to_light(const glm::vec3& display);
glm::vec3 to_display(const glm::vec3& light);
/// Alpha is unchanged.
glm::vec4 to_light(const glm::vec4& display);
glm::vec4 to_display(const glm::vec4& light);

// X-files are left-handed, Z into the screen; a Scene is right-handed. Readers and writers mirror along Z. A zero stays
// a positive zero.

inline glm::vec3 mirrored(const glm::vec3& vector) {
    return {vector.x, vector.y, 0.0f - vector.z};
}

/// S * M * S with S = diag(1, 1, -1, 1): elements that map Z to another axis, or another axis to Z, change sign.
inline std::array<double, 16> mirrored(std::array<double, 16> matrix) {
    for (const std::size_t element : {2u, 6u, 8u, 9u, 11u, 14u}) matrix[element] = 0.0 - matrix[element];
    return matrix;
}

}  // namespace bendy::converter::x
