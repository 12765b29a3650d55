#!/usr/bin/env python3
"""The blocks of README.md and docs/languages.md give the same vertices to the last bit, with the plain kernel.

    use_from_test.py --bendy PROGRAM --source SOURCE_DIR --compile "COMMAND" --link "FLAGS"
                     [--c-library libbendy.so] [--python INTERPRETER PACKAGE_FOLDER]

The blocks for C++ (README.md), C and Python (docs/languages.md) run in a folder with the example character; the numbers that each leaves in `positions`
are compared with the output of `bendy pose`. bindings/web/test/docs.test.mjs does the same with the block for JavaScript.
"""

import argparse
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from array import array
from pathlib import Path

CPP = """
#include <cstdio>
static int report(const bendy::Error&) { return 1; }
int main() {
%s
    return is_good && std::fwrite(positions.data(), sizeof positions[0], positions.size(), stdout) == positions.size() ? 0 : 1;
}
"""
C = """
#include <stdio.h>
static int report(const bendy_error* error) { fprintf(stderr, "%%s\\n", error->message); return 1; }
int main(void) {
%s
    return fwrite(out.positions, 3 * sizeof(float), out.capacity, stdout) == out.capacity ? 0 : 1;
}
"""
PYTHON = """
import sys
sys.stdout.buffer.write(positions.tobytes())
"""


def block_of(page, language):
    """The first block of a language in a page."""
    return re.search(rf"^```{language}\n(.*?)^```$", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)[1]


def program_of(block, frame):
    """A program in which the block, without its includes, is a part of main."""
    includes = re.findall(r"^#include .*\n", block, re.MULTILINE)
    return "".join(includes) + frame % re.sub(r"^#include .*\n", "", block, flags=re.MULTILINE)


class Blocks:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.readme, self.languages = options.source / "README.md", options.source / "docs/languages.md"
        self.environment = {**os.environ, "BENDY_KERNEL": "plain", "PYTHONDONTWRITEBYTECODE": "1"}

    def run(self, *command, **more):
        done = subprocess.run([str(word) for word in command], cwd=self.folder, env={**self.environment, **more},
                              capture_output=True, timeout=300, check=False)
        assert done.returncode == 0, f"{command}: exit status {done.returncode}\n{done.stderr.decode(errors='replace')}"
        return done.stdout

    def bendy_pose(self):
        printed = json.loads(self.run(self.options.bendy, "pose", "mannequin.bendy", "--clip", "Walk", "--time", "0.35",
                                      "--reach", "IK_LeftArm=0.3,1.2,0.4", "--format", "json"))
        return array("f", [number for mesh in printed["meshes"] for number in mesh["positions"]]).tobytes()

    def cpp(self):
        (self.folder / "block.cpp").write_text(program_of(block_of(self.readme, "cpp"), CPP), encoding="utf-8")
        self.run(*shlex.split(self.options.compile), "block.cpp", "-o", "from_cpp", *shlex.split(self.options.link))
        return self.run("./from_cpp")

    def c(self):
        library = self.options.c_library
        (self.folder / "block.c").write_text(program_of(block_of(self.languages, "c"), C), encoding="utf-8")
        self.run("cc", "-std=c99", "-Wall", "-Wextra", "-Werror", f"-I{self.options.source}/bindings/c/include", "block.c", "-o", "from_c",
                 library, f"-Wl,-rpath,{library.parent}")
        return self.run("./from_c")

    def python(self):
        interpreter, package = self.options.python
        return self.run(interpreter, "-c", block_of(self.languages, "python") + PYTHON, PYTHONPATH=package)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    for name in ("bendy", "source"):
        parser.add_argument(f"--{name}", type=Path, required=True)
    for name in ("compile", "link"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--c-library", type=Path)
    parser.add_argument("--python", nargs=2)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="bendy-use-") as name:
        folder = Path(name)
        shutil.copy(options.source / "examples/mannequin.glb", folder)
        blocks = Blocks(options, folder)
        blocks.run(options.bendy, "convert", "--quiet", "mannequin.glb")
        expected = blocks.bendy_pose()
        found = {"C++": blocks.cpp()}
        if options.c_library:
            found["C"] = blocks.c()
        if options.python:
            found["Python"] = blocks.python()
    different = [language for language, positions in found.items() if positions != expected]
    print(f"{len(expected) // 12} vertices from {', '.join(found)}; not those of bendy pose: {', '.join(different) or 'none'}")
    return 1 if different or not expected else 0


if __name__ == "__main__":
    sys.exit(main())
