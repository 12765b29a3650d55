#!/bin/sh
# Makes tentacle.glb and mannequin.glb again from the scripts in blender/. Needs Blender 3.4; the same Blender gives the same bytes.
# -t 1: with more threads, the last digits of some numbers vary from run to run.
set -eu

if ! command -v blender >/dev/null; then
    echo "make.sh: blender is missing: install the packages blender and python3-numpy" >&2
    exit 1
fi
if ! blender -b --factory-startup --python-exit-code 1 --python-expr 'import numpy' >/dev/null 2>&1; then
    echo "make.sh: Blender's glTF exporter needs numpy: install the package python3-numpy" >&2
    exit 1
fi

cd "$(dirname "$0")"
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

for character in tentacle mannequin; do
    if ! PYTHONDONTWRITEBYTECODE=1 blender -b -t 1 --factory-startup --python-exit-code 1 \
            --python "blender/make_$character.py" -- "$out/$character.glb" >"$out/log" 2>&1; then
        cat "$out/log" >&2
        echo "make.sh: $character.glb was not made" >&2
        exit 1
    fi
done
for character in tentacle mannequin; do
    cp "$out/$character.glb" "$character.glb"
    echo "$character.glb: $(wc -c <"$character.glb") bytes"
done
