#pragma once

#include "compact/leaf_writer.h"

#include <bendy/converter/scene.h>

namespace bendy::converter {

/// Writes a clip's curves, one CURV each; those of a compact file packed where that is smaller.
void put_curves(LeafWriter& out, const Clip& clip);

}  // namespace bendy::converter
