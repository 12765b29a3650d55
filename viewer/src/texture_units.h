#pragma once

#include <epoxy/gl.h>

namespace bendy::viewer {

/// Which texture unit holds what. OpenGL 3.3 has at least 16 in the fragment stage and 16 in the vertex stage.
enum TextureUnit : GLuint {
    kMaterialUnit = 0,  ///< and the four after it: base colour, metallic-roughness, normal, occlusion, emissive
    kReflectanceUnit = 5,
    kPaletteUnit = 8,
    kInfluenceUnit = 9,
    kDisplacementUnit = 10,
    kWeightUnit = 11,
    kUploadUnit = 15,  ///< where textures are filled: whatever is bound for drawing stays bound
};

}  // namespace bendy::viewer
