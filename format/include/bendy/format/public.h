#pragma once

/// Defined where the sources may use what GCC and clang add to the language: vector types, attributes, built-in
/// functions. BENDY_STANDARD_CPP does without, as compilers that have none of it must; kernels then are the plain ones.
#if defined(__GNUC__) && !defined(BENDY_STANDARD_CPP)
#define BENDY_GNU
#endif

/// `inline`, and to GCC and clang, an order: for functions whose call costs as much as their work.
#if defined(BENDY_GNU)
#define BENDY_ALWAYS_INLINE [[gnu::always_inline]] inline
#else
#define BENDY_ALWAYS_INLINE inline
#endif

/// Marks a namespace block whose declarations the shared libraries export: `namespace BENDY_PUBLIC bendy {`. Nothing
/// else is exported; see docs/decisions/0024-what-the-shared-libraries-export.md.
#if defined(BENDY_GNU)
#define BENDY_PUBLIC [[gnu::visibility("default")]]
#else
#define BENDY_PUBLIC
#endif
