#pragma once

// GLSL 3.30 sources.
namespace bendy::viewer {

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
