#pragma once

#include <bendy/format/public.h>

namespace BENDY_PUBLIC bendy {

// Plain data only, since kernels for other processors include this.

/// Rows of a 3x4 matrix, mesh space to model space: the transform that a bone applies to vertices. Fills a cache line.
struct alignas(64) PaletteMatrix {
    float rows[3][4];
    float unused[4];
};

}  // namespace bendy
