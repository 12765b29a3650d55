#!/usr/bin/env bash
# Builds bendy as one file that needs no shared library, for releases: build/static/cli/bendy. Without the viewer, which
# needs the graphics drivers of the machine that it runs on.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh static
scripts/cross_dependencies.sh static
cmake --preset static >/dev/null
cmake --build --preset static --target bendy
strip -o build/static/bendy build/static/cli/bendy

needed=$(readelf -d build/static/bendy | grep NEEDED || true)
[ -z "$needed" ] || { echo "needs shared libraries: $needed" >&2; exit 1; }
# What a release of the program has beside it.
scripts/notices.py static --check build/static:cli/bendy
scripts/notices.py static >build/static/NOTICES.txt
cp LICENSE build/static/
# Try it where there is nothing but the kernel: in an empty root folder.
rm -rf build/static/empty
mkdir -p build/static/empty
cp build/static/bendy examples/mannequin.glb build/static/empty
unshare --user --map-root-user chroot build/static/empty /bendy convert mannequin.glb --compact -o mannequin.bendy
unshare --user --map-root-user chroot build/static/empty /bendy validate mannequin.bendy
build/static/bendy convert examples/mannequin.glb --compact --force -o build/static/mannequin.bendy
cmp build/static/mannequin.bendy build/static/empty/mannequin.bendy
file -b build/static/bendy
ls -l build/static/bendy
