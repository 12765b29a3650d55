#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>

#include <cstdint>
#include <span>
#include <string_view>

// Kernels: the implementations of the bulk of the arithmetic; see skin.
namespace BENDY_PUBLIC bendy {

enum class Kernel : std::uint8_t {
    plain,  ///< four lanes in portable C++: the same bits on every machine
    sse4,   ///< four lanes, SSE 4.1
    avx2,   ///< eight lanes, AVX2 and FMA
    neon,   ///< four lanes, 64-bit ARM
    wasm,   ///< four lanes, WebAssembly SIMD
};

/// Returns the kernels that this program contains and this machine can run, fastest first; plain is the last.
[[nodiscard]] std::span<const Kernel> kernels();

/// "plain", "sse4", ...
[[nodiscard]] std::string_view kernel_name(Kernel kernel);

/// Returns the kernel in use: the first of kernels(), unless the environment variable BENDY_KERNEL named another of
/// them at the first call, or set_kernel has changed it.
[[nodiscard]] Kernel kernel();

/// Selects a kernel, with immediate effect in every thread. Returns an error, and changes nothing, if it is not one of
/// kernels().
[[nodiscard]] Result<void, CallError> set_kernel(Kernel kernel);

}  // namespace bendy
