#!/usr/bin/env python3
"""Runs what the documentation says: every fenced block of the pages, by its language.

    run_blocks.py --bendy PROGRAM --source SOURCE_DIR --compile "COMMAND" [--link "FLAGS"] PAGE...

    sh      run by bash, all blocks of a page in one folder with the example characters, which is
            its own folder examples, too; every line must exit with 0
    text    after a block that is run: what that prints, "..." for any lines between; elsewhere: something to look at
    cpp, c  compiled with COMMAND and linked with FLAGS; with a main it is run, with mannequin.bendy as its argument,
            without it is a part of a function, whose names PARTS gives; all parts of a page are compiled in one go
    json    parsed
    python  run, with the examples' Python modules at hand

A comment before a block says where else it is run, or why it is not:

    <!-- run by tests/install -->    the place must exist
    <!-- lines of examples/a.cpp --> the block's lines are in that file, in their order; "..." stands for any lines
    <!-- not run: needs Blender -->  listed when the test ends

A comment names figures in the text that a command prints; each must be in what it prints now, and in the page:

    <!-- printed by: bendy convert mannequin.glb | 351,344 bytes | 65 -->

Such a comment may be folded into several lines. Its command finds the project's files in $SOURCE.

A block without a language, or an indented one, is a fault: nothing hides.
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
from pathlib import Path

FENCE = re.compile(r"^```(\w*)\s*$")
COMMENT = re.compile(r"^<!-- (run by|lines of|not run:) (.+) -->$")
FIGURES = re.compile(r"^<!-- printed by: (?:(?!-->)[^|])+(?:\s\|\s(?:(?!-->)[^|])+)+ -->$", re.MULTILINE)
# What the parts of functions in the pages may name beside what they declare.
PARTS = """
#include <bendy/runtime.h>
#include <cstdio>
#include <vector>
struct Character { bendy::Model* model; bendy::Pose* pose; };
int report(const bendy::Error&);
"""
PART = """namespace part_%d {
int part([[maybe_unused]] const char* path, [[maybe_unused]] float seconds, [[maybe_unused]] float dt,
         [[maybe_unused]] const glm::vec3& target, [[maybe_unused]] const glm::vec3& aim) {
#line %d "%s"
%s    return 0;
}
}
"""


class Block:
    def __init__(self, page, line, language, text, comment):
        self.page, self.line, self.language, self.text, self.comment = page, line, language, text, comment

    def __str__(self):
        return f"{self.page}:{self.line}"


def blocks_of(page, text):
    """The fenced blocks of a page, in order; and the lines of indented ones, which should not be."""
    blocks, indented = [], []
    comment, opened, in_list, before = None, None, False, ""
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line.strip()) if opened is None or line.strip() == "```" else None
        if fence and opened is None:
            opened = Block(page, number, fence[1], [], comment)
        elif fence:
            opened.text = "\n".join(opened.text) + "\n"
            blocks.append(opened)
            opened, comment = None, None
        elif opened is not None:
            opened.text.append(line)
        elif line.strip():
            found = COMMENT.match(line)
            comment = (found[1], found[2]) if found else None
            if re.match(r"^(\d+\.|[-*]) ", line):
                in_list = True
            elif not line.startswith(" "):
                in_list = False
            if line.startswith("    ") and not in_list and not before.strip():
                indented.append(number)
        before = line
    return blocks, indented


def same_lines(expected, printed):
    """None, or the first line of `expected` that is not there in its place; "..." stands for any lines."""
    at, anywhere = 0, False
    for line in expected:
        if line.strip() == "...":
            anywhere = True
            continue
        while at < len(printed) and anywhere and printed[at].rstrip() != line.rstrip():
            at += 1
        if at == len(printed) or printed[at].rstrip() != line.rstrip():
            return line
        at, anywhere = at + 1, False
    return None if anywhere or at == len(printed) else "(and no more)"


class Runner:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.faults, self.not_run, self.ran = [], [], 0
        self.parts = []  # of functions, compiled at the end of the page
        self.environment = {**os.environ, "PATH": f"{Path(options.bendy).parent}:{os.environ['PATH']}",
                            "LIBGL_ALWAYS_SOFTWARE": "1",
                            "PYTHONPATH": str(Path(options.source) / "examples/python"),
                            "SOURCE": str(Path(options.source).resolve()), "PYTHONDONTWRITEBYTECODE": "1"}
        self.printed = None

    def fault(self, block, what):
        self.faults.append(f"{block}: {what}")

    def run(self, block, command, **more):
        done = subprocess.run(command, cwd=self.folder, env=self.environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, errors="replace", timeout=300, **more)
        if done.returncode != 0:
            self.fault(block, f"exit status {done.returncode}: {command}\n{done.stdout}")
        return done.stdout

    def run_sh(self, block):
        printed = self.run(block, ["bash", "-eu", "-o", "pipefail", "-c", block.text])
        self.printed = printed.splitlines()

    def check_text(self, block):
        missing = same_lines(block.text.splitlines(), self.printed)
        if missing is not None:
            self.fault(block, "not what is printed, from this line on:\n    " + missing + "\nprinted:\n" + "\n".join(self.printed))

    def check_lines(self, block, file):
        missing = same_lines(["...", *(line.strip() for line in block.text.splitlines()), "..."], [line.strip() for line in file.splitlines()])
        if missing is not None:
            self.fault(block, "not in the file, from this line on:\n    " + missing)

    def run_program(self, block, suffix):
        if suffix == ".cpp" and "int main(" not in block.text:
            self.parts.append(block)
            return
        source = self.folder / f"block{suffix}"
        source.write_text(block.text, encoding="utf-8")
        program, arguments = self.folder / "block", shlex.split(self.options.compile)
        if suffix == ".c":
            arguments = ["cc", "-std=c99", "-Wall", "-Wextra", *[word for word in arguments if word.startswith("-I")]]
        self.run(block, [*arguments, str(source), "-o", str(program), *shlex.split(self.options.link)])
        if program.exists():
            self.printed = self.run(block, [str(program), "mannequin.bendy"]).splitlines()
            program.unlink()

    def compile_parts(self):
        """Compiles the parts of functions; what the compiler says names the page and its line."""
        if not self.parts:
            return
        lines = [line for block in self.parts for line in block.text.splitlines()]
        text = "".join(line + "\n" for line in dict.fromkeys(lines) if line.startswith("#include")) + PARTS
        for block in self.parts:
            rest = "".join(("" if line.startswith("#include") else line) + "\n" for line in block.text.splitlines())
            text += PART % (block.line, block.line + 1, block.page, rest)
        source = self.folder / "parts.cpp"
        source.write_text(text, encoding="utf-8")
        self.run(self.parts[0], [*shlex.split(self.options.compile), "-c", str(source), "-o", "/dev/null"])

    def check_figures(self, page, text):
        """Checks that the figures in a page's comments are in the page, and in what their commands print."""
        said = " ".join(re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL).split())
        if len(FIGURES.findall(text)) != text.count("<!-- printed by:"):
            self.fault(page, "a comment about figures is not of the form COMMAND | FIGURE ...")
        for found in FIGURES.finditer(text):
            place = f"{page}:{text.count(chr(10), 0, found.start()) + 1}"
            command, *figures = " ".join(found[0][len("<!-- printed by:"):-len("-->")].split()).split(" | ")
            printed = self.run(place, ["bash", "-eu", "-o", "pipefail", "-c", command])
            for figure in figures:
                if figure not in printed:
                    self.fault(place, f"'{figure}' is not printed by {command}:\n{printed[-2000:]}")
                if figure not in said:
                    self.fault(place, f"'{figure}' is not in the page")

    def run_block(self, block):
        if block.comment:
            kind, where = block.comment
            if kind == "not run:":
                self.not_run.append(f"{block}: {where}")
            elif not (Path(self.options.source) / where).exists():
                self.fault(block, f"is said to be in {where}, which is not there")
            elif kind == "lines of":
                self.check_lines(block, (Path(self.options.source) / where).read_text(encoding="utf-8"))
            return
        if block.language == "text":
            if self.printed is not None:
                self.check_text(block)
            return
        self.ran += 1
        if block.language == "sh":
            self.run_sh(block)
        elif block.language in ("cpp", "c"):
            self.run_program(block, "." + block.language)
        elif block.language == "python":
            self.printed = self.run(block, [sys.executable, "-c", block.text]).splitlines()
        elif block.language == "json":
            try:
                json.loads(block.text)
            except ValueError as error:
                self.fault(block, f"not JSON: {error}")
        else:
            self.fault(block, f"a block of language '{block.language}', which no one runs")


def main():
    parser = argparse.ArgumentParser(description="Runs every code block of the documentation.")
    for name in ("bendy", "source", "compile"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--link", default="")
    parser.add_argument("pages", nargs="+", metavar="PAGE")
    options = parser.parse_args()
    faults, not_run, ran = [], [], 0
    for page in options.pages:
        text = (Path(options.source) / page).read_text(encoding="utf-8")
        blocks, indented = blocks_of(page, text)
        faults += [f"{page}:{line}: an indented block: fence it and name its language" for line in indented]
        with tempfile.TemporaryDirectory(prefix="bendy-docs-") as folder:
            for name in ("mannequin", "tentacle"):
                shutil.copy(Path(options.source) / f"examples/{name}.glb", folder)
            (Path(folder) / "examples").symlink_to(".")  # the README says "cd examples" first
            subprocess.run([options.bendy, "convert", "-q", "mannequin.glb"], cwd=folder, check=True, stderr=subprocess.DEVNULL)
            runner = Runner(options, Path(folder))
            for block in blocks:
                if block.language != "text":
                    runner.printed = None
                runner.run_block(block)
            runner.compile_parts()
            runner.check_figures(page, text)
        print(f"{page}: {runner.ran} blocks run")
        faults += runner.faults
        not_run += runner.not_run
        ran += runner.ran
    print(f"{ran} blocks run; {len(not_run)} not run:", *not_run, sep="\n    ")
    for fault in faults:
        print("FAULT", fault)
    return 1 if faults or ran == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
