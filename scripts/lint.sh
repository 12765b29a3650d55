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
    # Sources of another system are not in this build; scripts/cross.sh compiles them.
    mapfile -t sources < <(printf '%s\n' "${files[@]}" | grep '\.cpp$' | grep -v -e '^tests/' -e '_windows\.cpp$')
    scripts/tidy_in_groups.py "$build" "${sources[@]}"
fi
