#pragma once

#include "kernels/skin_kernel.h"

#include <string>
#include <vector>

namespace bendy {

namespace test {

/// Kernels that are tested.
struct Tried {
    std::string name;
    SkinKernels run;
};

/// All that this machine has, the plain one too.
inline std::vector<Tried> tried_kernels() {
    std::vector<Tried> all;
    for (const Kernel kernel : kernels()) all.push_back({std::string(kernel_name(kernel)), skin_kernels(kernel)});
    return all;
}

}  // namespace test
}  // namespace bendy
