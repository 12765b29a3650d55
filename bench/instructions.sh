#!/usr/bin/env bash
# Counts instructions and cache misses, which other programs do not disturb: bench/instructions.sh FILE.bendy...
# callgrind counts the instructions of each stage per joint, vertex, ...; cachegrind counts the cache misses of a crowd
# per character, with caches of 32 kB and 8 MB. Needs valgrind, which supports AVX2. BENDY_KERNEL=plain counts another kernel.
set -euo pipefail
build=${BUILD:-$(dirname "$0")/../build/release}
repeat=$build/bench/bendy_bench_repeat

count() { # count TIMES FILE STAGE: instructions of the whole program
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$repeat" "$2" "$3" "$1" 2>&1 |
        sed -n 's/.*Collected *: *\([0-9]*\).*/\1/p'
}

misses() { # misses FRAMES FILE: instructions, misses of the first and of the last data cache
    valgrind --tool=cachegrind --cache-sim=yes --D1=32768,8,64 --LL=8388608,16,64 --cachegrind-out-file=/dev/null "$build/examples/bendy_crowd" "$2" 500 "$1" 2>&1 |
        tr -d , | awk '/ I +refs/ {i = $4} / D1 +misses/ {d = $4} / LLd misses/ {l = $4} END {print i, d, l}'
}

for file in "$@"; do
    echo "$(basename "$file"): instructions"
    "$repeat" "$file" | while IFS=$'\t' read -r number items item name; do
        few=$(count 3 "$file" "$number")
        more=$(count 13 "$file" "$number")
        awk -v n=$((more - few)) -v items="$items" -v item="$item" -v name="$name" \
            'BEGIN {printf "  %-36s %12.1f a %s\n", name, n / 10 / items, item}'
    done
    if [ -x "$build/examples/bendy_crowd" ]; then
        read -r i1 d1 l1 < <(misses 1 "$file")
        read -r i2 d2 l2 < <(misses 3 "$file")
        echo "  a crowd of 500, for one character: $(((i2 - i1) / 1000)) instructions, $(((d2 - d1) / 1000)) misses of" \
            "the first data cache, $(((l2 - l1) / 1000)) of the last"
    fi
done
