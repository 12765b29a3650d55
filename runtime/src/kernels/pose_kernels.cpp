#include "pose_kernels.h"

#include <bendy/format/public.h>
#include <bendy/runtime/kernels.h>

namespace bendy {

const PoseKernels* pose_kernels() {
    switch (kernel()) {
#if defined(BENDY_GNU) && defined(__x86_64__)
        case Kernel::sse4:
            return &kPoseSse4;
        case Kernel::avx2:
            return &kPoseAvx2;
#elif defined(BENDY_GNU) && defined(__aarch64__)
        case Kernel::neon:
            return &kPoseNeon;
#elif defined(BENDY_GNU) && defined(__wasm_simd128__)
        case Kernel::wasm:
            return &kPoseWasm;
#endif
        default:
            return nullptr;
    }
}

}  // namespace bendy
