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
mapfile -t sources < <(printf '%s\n' "${files[@]}" | grep '\.cpp$' | grep -v '^tests/')
scripts/tidy_in_groups.py "$build" "${sources[@]}"
