#pragma once

#include <GL/glcorearb.h>

// OpenGL 3.3 core. The functions are looked up when a context is there: linking against one GL library would bind the
// program to it, and EGL, OSMesa and a window each bring their own.
namespace bendy::viewer::gl {

// NOLINTBEGIN(readability-identifier-naming): as the registry spells them, without the gl in front
#define BENDY_GL(capitals, name) inline PFNGL##capitals##PROC name = nullptr;
#include "gl_functions.def"
#undef BENDY_GL
// NOLINTEND(readability-identifier-naming)

using AnyFunction = void (*)();
using Lookup = AnyFunction (*)(const char* name);

/// Looks up all functions for the current context. Throws ViewerError if one is missing.
void load(Lookup lookup);

}  // namespace bendy::viewer::gl
