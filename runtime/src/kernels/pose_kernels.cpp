#include "pose_kernels.h"

#include <bendy/format/processor.h>
#include <bendy/runtime/kernels.h>

namespace bendy {

const PoseKernels* pose_kernels() {
    switch (kernel()) {
#if defined(BENDY_X86_64)
        case Kernel::sse4:
            return &kPoseSse4;
        case Kernel::avx2:
            return &kPoseAvx2;
#elif defined(BENDY_ARM64)
        case Kernel::neon:
            return &kPoseNeon;
#elif defined(BENDY_WASM_SIMD)
        case Kernel::wasm:
            return &kPoseWasm;
#endif
        default:
            return nullptr;
    }
}

}  // namespace bendy
