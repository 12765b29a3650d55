#include <bendy/format/processor.h>

#if defined(BENDY_X86_64)

#if defined(_MSC_VER)
#include <immintrin.h>
#include <intrin.h>
#endif

namespace bendy {

#if defined(_MSC_VER)

bool processor_has(Instructions wanted) {
    // "Intel 64 and IA-32 Architectures Software Developer's Manual", CPUID: leaf 1, ECX, and leaf 7, EBX.
    int registers[4];  // EAX, EBX, ECX, EDX
    __cpuid(registers, 1);
    const auto has = [&](int number, int bit) { return (registers[number] >> bit & 1) != 0; };
    if (wanted == Instructions::sse4_1) return has(2, 19);
    if (wanted == Instructions::sse4_2) return has(2, 20);
    const bool has_fma = has(2, 12);
    const bool has_avx = has(2, 28) && has(2, 27) && (_xgetbv(0) & 6) == 6;  // OSXSAVE; XMM and YMM are saved
    __cpuid(registers, 0);
    if (!has_fma || !has_avx || registers[0] < 7) return false;
    __cpuidex(registers, 7, 0);
    return has(1, 5);
}

#else

bool processor_has(Instructions wanted) {
    switch (wanted) {
        case Instructions::sse4_1:
            return __builtin_cpu_supports("sse4.1") != 0;
        case Instructions::sse4_2:
            return __builtin_cpu_supports("sse4.2") != 0;
        case Instructions::avx2_and_fma:
            return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
    }
    return false;
}

#endif

}  // namespace bendy

#endif
