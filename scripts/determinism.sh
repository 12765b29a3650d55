#!/usr/bin/env bash
# Builds the converter with g++ and clang++, at -O0 and -O2, and converts the examples, the seeds and, where it lies
# beside the project, the corpus with each: the bytes must be the same, and those that tests/determinism keeps. At -O0 the
# corpus is converted without options: making it compact takes minutes a file there.
set -euo pipefail
cd "$(dirname "$0")/.."
corpus=../shared/corpus/visible
kinds=("")
[ ! -e "$corpus/manifest.json" ] || kinds+=("--corpus=$corpus")
for compiler in g++ clang++; do
    for level in 2 0; do
        build=build/determinism/$compiler-O$level
        cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE= -DCMAKE_CXX_COMPILER="$compiler" -DBENDY_VIEWER=OFF \
            -DBENDY_TESTS=ON -DBENDY_BENCHMARKS=OFF -DBENDY_EXAMPLES=OFF -DBENDY_INSTALL=OFF \
            -DCMAKE_CXX_FLAGS="-O$level" "$@" >/dev/null
        cmake --build "$build" --target bendy_convert_only
        for kind in "${kinds[@]}"; do
            plain=
            [ "$level" = 2 ] || [ -z "$kind" ] || plain=--plain
            echo "$compiler -O$level ${kind:-examples and seeds}"
            python3 tests/determinism/check_hashes.py --bendy "$build/tests/determinism/bendy_convert_only" --jobs "$(nproc)" ${kind:+"$kind"} $plain
        done
    done
done
