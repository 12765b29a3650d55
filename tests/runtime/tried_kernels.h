#pragma once

#include "kernels/kernel_table.h"
#include "kernels/plain.h"

#include <bendy/runtime/kernels.h>

#include <string>
#include <vector>

namespace bendy {

namespace test {

/// Kernels that are tested.
struct Tried {
    std::string name;
    SkinKernel* linear;
    DualKernel* dual;  ///< null for the plain one: see dual_plain
};

/// All that this machine has, the plain one too.
inline std::vector<Tried> tried_kernels() {
    std::vector<Tried> all;
    for (const Kernel kernel : kernels()) {
        const KernelTable* const table = kernel_table(kernel);
        all.push_back({std::string(kernel_name(kernel)), table == nullptr ? skin_plain : table->skin,
                       table == nullptr ? nullptr : table->dual});
    }
    return all;
}

}  // namespace test
}  // namespace bendy
