#!/usr/bin/env bash
# Fuzzes for a limited time; exits with 1 and prints the inputs if it finds anything.
#   scripts/fuzz.sh                           five seconds for each target, two at a time: for every change; with one seed and an
#                                             empty corpus, so that two changes are judged by the same inputs
#   scripts/fuzz.sh 7200 [animate convert]    two hours each for these, or all, other inputs every time; the libraries that
#                                             decode are instrumented, too
# The corpora stay in build/fuzz/corpus and grow from run to run; findings are in build/fuzz/findings.
set -euo pipefail
cd "$(dirname "$0")/.."

case ${1:-5} in
    *[!0-9]* | "")
        echo "usage: scripts/fuzz.sh [SECONDS [TARGET...]]" >&2
        exit 2
        ;;
esac
targets=("${@:2}")
build=build/fuzz
if [ $# = 0 ]; then
    seconds=5 seed=1 programs=build/asan-ubsan preset=asan-ubsan
else
    seconds=$1 seed=0 programs=build/fuzzers preset=fuzzers
    scripts/cross_dependencies.sh fuzzers
fi

cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset" --target fuzz_targets
[ ${#targets[@]} -gt 0 ] || for program in "$programs"/tests/fuzz/fuzz_*; do
    [ ! -x "$program" ] || targets+=("${program##*/fuzz_}")
done

if [ ! -d "$build/seeds" ]; then
    cmake --preset release >/dev/null
    cmake --build --preset release --target bendy
    folders=()
    [ ! -d ../shared/corpus ] || folders=(../shared/corpus)
    python3 tests/fuzz/make_seeds.py build/release/cli/bendy "$build/seeds.part" "${folders[@]}"
    mv "$build/seeds.part" "$build/seeds"
fi

fuzz() { # fuzz TARGET: one process, its last lines printed
    local target=$1 seeds=$build/seeds/bendy
    case $target in
        bvh | codec | convert | md2 | rig | text | x) seeds=$build/seeds/$target ;;
    esac
    local corpus=$build/corpus/$target log=$build/fuzz_$target.log status=0
    if [ "$seed" = 1 ]; then
        corpus=$build/empty/$target
        rm -rf "$corpus"
    fi
    mkdir -p "$corpus" "$build/findings"
    "$programs/tests/fuzz/fuzz_$target" -seed="$seed" -max_total_time="$seconds" -max_len=65536 -timeout=60 -rss_limit_mb=2048 \
        -malloc_limit_mb=128 -print_final_stats=1 -artifact_prefix="$build/findings/$target-" \
        "$corpus" "$seeds" >"$log" 2>&1 || status=$?
    printf '%-14s %s executions, %s\n' "$target" \
        "$(sed -n 's/stat::number_of_executed_units: *//p' "$log")" "$([ $status = 0 ] && echo "nothing found" || echo FOUND)"
    [ $status = 0 ] || tail -n 60 "$log"
    return $status
}
export -f fuzz
export build programs seconds seed
printf '%s\n' "${targets[@]}" | xargs -P 2 -I{} bash -euo pipefail -c 'fuzz {}'
