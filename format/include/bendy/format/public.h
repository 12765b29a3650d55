#pragma once

/// Defined where the sources may use what GCC and clang add to the language: attributes and built-in functions.
/// BENDY_STANDARD_CPP does without, as compilers that have none of it must.
#if defined(__GNUC__) && !defined(BENDY_STANDARD_CPP)
#define BENDY_GNU
#endif

/// `inline`, and to a compiler that optimises for speed, an order: for functions whose call costs as much as their
/// work. And the opposite: for functions that are seldom called, and would spoil the code around the call.
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
