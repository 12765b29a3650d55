#!/usr/bin/env python3
"""compare_poses.py LIBRARY_PROGRAM AMALGAMATED_PROGRAM FILE...: holds what the two print against each other, with every kernel.

The two files are compiled without zstd and meshoptimizer: a file that needs one is refused, with words that say so."""

import struct
import subprocess
import sys


def output(*command):
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    return result.returncode, result.stdout


def main():
    library, amalgamated, *files = sys.argv[1:]
    posed, refused = 0, 0
    for file in files:
        plain = output(library, "plain", file)
        for kernel in ("plain", "sse4", "avx2", "neon", "wasm"):
            expected, found = output(library, kernel, file), output(amalgamated, kernel, file)
            if expected[0] != 0 or not expected[1]:
                sys.exit(f"{file}: the library cannot pose it: {expected[1]}")
            names_options = found[1].startswith("UNSUPPORTED_CODEC: ") and "(BENDY_ZSTD, BENDY_MESHOPTIMIZER)" in found[1]
            if found[0] == 1 and names_options and "_compact" in file:
                refused += 1
            elif found[0] != 0:
                sys.exit(f"{file}: {found[1]}")
            # Kernels for other instructions round as their compiler fuses: near, not the same.
            elif kernel == "plain" and found != expected:
                sys.exit(f"{file}: the plain kernel does not give the library's bits")
            elif kernel != "plain" and "no kernel" not in expected[1] and not are_near(found[1], plain[1]):
                sys.exit(f"{file}: kernel {kernel} is far from the plain one")
            posed += found[0] == 0
    if posed == 0 or refused == 0:
        sys.exit("nothing was posed, or nothing refused")
    print(f"{posed} poses are the library's, {refused} files refused")


def are_near(found, expected):
    numbers = [[struct.unpack(">f", bytes.fromhex(word))[0] for word in text.split()] for text in (found, expected)]
    return len(numbers[0]) == len(numbers[1]) and all(abs(a - b) <= 1e-3 * max(1.0, abs(b)) for a, b in zip(*numbers))


if __name__ == "__main__":
    main()
