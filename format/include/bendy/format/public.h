#pragma once

/// Marks a namespace block whose declarations the shared libraries export: `namespace BENDY_PUBLIC bendy {`. Nothing
/// else is exported; see docs/decisions/0024-what-the-shared-libraries-export.md.
#if defined(__GNUC__)
#define BENDY_PUBLIC [[gnu::visibility("default")]]
#else
#define BENDY_PUBLIC
#endif
