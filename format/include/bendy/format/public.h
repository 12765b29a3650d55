#pragma once

/// Defined if the sources may use extensions of GCC and clang: attributes and built-in functions. Define
/// BENDY_STANDARD_CPP for compilers without them.
#if defined(__GNUC__) && !defined(BENDY_STANDARD_CPP)
#define BENDY_GNU
#endif

/// `inline`, and when optimising for speed a command rather than a hint: for functions whose call costs as much as
/// their work. And its opposite, for rarely called functions that would bloat the surrounding code.
#if defined(BENDY_GNU) && defined(__OPTIMIZE_SIZE__)
#define BENDY_ALWAYS_INLINE inline
#define BENDY_NOINLINE [[gnu::noinline]]
#elif defined(BENDY_GNU)
#define BENDY_ALWAYS_INLINE [[gnu::always_inline]] inline
#define BENDY_NOINLINE [[gnu::noinline]]
#elif defined(_MSC_VER)
#define BENDY_ALWAYS_INLINE __forceinline
#define BENDY_NOINLINE __declspec(noinline)
#else
#define BENDY_ALWAYS_INLINE inline
#define BENDY_NOINLINE
#endif

/// Marks a namespace block whose declarations the shared libraries export: `namespace BENDY_PUBLIC bendy {`. Nothing
/// else is exported; see docs/decisions/0024-what-the-shared-libraries-export.md.
#if defined(BENDY_GNU)
#define BENDY_PUBLIC [[gnu::visibility("default")]]
#else
#define BENDY_PUBLIC
#endif
