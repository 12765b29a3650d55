#pragma once

#include "kernels/kernel_table.h"

#include <bendy/runtime/kernels.h>

#include <string>
#include <vector>

namespace bendy {

namespace test {

/// Kernels that are tested.
struct Tried {
    std::string name;
    SkinKernel* linear;
    DualKernel* dual;
};

/// All that this machine has.
inline std::vector<Tried> tried_kernels() {
    std::vector<Tried> all;
    for (const Kernel kernel : kernels()) {
        const KernelTable& table = kernel_table(kernel);
        all.push_back({std::string(kernel_name(kernel)), table.skin, table.dual});
    }
    return all;
}

}  // namespace test
}  // namespace bendy
