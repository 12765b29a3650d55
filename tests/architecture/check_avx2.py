#!/usr/bin/env python3
"""Looks for `vzeroupper` in the AVX2 kernels, whose callers are not compiled for AVX2: where it is missing, some processors take
150 ns longer for each call. GCC leaves it out of functions that only call others which take registers.

    check_avx2.py OBJDUMP LIBRARY
"""

import re
import subprocess
import sys

FUNCTION = re.compile(r"^[0-9a-f]+ <(.*)>:\n((?:.+\n)*)", re.M)
# What is called through the tables of kernels takes a block of plain data; functions that take registers are part of a kernel.
KERNEL = re.compile(r"(with_avx2::|_avx2\().*\(bendy::\w+Block(?: const)?&\)$")


def main():
    command = [sys.argv[1], "--disassemble", "--no-show-raw-insn", "--demangle", sys.argv[2]]
    listing = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    kernels = {name: body for name, body in FUNCTION.findall(listing) if KERNEL.search(name)}
    faults = [f"{name}: returns without vzeroupper" for name, body in kernels.items()
              if "%ymm" in body and re.search(r"\sret", body) and "vzeroupper" not in body]
    if len(kernels) < 10:
        faults.append(f"only {len(kernels)} kernels found in {sys.argv[2]}")
    print("\n".join(faults), end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
