#!/usr/bin/env bash
# What a newcomer runs first: builds the program, converts an example character, and makes a picture of it and a page about it. Prints
# less than a screen; what the tools say goes to out/demo.log, whose end is shown if one of them fails.
set -euo pipefail
cd "$(dirname "$0")/.."
log=out/demo.log
bendy=build/demo/cli/bendy

logged() { # logged COMMAND...: with its output in the log
    "$@" >>"$log" 2>&1 && return
    tail -n 30 "$log" >&2
    echo "scripts/demo.sh: this failed: $*. The whole log is $log" >&2
    exit 1
}

shown() { # shown COMMAND...: the same, with the command on the screen
    echo "\$ $*"
    logged "$@"
}

progress() { # passes ninja's lines on; on a terminal, it also shows how far ninja is
    local line
    while IFS= read -r line; do
        echo "$line"
        if [ -t 3 ] && [[ $line =~ ^\[[0-9]+/[0-9]+\] ]]; then printf '\r%s ' "${BASH_REMATCH[0]}" >&3; fi
    done
    if [ -t 3 ]; then printf '\r\033[K' >&3; fi
}

build() {
    cmake --preset demo && cmake --build --preset demo | progress
}

mkdir -p out
: >"$log"
scripts/setup.sh build
echo "Building the program, which takes a minute or more the first time ..."
logged build 3>&2
shown $bendy convert examples/mannequin.glb -o out/mannequin.bendy
shown $bendy validate out/mannequin.bendy
shown $bendy render out/mannequin.bendy --clip Walk --time 0.35 -o out/walk.png
shown $bendy inspect out/mannequin.bendy --html out/mannequin.html
cat <<END

  out/mannequin.bendy   the character, converted from examples/mannequin.glb
  out/walk.png          a picture of it, in the middle of its walk
  out/mannequin.html    what is in the file, for a browser

Try next:

  $bendy view out/mannequin.bendy
  $bendy render out/mannequin.bendy --clip Walk --reach IK_LeftArm=0.3,1.2,0.4 -o out/reach.webp
  $bendy convert examples/tentacle.glb --compact -o out/tentacle.bendy
END
