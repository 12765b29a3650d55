#!/usr/bin/env bash
# Runs every check that the project has, first those that fail most often; .ci/run calls this and nothing else.
#   scripts/test.sh         all of it
#   scripts/test.sh quick   one optimised build and its tests
set -euo pipefail
cd "$(dirname "$0")/.."

# Says what comes next, and how many minutes everything has taken so far.
step() { printf '\n== %d:%02d  %s\n' $((SECONDS / 60)) $((SECONDS % 60)) "$*"; }

scripts/setup.sh test

step "format"
scripts/lint.sh

step "optimised build, warnings are errors"
cmake --preset release -DBENDY_TESTS=ON -DBENDY_WARNINGS_AS_ERRORS=ON >/dev/null
cmake --build --preset release

step "tests"
ctest --preset release -LE corpus
if [ -e ../shared/corpus/visible/manifest.json ]; then
    step "the corpus: files converted, files refused, worst error"
    ctest --preset release -L corpus --verbose
fi

if [ "${1:-}" != quick ]; then
    step "lint"
    scripts/lint.sh build/release

    step "every public header compiles by itself"
    cmake --build --preset release --target all_verify_interface_header_sets

    step "the embeddable part without exceptions and RTTI"
    cmake --preset no-exceptions >/dev/null
    cmake --build --preset no-exceptions

    step "the libraries in the standard language only, by clang with libc++"
    cmake --preset standard-cpp >/dev/null
    cmake --build --preset standard-cpp
    ctest --preset standard-cpp

    step "threads under ThreadSanitizer"
    cmake --preset tsan >/dev/null
    cmake --build --preset tsan
    ctest --preset tsan

    step "kernels of other processors: NEON under qemu, WebAssembly under node"
    for processor in aarch64 wasm32; do
        (cd tests/elsewhere && cmake --workflow --preset "$processor")
    done

    step "the npm package: WebAssembly with and without SIMD, under node"
    scripts/web.sh

    step "built by clang; tests under AddressSanitizer and UndefinedBehaviorSanitizer"
    cmake --preset asan-ubsan >/dev/null
    cmake --build --preset asan-ubsan
    ctest --preset asan-ubsan

    step "fuzzing, four minutes of processor"
    scripts/fuzz.sh
fi

step "what a newcomer runs first"
scripts/demo.sh >/dev/null
step "done"
