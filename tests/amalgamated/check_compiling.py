#!/usr/bin/env python3
"""check_compiling.py FOLDER COMPILER LIBRARY_PROGRAM FILE...: the two files by another compiler than the library's.

docs/embedding.md names their macros and what they include. Parsed with what may be defined for them, warnings as errors; compiled
without exceptions and RTTI, they pose the files as the library does (compare_poses.py)."""

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
# Headers of processors and operating systems, which every compiler for them has.
SYSTEM = {"arm_acle.h", "arm_neon.h", "fcntl.h", "immintrin.h", "intrin.h", "nmmintrin.h", "sys/auxv.h", "sys/mman.h", "sys/stat.h", "unistd.h",
          "wasm_simd128.h", "windows.h", "xmmintrin.h"}


def check_docs(folder, compiler):
    """What the page says of the macros and the includes is what the two files have."""
    page = (HERE.parent.parent / "docs/embedding.md").read_text(encoding="utf-8")
    page = page[page.index("\n## From C, from Python, or as two files"):]
    header, source = (Path(folder, name).read_text(encoding="utf-8") for name in ("bendy_runtime.h", "bendy_runtime.cpp"))

    def macros(directives, text):
        return {name for line in re.findall(rf"^#\s*(?:{directives})\b(.*)", text, re.M) for name in re.findall(r"\bBENDY_\w+", line)}

    asked = macros("if|ifdef|ifndef|elif", header + source) - macros("define", header + source)
    left = subprocess.run([compiler, "-std=c++20", "-dM", "-E", "-x", "c++", Path(folder, "bendy_runtime.h")], check=True, capture_output=True, text=True)
    # Headers of the standard library have names without a dot.
    included, more = (set(re.findall(r"^#include <([^>]*\.[^>]*)>", text, re.M)) for text in (header, source))
    libraries = {name for name in more - SYSTEM if not name.startswith("glm/")}
    for what, said, there in (("macros", re.findall(r"`(BENDY_\w+)`", page), asked | macros("define", left.stdout)),
                              ("includes", re.findall(r"`<([\w/]+\.\w+)>`", page), included | libraries)):
        said = {name for name in said if not name.startswith("bendy/")}
        if said != there:
            sys.exit(f"docs/embedding.md, {what} of the two files: {', '.join(sorted(said ^ there))}")


def main():
    folder, compiler, library, *files = sys.argv[1:]
    if shutil.which(compiler) is None:
        sys.exit(f"{compiler} is not there: scripts/setup.sh gate")
    for name in ("bendy_runtime.h", "bendy_runtime.cpp"):
        if re.search(r'#include [<"]bendy/', Path(folder, name).read_text(encoding="utf-8")):
            sys.exit(f"{name} needs a file of the project")
    check_docs(folder, compiler)
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
