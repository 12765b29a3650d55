#!/usr/bin/env bash
# Measures the coverage of format/ and runtime/ by the tests: lines and branches of both folders, and of verification file
# by file. Fails below the promised level: 95 % of the lines, all branches of verification.
#   scripts/coverage.sh                  builds in build/coverage, runs the tests, prints the table
#   scripts/coverage.sh table            the table alone, after such a run
#   scripts/coverage.sh missed [FILE...] the branches that went one way only, of verification or of these files
set -euo pipefail
cd "$(dirname "$0")/.."
build=build/coverage
cov=$(ls /usr/bin/llvm-cov /usr/lib/llvm-*/bin/llvm-cov 2>/dev/null | head -1)
profdata=$(ls /usr/bin/llvm-profdata /usr/lib/llvm-*/bin/llvm-profdata 2>/dev/null | head -1)
targets=(bendy_format_tests bendy_conformance_tests bendy_runtime_tests bendy_mutation_tests)
programs=("$build"/tests/{bendy_format_tests,conformance/bendy_conformance_tests,bendy_runtime_tests,bendy_mutation_tests})

# It warns of mismatched data: inline functions that some programs call and others do not; some of these count as not run.
export_counts() {
    "$cov" export "${programs[0]}" "${programs[@]/#/-object=}" -instr-profile="$build/all.profdata" \
        -ignore-filename-regex='/tests/|^/usr/' -skip-functions -skip-expansions
}
case ${1:-} in
    table) export_counts | python3 scripts/coverage_table.py; exit ;;
    missed) export_counts | python3 scripts/missed_branches.py "${@:2}"; exit ;;
    ?*)
        echo "usage: scripts/coverage.sh [table|missed [FILE...]]" >&2
        exit 2
        ;;
esac

# Assertions are off: the caller's mistakes that they catch are not branches that a file can take.
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE= -DCMAKE_CXX_COMPILER=clang++ -DBENDY_TOOLS=OFF -DBENDY_TESTS=ON \
    -DBENDY_BENCHMARKS=OFF -DBENDY_EXAMPLES=OFF -DBENDY_INSTALL=OFF \
    -DCMAKE_CXX_FLAGS="-O1 -DNDEBUG -fprofile-instr-generate -fcoverage-mapping" >/dev/null
cmake --build "$build" --target "${targets[@]}"
rm -f "$build"/*.profraw
for program in "${programs[@]}"; do
    LLVM_PROFILE_FILE="$build/${program##*/}.profraw" "$program" --gtest_brief=1
done
for kernel in plain sse4; do
    BENDY_KERNEL=$kernel LLVM_PROFILE_FILE="$build/$kernel.profraw" "$build/tests/bendy_runtime_tests" --gtest_brief=1 \
        --gtest_filter='Blend*:Additive*:Sample*:Skin*:LocalToModel*:Pose*:Lod*'
done
"$profdata" merge -o "$build/all.profdata" "$build"/*.profraw
export_counts | python3 scripts/coverage_table.py
