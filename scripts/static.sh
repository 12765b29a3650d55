#!/usr/bin/env bash
# Builds bendy as one file that needs no shared library, for releases, with the licences that belong beside it. Without the
# viewer, which needs the graphics drivers of the machine that it runs on.
#   scripts/static.sh            for this machine: build/static/bendy; runs it in an empty root folder
#   scripts/static.sh aarch64    for 64-bit ARM: build/static-aarch64/bendy; runs it under qemu
#   scripts/static.sh windows    for 64-bit Windows: build/static-windows/bendy.exe; runs it under wine
set -euo pipefail
cd "$(dirname "$0")/.."

case ${1:-} in
    "") preset=static libraries=static strip=strip suffix= ;;
    aarch64) preset=static-aarch64 libraries=static-aarch64 strip=aarch64-linux-gnu-strip suffix= ;;
    windows) preset=static-windows libraries=windows strip=x86_64-w64-mingw32-strip suffix=.exe ;;
    *)
        echo "usage: scripts/static.sh [aarch64|windows]" >&2
        exit 2
        ;;
esac
folder=build/$preset
program=$folder/bendy$suffix

needed_libraries() { # what the system has to bring
    if [ -n "$suffix" ]; then
        x86_64-w64-mingw32-objdump -p "$program" | sed -n 's/.*DLL Name: //p' | grep -vxE '(KERNEL32|SHELL32|msvcrt)\.dll' || true
    else
        readelf -d "$program" | grep NEEDED || true
    fi
}

run_alone() { # run_alone ARGUMENT...: the program, in its folder, where nothing else is
    case $preset in
        static) unshare --user --map-root-user chroot "$folder/empty" /bendy "$@" ;;
        static-aarch64) (cd "$folder/empty" && qemu-aarch64 -L /nothing ./bendy "$@") ;;
        static-windows) (cd "$folder/empty" && ../../../cmake/run_wine.sh "$PWD/bendy.exe" "$@") ;;
    esac
}

scripts/setup.sh "$([ $preset = static ] && echo static || echo cross)"
scripts/cross_dependencies.sh $libraries
cmake --preset $preset >/dev/null
cmake --build --preset $preset
"$strip" -o "$program" "$folder/cli/bendy$suffix"

needed=$(needed_libraries)
[ -z "$needed" ] || { echo "needs shared libraries: $needed" >&2; exit 1; }
# What a release of the program has beside it.
scripts/notices.py $preset --check $folder:cli/bendy$suffix
scripts/notices.py $preset >$folder/NOTICES.txt
cp LICENSE $folder/
rm -rf $folder/empty
mkdir -p $folder/empty
cp "$program" examples/mannequin.glb $folder/empty
run_alone convert mannequin.glb --compact -o mannequin.bendy
run_alone validate mannequin.bendy
if [ $preset = static ]; then # outside of that folder it writes the same
    "$program" convert examples/mannequin.glb --compact --force -o $folder/mannequin.bendy
    cmp $folder/mannequin.bendy $folder/empty/mannequin.bendy
fi
file -b "$program"
ls -l "$program"
