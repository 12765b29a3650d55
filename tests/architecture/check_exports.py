#!/usr/bin/env python3
"""Holds the public headers of the embeddable libraries to docs/decisions/0024: what they declare is exported by BENDY_PUBLIC, and
a block without it only names classes: check_exports.py SOURCE_DIR"""

import re
import sys
from pathlib import Path

BLOCK = re.compile(r"^namespace (BENDY_PUBLIC )?bendy \{\n(.*?)^\}", re.M | re.S)
NAMES_ONLY = re.compile(r"(\s|//.*|(class|struct) \w+;)*")


def main():
    faults = []
    headers = [file for folder in ("format", "runtime") for file in sorted((Path(sys.argv[1]) / folder / "include").rglob("*.h"))]
    blocks = 0
    for header in headers:
        for block in BLOCK.finditer(header.read_text(encoding="utf-8")):
            blocks += 1
            if not block[1] and not NAMES_ONLY.fullmatch(block[2]):
                faults.append(f"{header}: namespace bendy without BENDY_PUBLIC: a shared library would not export what stands there")
    if blocks < 40:
        faults.append(f"only {blocks} blocks of namespace bendy found: is this the source folder?")
    print("\n".join(faults), end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
