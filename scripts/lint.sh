#!/usr/bin/env bash
# Checks the project's own sources: scripts/lint.sh [BUILD-FOLDER [--changed|FILE...]]
#   without a build folder, clang-format; with one, clang-tidy, over all but the tests, over those of them that have changed or
#   include what has (scripts/changed_sources.py), or over FILEs
set -euo pipefail
cd "$(dirname "$0")/.."

build=${1:-}
if [ -z "$build" ]; then
    git ls-files -z '*.cpp' '*.h' | xargs -0 -P 2 -n 200 clang-format --dry-run --Werror
    exit
fi
case ${2:-} in
    --changed) files=$(scripts/changed_sources.py) ;;
    ?*) files=$(printf '%s\n' "${@:2}") ;;
    *) files=$(git ls-files '*.cpp') ;;
esac
# Not in this build: sources for other systems, which scripts/cross.sh compiles; those for builds without a codec, which
# tests/install/subproject compiles; bench/peers, which needs the other runtimes; and web, which emscripten compiles.
mapfile -t sources < <(printf '%s\n' "$files" | grep '\.cpp$' | grep -v -e '^tests/' -e '^bench/peers/' -e '^bindings/web/' -e '_windows\.cpp$' -e '/without_')
echo "clang-tidy: ${#sources[@]} sources"
[ ${#sources[@]} = 0 ] || scripts/tidy_in_groups.py "$build" "${sources[@]}"
