#!/usr/bin/env bash
# Builds everything except the viewer for other machines, runs the tests there in an emulator, and compares the program's output
# with the stored hashes: the bytes must be the same everywhere. Takes long.
#   scripts/cross.sh [windows] [aarch64]   64-bit Windows under wine, 64-bit ARM under qemu-user; both if none is named
#   scripts/cross.sh short                 only how files are mapped and written on Windows: a few minutes
set -euo pipefail
cd "$(dirname "$0")/.."
corpus=../shared/corpus/visible

step() { printf '\n== %s\n' "$*"; }

build() { # build SYSTEM [TARGET...]
    local system=$1
    shift
    step "$system: libraries"
    scripts/cross_dependencies.sh "$system"
    step "$system: build"
    cmake --preset "$system" >/dev/null
    cmake --build --preset "$system" --parallel "$(nproc)" ${1:+--target "$@"}
}

# Wraps the program as a command of this machine.
program() { # program SYSTEM
    local folder=$PWD/build/cross/$1
    case $1 in
        windows) echo "exec $PWD/cmake/run_wine.sh $folder/build/cli/bendy.exe \"\$@\"" ;;
        aarch64) echo "exec qemu-aarch64 -L /usr/aarch64-linux-gnu $folder/build/cli/bendy \"\$@\"" ;;
    esac | { echo '#!/bin/sh'; cat; } >"$folder/bendy"
    chmod +x "$folder/bendy"
    echo "$folder/bendy"
}

# GCC may put what it thinks aligned to 32 bytes on a stack that Windows aligns to 16 (bug 54412), so kernels for AVX must not
# use an instruction that minds; and the program must need nothing that Windows has not.
check_windows_code() {
    local objects=(build/cross/windows/build/runtime/CMakeFiles/bendy_runtime.dir/src/*_avx*.obj)
    [ ${#objects[@]} -ge 3 ]
    if x86_64-w64-mingw32-objdump -d --no-show-raw-insn "${objects[@]}" | grep -E 'v(movap|movdqa|movntp|movntdq)[^ ]* .*[yz]mm.*\(' | head -n 3 | grep .; then
        echo "these move 32 bytes that must be aligned: the stack need not be" >&2
        return 1
    fi
    local needed
    needed=$(x86_64-w64-mingw32-objdump -p build/cross/windows/build/cli/bendy.exe | sed -n 's/.*DLL Name: //p' | sort | tr '\n' ' ')
    echo "needs $needed"
    [ "$needed" = "KERNEL32.dll SHELL32.dll msvcrt.dll " ]
}

check_program() { # check_program SYSTEM
    local bendy
    bendy=$(program "$1")
    step "$1: file names of all letters"
    python3 tests/cli/file_names_test.py --bendy "$bendy" --source .
    step "$1: the same bytes, of examples and seeds"
    python3 tests/determinism/check_hashes.py --bendy "$bendy" --jobs "$(nproc)"
    if [ -e "$corpus/manifest.json" ]; then
        step "$1: the same bytes, of the corpus without options"
        python3 tests/determinism/check_hashes.py --bendy "$bendy" --jobs "$(nproc)" --corpus "$corpus" --plain
    fi
}

scripts/setup.sh cross
if [ "${1:-}" = short ]; then
    build windows bendy_format_tests
    step "windows: tests of files"
    cmake/run_wine.sh build/cross/windows/build/tests/bendy_format_tests.exe --gtest_filter='*File*'
    exit
fi
[ $# -gt 0 ] || set -- windows aarch64
for system in "$@"; do
    build "$system"
    [ "$system" != windows ] || check_windows_code
    step "$system: tests"
    ctest --preset "$system"
    check_program "$system"
done
