#!/usr/bin/env python3
"""check_compiling.py FOLDER COMPILER LIBRARY_PROGRAM FILE...: the two files by another compiler than the library's.

Parsed with what may be defined for them, warnings as errors; compiled without exceptions and RTTI, they pose the files as the library
does (compare_poses.py)."""

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent


def main():
    folder, compiler, library, *files = sys.argv[1:]
    if shutil.which(compiler) is None:
        sys.exit(f"{compiler} is not there: scripts/setup.sh gate")
    for name in ("bendy_runtime.h", "bendy_runtime.cpp"):
        if re.search(r'#include [<"]bendy/', Path(folder, name).read_text(encoding="utf-8")):
            sys.exit(f"{name} needs a file of the project")
    compile_ = [compiler, "-std=c++20", "-Wall", "-Wextra", "-Werror"]
    source = Path(folder, "bendy_runtime.cpp")
    for way in (["-DBENDY_WITH_ZSTD", "-DBENDY_WITH_MESHOPTIMIZER"], ["-DBENDY_WITH_MESHOPTIMIZER"]):
        subprocess.run([*compile_, "-fsyntax-only", *way, source], check=True)
    with tempfile.TemporaryDirectory() as output:
        program = Path(output, "pose")
        subprocess.run([*compile_, "-ffp-contract=off", "-fno-exceptions", "-fno-rtti", "-DBENDY_AMALGAMATED", f"-I{folder}", source,
                        HERE / "pose_with_kernel.cpp", "-o", program], check=True)
        subprocess.run([sys.executable, HERE / "compare_poses.py", library, program, *files], check=True)


if __name__ == "__main__":
    main()
