#!/usr/bin/env bash
# Runs a Windows program under wine: run_wine.sh PROGRAM.exe [ARGUMENT...]. Its registry and drives are in build/cross/windows.
export WINEPREFIX=${BENDY_WINE_PREFIX:-$(dirname "$(readlink -f "$0")")/../build/cross/windows/wine}
export WINEDEBUG=-all WINEDLLOVERRIDES='mscoree,mshtml,winemenubuilder.exe='
[ -n "${LC_ALL:-}" ] || export LC_ALL=C.UTF-8 # file names are UTF-8
# Processes that wine starts in the background would keep the program's output open after the program has ended.
wine wineboot </dev/null >/dev/null 2>&1
exec wine "$@"
