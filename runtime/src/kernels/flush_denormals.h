#pragma once

#include <bendy/format/processor.h>

#if defined(BENDY_X86_64)
#include <xmmintrin.h>
#endif

namespace bendy {

/// During its lifetime, if `wanted`, this thread treats denormal numbers as zero: on x86-64, they cost a hundred cycles
/// each. See KernelTable::flushes_denormals.
class FlushDenormals {
public:
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals(FlushDenormals&&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;
    FlushDenormals& operator=(FlushDenormals&&) = delete;

#if defined(BENDY_X86_64)
    explicit FlushDenormals(bool wanted) : wanted_(wanted), before_(wanted ? _mm_getcsr() : 0) {
        if (wanted_) _mm_setcsr(before_ | kFlushToZero | kDenormalsAreZero);
    }
    ~FlushDenormals() {
        if (wanted_) _mm_setcsr((before_ & ~kFlags) | (_mm_getcsr() & kFlags));
    }

private:
    static constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x40;
    static constexpr unsigned kFlags = 0x3f;  ///< exception flags: changing one takes as long as blending a pose
    bool wanted_;
    unsigned before_;
#else
    explicit FlushDenormals(bool) {}
    ~FlushDenormals() {}  // NOLINT(modernize-use-equals-default): or compilers warn of unused variables
#endif
};

}  // namespace bendy
