#include "gl.h"

#include <bendy/viewer/viewer_error.h>

#include <string>

namespace bendy::viewer::gl {

void load(Lookup lookup) {
#define BENDY_GL(capitals, name)                                        \
    name = reinterpret_cast<PFNGL##capitals##PROC>(lookup("gl" #name)); \
    if ((name) == nullptr) throw ViewerError("OpenGL 3.3 lacks gl" #name);
#include "gl_functions.def"
#undef BENDY_GL
}

}  // namespace bendy::viewer::gl
