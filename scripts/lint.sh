#!/usr/bin/env bash
# Checks the project's own sources: scripts/lint.sh [BUILD-FOLDER [FILE...]]
#   without a build folder, clang-format; with one, clang-tidy too, over all but the tests
set -euo pipefail
cd "$(dirname "$0")/.."

build=${1:-}
if [ $# -gt 1 ]; then
    files=("${@:2}")
else
    mapfile -t files < <(git ls-files '*.cpp' '*.h')
fi
clang-format --dry-run --Werror "${files[@]}"
if [ -n "$build" ]; then
    # Not in this build: sources of another system, which scripts/cross.sh compiles, those for builds without a codec, which
    # tests/install/subproject compiles, bench/peers, which needs the other runtimes, and web, which emscripten compiles.
    mapfile -t sources < <(printf '%s\n' "${files[@]}" | grep '\.cpp$' | grep -v -e '^tests/' -e '^bench/peers/' -e '^web/' -e '_windows\.cpp$' -e '/without_')
    scripts/tidy_in_groups.py "$build" "${sources[@]}"
fi
