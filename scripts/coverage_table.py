#!/usr/bin/env python3
"""Reads `llvm-cov export` from standard input and prints what is covered; exits with 1 if it is too little."""

import json
import sys

from branches import branches_of, files_of, text_of

LEAST_LINES = 95.0

# Verification: the code between hostile bytes and the rest. Tests take every branch of these both ways.
VERIFICATION = [f"format/src/{name}.cpp" for name in (
    "chunk_reader", "codec", "document",  # the walk itself
    "joint", "constraint", "ik_chain", "material", "mesh", "bind_palette", "clip", "packed_clip", "lod",
    "text")] + [  # records and values
    f"format/include/bendy/format/{name}.h" for name in ("byte_reader", "chunk_reader", "error", "read_record",
                                                         "records")] + ["format/src/packed_layout.h"]

# Kernels for other processors than the one at hand: they cannot run here, so they are not counted.
OTHER_PROCESSORS = [f"runtime/src/kernels/{name}" for name in ("lanes_neon.h", "lanes_wasm.h", "neon.cpp", "wasm.cpp")]


def percent(covered, count):
    return 100.0 * covered / count if count else 100.0


def print_row(name, lines, branches):
    print(f"{name:44} {lines[0]:6} of {lines[1]:5} {percent(*lines):7.2f} % "
          f"{branches[0]:6} of {branches[1]:5} {percent(*branches):7.2f} %")


def main():
    files = {}
    for path, entry in files_of(json.load(sys.stdin)):
        if not path.startswith(("format/", "runtime/")) or path in OTHER_PROCESSORS:
            continue
        lines = entry["summary"]["lines"]
        taken = branches_of(entry, text_of(path)).values()
        files[path] = ((lines["covered"], lines["count"]),
                       (sum((a > 0) + (b > 0) for a, b in taken), 2 * len(taken)))

    def total(paths):
        return [tuple(sum(files[path][k][i] for path in paths) for i in (0, 1)) for k in (0, 1)]

    verification = [path for path in VERIFICATION if path in files]
    print(f"{'':44} {'lines':>25} {'branches':>25}")
    for path in verification:
        print_row(path, *files[path])
    print()
    print_row("verification: all of these", *total(verification))
    too_little = []
    if total(verification)[1][0] < total(verification)[1][1]:
        too_little.append("branches of verification (scripts/coverage.sh missed)")
    for folder in ("format/", "runtime/"):
        both = total([path for path in files if path.startswith(folder)])
        print_row(folder, *both)
        if percent(*both[0]) < LEAST_LINES:
            too_little.append("lines of " + folder)
    print("not counted, for other processors: " + ", ".join(OTHER_PROCESSORS))
    poor = [f"{path} {percent(*lines):.0f} %" for path, (lines, _) in sorted(files.items())
            if percent(*lines) < LEAST_LINES]
    print(f"lines below {LEAST_LINES:.0f} %: " + (", ".join(poor) or "no file"))
    if too_little:
        print("too little: " + ", ".join(too_little))
    return 1 if too_little else 0


if __name__ == "__main__":
    sys.exit(main())
