#pragma once

#include <bendy/format/processor.h>
#include <bendy/runtime/kernels.h>

#include "plan/skin_block.h"

namespace bendy {

struct SkinKernels {
    SkinKernel* linear;
    DualKernel* dual;  ///< null for the plain one: see dual_plain
};

/// Returns the functions of one of kernels().
inline SkinKernels skin_kernels(Kernel kernel) {
    switch (kernel) {
#if defined(BENDY_X86_64)
        case Kernel::sse4:
            return {skin_sse4, dual_sse4};
        case Kernel::avx2:
            return {skin_avx2, dual_avx2};
#elif defined(BENDY_ARM64)
        case Kernel::neon:
            return {skin_neon, dual_neon};
#elif defined(BENDY_WASM_SIMD)
        case Kernel::wasm:
            return {skin_wasm, dual_wasm};
#endif
        default:
            return {skin_plain, nullptr};
    }
}

}  // namespace bendy
