#!/usr/bin/env bash
# Builds the program, converts an example character, shows its chunk tree, and poses it in the middle of its walk.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh build
cmake --preset demo >/dev/null
cmake --build --preset demo

bendy=build/demo/cli/bendy
mkdir -p out
set -x
$bendy convert examples/mannequin.glb -o out/mannequin.bendy
$bendy inspect out/mannequin.bendy
$bendy validate out/mannequin.bendy
$bendy pose out/mannequin.bendy --clip Walk --time 0.5 -o out/walk.obj
{ set +x; } 2>/dev/null
echo
echo "The mannequin, half-way through its walk: $PWD/out/walk.obj"
