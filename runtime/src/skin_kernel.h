#pragma once

#include <bendy/runtime/kernels.h>

#include "skin_block.h"

namespace bendy {

/// The function of one of kernels().
inline SkinKernel* skin_kernel(Kernel kernel) {
    switch (kernel) {
#if defined(__x86_64__)
        case Kernel::sse4:
            return skin_sse4;
        case Kernel::avx2:
            return skin_avx2;
        case Kernel::avx512:
            return skin_avx512;
#elif defined(__aarch64__)
        case Kernel::neon:
            return skin_neon;
#elif defined(__wasm_simd128__)
        case Kernel::wasm:
            return skin_wasm;
#endif
        default:
            return skin_plain;
    }
}

/// Null for the plain one.
inline DualKernel* dual_kernel(Kernel kernel) {
    switch (kernel) {
#if defined(__x86_64__)
        case Kernel::sse4:
            return dual_sse4;
        case Kernel::avx2:
            return dual_avx2;
        case Kernel::avx512:
            return dual_avx512;
#elif defined(__aarch64__)
        case Kernel::neon:
            return dual_neon;
#elif defined(__wasm_simd128__)
        case Kernel::wasm:
            return dual_wasm;
#endif
        default:
            return nullptr;
    }
}

}  // namespace bendy
