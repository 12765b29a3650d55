#pragma once

#include "camera.h"

#include <glm/vec3.hpp>

#include <array>
#include <vector>

// How surfaces are shaded: the light, what they mirror of it, and the shaders, GLSL 3.30.

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

/// What a rough surface mirrors of light that comes evenly from everywhere is f0 * scale + f90 * bias. `side` rows of
/// `side` pairs (scale, bias): entry (i, j) is for perceptual roughness (i + 0.5) / side and a cosine between normal
/// and view of (j + 0.5) / side. GGX with the height-correlated Smith term and Schlick's Fresnel term, as glTF 2.0's
/// appendix B has them; integrated as in Karis, "Real shading in Unreal Engine 4", 2013.
std::vector<float> reflectance_table(unsigned side);

/// Morph targets and skinning as bendy::skin does it; everything that draws the character's vertices uses it. Takes the
/// inputs of GpuVertex, the buffers of SceneBuffers, `view_projection`.
extern const char* const kSkinShader;
/// Metallic-roughness after glTF 2.0, appendix B, lit by a key light and a simple sky.
extern const char* const kSurfaceShader;
/// One colour.
extern const char* const kFlatShader;
/// Each vertex's number, 24 bits in red, green and blue.
extern const char* const kNumberShader;
/// The overlay's triangles, and its lines, which are given as triangles that are made as wide as wanted here.
extern const char* const kOverlayVertexShader;
extern const char* const kOverlayShader;

}  // namespace bendy::viewer
