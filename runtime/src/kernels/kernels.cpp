#include <bendy/runtime/kernels.h>

#include "kernel_table.h"

#include <bendy/format/processor.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdlib>

namespace bendy {
namespace {

constexpr std::array<std::string_view, 5> kNames{"plain", "sse4", "avx2", "neon", "wasm"};

struct Available {
    std::array<Kernel, kNames.size()> kernels{};
    std::size_t count = 0;
    void add(Kernel kernel) { kernels[count++] = kernel; }
};

Available find_available() {
    Available found;
#if defined(BENDY_X86_64)
    if (processor_has(Instructions::avx2_and_fma)) found.add(Kernel::avx2);
    if (processor_has(Instructions::sse4_1)) found.add(Kernel::sse4);
#elif defined(BENDY_ARM64)
    found.add(Kernel::neon);
#elif defined(BENDY_WASM_SIMD)
    found.add(Kernel::wasm);
#endif
    found.add(Kernel::plain);
    return found;
}

Kernel first_choice() {
    const char* const wanted = std::getenv("BENDY_KERNEL");
    if (wanted != nullptr) {
        for (const Kernel kernel : kernels()) {
            if (kernel_name(kernel) == wanted) return kernel;
        }
    }
    return kernels().front();
}

std::atomic<Kernel>& chosen() {
    static std::atomic<Kernel> kernel = first_choice();
    return kernel;
}

}  // namespace

std::span<const Kernel> kernels() {
    static const Available available = find_available();
    return std::span(available.kernels).first(available.count);
}

std::string_view kernel_name(Kernel kernel) {
    return kNames[static_cast<std::size_t>(kernel)];
}

Kernel kernel() {
    return chosen().load(std::memory_order_relaxed);
}

Result<void, CallError> set_kernel(Kernel kernel) {
    const auto available = kernels();
    if (std::find(available.begin(), available.end(), kernel) == available.end()) return CallError::not_available;
    chosen().store(kernel, std::memory_order_relaxed);
    return {};
}

const KernelTable& kernel_table(Kernel kernel) {
    switch (kernel) {
#if defined(BENDY_X86_64)
        case Kernel::sse4:
            return kSse4Table;
        case Kernel::avx2:
            return kAvx2Table;
#elif defined(BENDY_ARM64)
        case Kernel::neon:
            return kNeonTable;
#elif defined(BENDY_WASM_SIMD)
        default:
            return kWasmTable;  // plain, too: it rounds in the same way, and modules are small
#endif
#if !defined(BENDY_WASM_SIMD)
        default:
            return kPlainTable;
#endif
    }
}

const KernelTable& kernel_table() {
    return kernel_table(kernel());
}

}  // namespace bendy
