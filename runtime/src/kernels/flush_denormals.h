#pragma once

#include <bendy/format/processor.h>

#if defined(BENDY_X86_64)
#include <xmmintrin.h>
#endif

namespace bendy {

/// During its lifetime, this thread treats denormal numbers as zero: on x86-64, they cost a hundred cycles each. For
/// kernels; the plain one has the same results everywhere.
class FlushDenormals {
public:
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals(FlushDenormals&&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;
    FlushDenormals& operator=(FlushDenormals&&) = delete;

#if defined(BENDY_X86_64)
    FlushDenormals() : before_(_mm_getcsr()) {
        _mm_setcsr(before_ | kFlushToZero | kDenormalsAreZero);
    }
    ~FlushDenormals() {
        _mm_setcsr((before_ & ~kFlags) | (_mm_getcsr() & kFlags));
    }

private:
    static constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x40;
    static constexpr unsigned kFlags = 0x3f;  ///< exception flags: changing one takes as long as blending a pose
    unsigned before_;
#else
    FlushDenormals() {}   // NOLINT(modernize-use-equals-default): or compilers warn of unused variables
    ~FlushDenormals() {}  // NOLINT(modernize-use-equals-default)
#endif
};

}  // namespace bendy
