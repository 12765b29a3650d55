#pragma once

#include "skin_kernel.h"

#include <string>
#include <vector>

namespace bendy {

SkinKernel skin_sixteen;  // skin_sixteen.cpp
DualKernel dual_sixteen;

namespace test {

/// Kernels that are tested.
struct Tried {
    std::string name;
    SkinKernels run;
};

/// All that this machine has, the plain one too, and the sixteen lanes of AVX-512 in halves if it has none.
inline std::vector<Tried> tried_kernels() {
    std::vector<Tried> all;
    for (const Kernel kernel : kernels()) all.push_back({std::string(kernel_name(kernel)), skin_kernels(kernel)});
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0)
        all.push_back({"sixteen lanes in halves", {skin_sixteen, dual_sixteen}});
#endif
    return all;
}

}  // namespace test
}  // namespace bendy
