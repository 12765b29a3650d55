#!/usr/bin/env bash
# Builds the npm package in web/dist, with the runtime and the tools as WebAssembly, and the page web/dist/page.html; tests them in
# node and in Chromium.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh web
PATH=/usr/bin:$PATH # emscripten's scripts are for the system's Python
export NODE_PATH=/usr/share/nodejs # where emscripten's acorn is
export BENDY_PROGRAM=${BENDY_PROGRAM:-$PWD/build/release/cli/bendy}
if [ ! -x "$BENDY_PROGRAM" ]; then
    cmake --preset release >/dev/null
    cmake --build --preset release --target bendy
fi

mkdir -p web/src/generated
for system in web web-plain web-tools; do
    scripts/cross_dependencies.sh "$system"
    cmake --preset "$system" >/dev/null
    cmake --build --preset "$system"
done
cp build/cross/web/build/web/bindings.ts web/src/generated/
tools=build/cross/web-tools/build/web/tools
{ echo '// @ts-nocheck'; cat "$tools/tools.js"; } >web/src/generated/tools_glue.ts
cd web
node embed.mjs ../build/cross/web/build/web/bendy.wasm src/generated/simd.ts 160000
node embed.mjs ../build/cross/web-plain/build/web/bendy.wasm src/generated/plain.ts 160000
node embed.mjs ../$tools/tools.wasm src/generated/tools.ts 900000
[ -e node_modules/puppeteer-core ] || npm ci --silent
rm -rf dist
npm run --silent build
npx --no-install tsc -p page
"$BENDY_PROGRAM" convert ../examples/mannequin.glb --rig page/example.rig.json --lod --quiet -o dist/example.bendy
node page/build.mjs dist/example.bendy
rm dist/example.bendy
npm test
