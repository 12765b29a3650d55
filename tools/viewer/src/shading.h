#pragma once

#include "camera.h"

#include <glm/vec3.hpp>

#include <array>
#include <vector>

// Shading: the lights, the reflectance table, and the shaders (GLSL 3.30).

namespace bendy::viewer {

/// The lights. docs/viewer.md has the same numbers, so that other programs can draw the same picture.
struct Lighting {
    std::array<glm::vec3, 2> directions;  ///< towards the lights, unit
    std::array<float, 2> irradiance;      ///< of a surface that faces the light
    float sky = 0.6f;                     ///< irradiance of a surface that faces up, ...
    float ground = 0.15f;                 ///< ... and of one that faces down
    float environment = 0.22f;            ///< radiance from all directions, also reflected
};

/// Both lights turn with the camera: one from over its left shoulder, a weaker one from behind the character.
Lighting lighting_for(const Camera& camera);

/// A rough surface reflects f0 * scale + f90 * bias of uniform light. Returns `side` rows of `side` pairs (scale,
/// bias): entry (i, j) is for cosine (i + 0.5) / side between normal and view, and perceptual roughness (j + 0.5) /
/// side. It integrates GGX with the height-correlated Smith term and Schlick's Fresnel term, as in glTF 2.0, appendix
/// B, by the method of Karis, "Real shading in Unreal Engine 4", 2013.
std::vector<float> reflectance_table(unsigned side);

/// Morph targets and skinning, as in bendy::skin, for everything that draws the character's vertices. Its inputs are
/// GpuVertex, the buffers of SceneBuffers and `view_projection`.
extern const char* const kSkinShader;
/// The metallic-roughness model of glTF 2.0, appendix B, under the lights above.
extern const char* const kSurfaceShader;
/// One colour.
extern const char* const kFlatShader;
/// Each vertex's number, 24 bits in red, green and blue.
extern const char* const kNumberShader;
/// The overlay's triangles and lines; it widens lines, which are stored as triangles, to their width in pixels.
extern const char* const kOverlayVertexShader;
extern const char* const kOverlayShader;

}  // namespace bendy::viewer
