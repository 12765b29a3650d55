#pragma once

#include <bendy/format/public.h>

#include <cstdint>

/// The target processor, if there are kernels for it: see bendy/runtime/kernels.h.
#if defined(__x86_64__) || (defined(_M_X64) && !defined(_M_ARM64EC))
#define BENDY_X86_64
#elif defined(__aarch64__) || defined(_M_ARM64)
#define BENDY_ARM64
#elif defined(__wasm_simd128__)
#define BENDY_WASM_SIMD
#endif

#if defined(BENDY_X86_64)
namespace BENDY_PUBLIC bendy {

enum class Instructions : std::uint8_t { sse4_1, sse4_2, avx2_and_fma };

/// Returns whether the machine's processor has these instructions, and the system saves their registers.
bool processor_has(Instructions wanted);

}  // namespace bendy
#endif
