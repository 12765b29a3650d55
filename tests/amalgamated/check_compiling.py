#!/usr/bin/env python3
"""check_compiling.py FOLDER COMPILER: the two files with another compiler, and with what may be defined for them: parsed, with warnings
as errors."""

import re
import shutil
import subprocess
import sys
from pathlib import Path


def main():
    folder, compiler = Path(sys.argv[1]), sys.argv[2]
    if shutil.which(compiler) is None:
        sys.exit(f"{compiler} is not there: scripts/setup.sh test")
    flags = ["-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror"]
    ways = [["-fno-exceptions", "-fno-rtti"], ["-DBENDY_WITH_ZSTD", "-DBENDY_WITH_MESHOPTIMIZER"], ["-DBENDY_WITH_MESHOPTIMIZER"]]
    for way in ways:
        subprocess.run([compiler, *flags, *way, folder / "bendy_runtime.cpp"], check=True)
    for name in ("bendy_runtime.h", "bendy_runtime.cpp"):
        text = (folder / name).read_text(encoding="utf-8")
        if re.search(r'#include [<"]bendy/', text):
            sys.exit(f"{name} needs a file of the project")
    print(f"{len(ways)} ways by {compiler}")


if __name__ == "__main__":
    main()
