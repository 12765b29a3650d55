#!/usr/bin/env bash
# clang-format over the project's own sources, clang-tidy over all but the tests: scripts/lint.sh BUILD-FOLDER [FILE...]
set -euo pipefail
cd "$(dirname "$0")/.."

build=${1:?usage: scripts/lint.sh BUILD-FOLDER [FILE...]}
shift
if [ $# -gt 0 ]; then
    files=("$@")
else
    mapfile -t files < <(git ls-files '*.cpp' '*.h')
fi
clang-format --dry-run --Werror "${files[@]}"
# Sources of another system are not in this build; scripts/cross.sh compiles them.
mapfile -t sources < <(printf '%s\n' "${files[@]}" | grep '\.cpp$' | grep -v -e '^tests/' -e '_windows\.cpp$')
scripts/tidy_in_groups.py "$build" "${sources[@]}"
