#!/usr/bin/env python3
"""Checks that sources use extensions of GCC and clang only behind BENDY_GNU: check_extensions.py SOURCE_DIR"""

import re
import sys
from pathlib import Path

EXTENSION = re.compile(r"__builtin_\w+|__attribute__|\[\[gnu::|vector_size|__int128|__restrict|\btypeof\b|^ *asm\b")
# These have another way beside each extension.
MAY_USE = re.compile(r"format/include/bendy/format/public\.h|format/src/(crc32c|processor)\.cpp|converter/src/optimise/collapse/distances\.h"
                     r"|converter/src/optimise/compact/linear_errors\.cpp|bindings/c/include/bendy\.h")
FOLDERS = ("format", "runtime", "converter", "tools", "bindings/c")


def main():
    root = Path(sys.argv[1])
    faults = []
    found = 0
    for folder in FOLDERS:
        for file in sorted(path for path in (root / folder).rglob("*") if path.suffix in (".h", ".cpp")):
            name = file.relative_to(root).as_posix()
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                extension = EXTENSION.search(line.partition("//")[0])
                if extension is None:
                    continue
                found += 1
                if not MAY_USE.fullmatch(name):
                    faults.append(f"{name}:{number}: {extension[0]} is not standard C++; see BENDY_GNU in bendy/format/public.h")
    if found < 8:
        faults.append(f"only {found} extensions found: is this the source folder?")
    print("\n".join(faults), end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
