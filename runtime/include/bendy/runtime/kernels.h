#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>

#include <cstdint>
#include <span>
#include <string_view>

// The ways in which this program can do the bulk of its arithmetic: see skin.
namespace BENDY_PUBLIC bendy {

enum class Kernel : std::uint8_t {
    plain,  ///< one number at a time; the reference that the others are tested against
    sse4,   ///< four lanes, SSE 4.1
    avx2,   ///< eight lanes, AVX2 and FMA
    neon,   ///< four lanes, 64-bit ARM
    wasm,   ///< four lanes, WebAssembly SIMD
};

/// Those that this program holds and this machine can run, the quickest that is known first; plain is the last.
[[nodiscard]] std::span<const Kernel> kernels();

/// "plain", "sse4", ...
[[nodiscard]] std::string_view kernel_name(Kernel kernel);

/// The one in use: the first of kernels(), unless the environment variable BENDY_KERNEL named another one of kernels()
/// when this was first asked, or set_kernel has changed it.
[[nodiscard]] Kernel kernel();

/// From now on, in every thread. An error, and nothing changes, if it is not one of kernels().
[[nodiscard]] Result<void, CallError> set_kernel(Kernel kernel);

}  // namespace bendy
