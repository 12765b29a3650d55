#!/usr/bin/env bash
# Builds the npm package in bindings/web/dist and tests it in node: the runtime and the tools as WebAssembly, and the page
# bindings/web/dist/page.html, which Chromium tests.
#   scripts/web.sh            all of it
#   scripts/web.sh package    the same without the tests
#   scripts/web.sh runtime    the runtime alone, without the tools and the page
set -euo pipefail
cd "$(dirname "$0")/.."

what=${1:-all}
case $what in
    all | package | runtime) ;;
    *)
        echo "usage: scripts/web.sh [package|runtime]" >&2
        exit 2
        ;;
esac
[ "$what" = runtime ] || scripts/setup.sh web
PATH=/usr/bin:$PATH # emscripten's scripts are for the system's Python
export NODE_PATH=/usr/share/nodejs # where emscripten's acorn is
export BENDY_PROGRAM=${BENDY_PROGRAM:-$PWD/build/release/cli/bendy}
if [ ! -x "$BENDY_PROGRAM" ]; then
    cmake --preset release >/dev/null
    cmake --build --preset release --target bendy
fi

systems=(web web-plain)
[ "$what" = runtime ] || systems+=(web-tools)
mkdir -p bindings/web/src/generated
for system in "${systems[@]}"; do
    scripts/cross_dependencies.sh "$system"
    cmake --fresh --preset "$system" >/dev/null # flags of a toolchain are read once
    cmake --build --preset "$system"
done
cp build/cross/web/build/web/{bindings,classes}.ts bindings/web/src/generated/
cd bindings/web
[ -e node_modules/playcanvas ] || npm ci --silent
# The last number is the most bytes by brotli; 19,500 of the runtime's are retargeting, 6,000 full-body IK. Tracks with times
# of their own, and the rules for animals' legs, added 2,400 (3,700 without SIMD), inlining 3,600 (2,000), streams that are decoded
# in one pass 1,000 (1,500), standing poses 1,200, odd rest poses, bodies of the same rig or without arms 1,000, and IK in the
# coordinates of the limits, in place of CCD, FABRIK and restarts, 2,100; chains that remember what they did, and soft limits, 2,900;
# IK that is quick for targets out of reach, and upper bones that turn for the lower ones, 1,000; bodies and hands that touch the
# ground or each other, which is found by the skin, and joints that do not jump, 4,800; hands on the own body, and out of it, 2,900.
node embed.mjs ../../build/cross/web/build/web/bendy.wasm src/generated/simd.ts 206000
node embed.mjs ../../build/cross/web-plain/build/web/bendy.wasm src/generated/plain.ts 213000
rm -rf dist
if [ "$what" = runtime ]; then
    npx --no-install tsc -p tsconfig.runtime.json
    exec node --test --test-concurrency=2 test/{broken,links,load,memory,model,play,pose,three,three_draw,three_rig}.test.mjs
fi
tools=../../build/cross/web-tools/build/web/tools
{ echo '// @ts-nocheck'; cat "$tools/tools.js"; } >src/generated/tools_glue.ts
# 36,500 of the tools' are changes of clips, BVH files and VRM animations; 49,000 are retargeting, with the runtime that it needs;
# 3,000 are JSON in one place and changes of materials; 20,000 are standing poses, found and told, and bodies that are found in
# poses of their clips and bind matrices, on six legs, or in part; 1,800 the report of retargeting against the source;
# 2,100 IK, as above, and 1,000 roles that are missed; 10,000 bodies that are assumed to stand in a T, clips on the spot, joints that
# pop, and animals whose rests are alike; 5,000 bodies and hands that touch the ground, and what a T of bones needs to know;
# 2,500 hands on the own body.
node embed.mjs "$tools/tools.wasm" src/generated/tools.ts 1038000
python3 ../convert_options.py src/generated/convert_options.ts
[ "$what" = package ] || [ -e test/compilers/node_modules/oldest ] || (cd test/compilers && npm ci --silent)
npm run --silent build
built=(../../build/cross/{web/build:web/bendy.wasm,web-plain/build:web/bendy.wasm,web-tools/build:web/tools/tools.js})
for artefact in npm page; do ../../scripts/notices.py $artefact --check "${built[@]}" dist/bundle/inputs.txt; done
npx --no-install tsc -p page
"$BENDY_PROGRAM" convert ../../examples/mannequin.glb --rig page/example.rig.json --lod --quiet -o dist/example.bendy
node page/build.mjs dist/example.bendy
rm dist/example.bendy
[ "$what" = package ] || npm test
