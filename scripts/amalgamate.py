#!/usr/bin/env python3
"""Makes the runtime as two files to drop into a project, bendy_runtime.h and bendy_runtime.cpp: amalgamate.py OUTPUT_FOLDER

They hold what runtime/CMakeLists.txt and format/CMakeLists.txt list, but for what writes files; nothing else is needed than C++20 and
GLM. What their head says is true of them is tested by tests/amalgamated."""

import argparse
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# Also in the header, beside the runtime's own: errors in words.
FURTHER_HEADERS = ["bendy/format/diagnostics.h"]
WRITES_FILES = re.compile(r"src/(\w+_writer|write_files.*)\.cpp")
# In the name of a source that there is one of for each kind of system.
SYSTEM = "${BENDY_SYSTEM}"
SYSTEMS = {"posix": "!defined(_WIN32)", "windows": "defined(_WIN32)"}
# The sources do without each of these where BENDY_WITHOUT_ZSTD, ... is defined.
LIBRARIES = ("ZSTD", "MESHOPTIMIZER")

HEAD = """// Bendy's runtime {version}: opens, poses and skins animated characters. Made by scripts/amalgamate.py; do not edit.
//
//     c++ -std=c++20 -O2 -c bendy_runtime.cpp            # needs GLM; no exceptions, no RTTI
//
// Files with compressed parts (bendy convert --compact) need libraries, which are used if these are defined for bendy_runtime.cpp:
//     BENDY_WITH_ZSTD            zstd, -lzstd
//     BENDY_WITH_MESHOPTIMIZER   meshoptimizer
// Without one, a file that needs it is refused with UNSUPPORTED_CODEC; the number in the error is the codec: 1, 6, 7 need zstd,
// 2 and 4 meshoptimizer, 3 and 5 both.
//
// Kernels: all that the library has, whatever the compiler's flags; which one runs is decided on the machine (BENDY_KERNEL,
// bendy::set_kernel). For the same bits on every machine take the plain one, and compile with -ffp-contract=off where flags
// allow fused multiply-adds (-march=native, -std=gnu++20).
//
"""


def cmake_list(text, keyword):
    """The words after a keyword of bendy_library, up to the next one."""
    match = re.search(rf"\b{keyword}\n(.*?)(?=\n  [A-Z]+\n|\))", text, re.S)
    return match.group(1).split()


def kernel_targets(text):
    """{source: instructions}, of those that are compiled for more than the others: {"src/kernels/skin_avx2.cpp": "avx2,fma"}"""
    targets = {}
    for files, options in re.findall(r"set_source_files_properties\(([^)]*?)\s+PROPERTIES COMPILE_OPTIONS\s+\"?([^\")]*)", text):
        instructions = ",".join(option[2:] for option in options.split(";") if option.startswith("-m"))
        targets.update({file: instructions for file in files.split()})
    return targets


class Joiner:
    """Puts files into one text, each of its own includes in place; those with #pragma once at their first."""

    def __init__(self, seen=()):
        self.seen = set(seen)

    def find(self, name, file):
        for folder in (file.parent, ROOT / "runtime/src", ROOT / "format/include", ROOT / "runtime/include"):
            if (folder / name).is_file():
                return (folder / name).resolve()
        return None

    def expand(self, file):
        text = file.read_text(encoding="utf-8")
        if "#pragma once\n" in text:
            if file in self.seen:
                return []
            self.seen.add(file)
        lines = []
        for line in text.splitlines():
            match = re.match(r'#include [<"]([^>"]+)[>"]', line)
            included = self.find(match.group(1), file) if match else None
            if included is not None:
                lines += self.expand(included)
            elif line != "#pragma once":
                lines.append(line)
        return [f"// ---- {file.relative_to(ROOT)}", *lines]


def for_processor(instructions, lines):
    """Lines of a kernel, its functions compiled for the instructions; whole headers stay outside."""
    includes = [line for line in lines if line.startswith("#include <")]
    body = [line for line in lines if line not in includes]
    return ["#if defined(BENDY_X86_64)", *includes, "#if defined(__clang__)",
            f'#pragma clang attribute push(__attribute__((target("{instructions}"))), apply_to = function)',
            "#pragma clang diagnostic push",  # of what several kernels share, none needs all
            '#pragma clang diagnostic ignored "-Wunused-function"', "#elif defined(__GNUC__)",
            "#pragma GCC push_options", f'#pragma GCC target("{instructions}")', "#endif", *body, "#if defined(__clang__)",
            "#pragma clang diagnostic pop", "#pragma clang attribute pop", "#elif defined(__GNUC__)", "#pragma GCC pop_options", "#endif", "#endif"]


def make_source(joiner, folder, name, instructions, condition=None):
    file = ROOT / folder / name
    own_headers = re.findall(r'^#include [<"]([^>"]+)[>"]', file.read_text(encoding="utf-8"), re.M)
    lines = []
    for header in own_headers:  # before any condition: later files count on them
        found = joiner.find(header, file)
        if header.endswith(tuple(f"_{system}.h" for system in SYSTEMS)):
            continue
        if found is not None and "#pragma once\n" in found.read_text(encoding="utf-8"):
            lines += joiner.expand(found)
    body = joiner.expand(file)
    if instructions:
        body = for_processor(instructions, body)
    if condition:
        body = [f"#if {condition}", *body, "#endif"]
    return lines + body


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", type=Path, help="the folder for the two files")
    output = parser.parse_args().output

    lists = {folder: (ROOT / folder / "CMakeLists.txt").read_text(encoding="utf-8") for folder in ("format", "runtime")}
    version = re.search(r"project\(bendy VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)
    head = HEAD.format(version=version) + "".join(f"// {line}".rstrip() + "\n" for line in (ROOT / "LICENSE").read_text().splitlines())

    joiner = Joiner()
    header = []
    headers = [ROOT / "runtime" / name for name in cmake_list(lists["runtime"], "HEADERS")]
    for file in headers + [ROOT / "format/include" / name for name in FURTHER_HEADERS]:
        header += joiner.expand(file.resolve())

    source = ['#include "bendy_runtime.h"']
    for library in LIBRARIES:
        source += [f"#ifndef BENDY_WITH_{library}", f"#define BENDY_WITHOUT_{library}", "#endif"]
    kernels = []
    for folder, text in lists.items():
        targets = kernel_targets(text)
        # Kernels last: what they share with other sources lies before them.
        for name in sorted(cmake_list(text, "SOURCES"), key=lambda name: name in targets):
            if WRITES_FILES.fullmatch(name):
                continue
            instructions = targets.get(name)
            if SYSTEM in name:
                for system, condition in SYSTEMS.items():
                    source += make_source(joiner, folder, name.replace(SYSTEM, system), None, condition)
                continue
            (kernels if instructions else source).extend(make_source(joiner, folder, name, instructions))

    files = {"bendy_runtime.h": ["#pragma once", *header], "bendy_runtime.cpp": source + kernels}
    for name in files:
        if (output / name).exists() and not (output / name).read_bytes().startswith(head[:20].encode()):
            sys.exit(f"amalgamate.py: {output / name} is there and was not made by this script")
    output.mkdir(parents=True, exist_ok=True)
    for name, lines in files.items():
        (output / name).write_text(head + "\n".join(lines) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
