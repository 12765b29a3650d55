#pragma once

#include <cstdio>
#include <cstdlib>

namespace bendy::fuzz {

/// What must hold whatever the input is; the fuzzer takes the abort for a finding.
inline void check(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "does not hold: %s\n", what);
    std::abort();
}

}  // namespace bendy::fuzz
