#!/usr/bin/env python3
"""clang-tidy over several sources at once: scripts/tidy_in_groups.py BUILD-FOLDER SOURCE...

Most of clang-tidy's time goes into the headers, so sources of one folder with the same flags are read as one: a file
that includes them. Sources that cannot be read together (two have a function of one name) are parted until they can.
"""
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import sys

GROUP = 12


def flags_of(entry):
    """The compiler's arguments without the program, the output, the source and the precompiled header, which is another compiler's."""
    words = entry["arguments"] if "arguments" in entry else shlex.split(entry["command"])
    while not words[0].endswith("++"):  # a launcher
        words = words[1:]
    kept, skip = [], False
    for word, following in zip(words[1:], words[2:] + [""]):
        if word == "-Winvalid-pch" or word.endswith("cmake_pch.hxx") or (word == "-include" and following.endswith("cmake_pch.hxx")):
            continue
        if skip or word in ("-o", "-MF", "-MT", "-c", "-MD", entry["file"]):
            skip = not skip and word in ("-o", "-MF", "-MT")
            continue
        kept.append(word)
    return tuple(kept)


class Linter:
    def __init__(self, build):
        self.folder = build / "lint"
        self.folder.mkdir(exist_ok=True)
        self.entries = {entry["file"]: entry for entry in json.loads((build / "compile_commands.json").read_text())}

    def groups(self, sources):
        by_flags = collections.defaultdict(list)
        for source in sources:
            path = str(source.resolve())
            if path not in self.entries:
                sys.exit(f"{source}: not in the build, so nobody knows its flags")
            by_flags[flags_of(self.entries[path]), source.parent].append(path)
        for (flags, _), paths in by_flags.items():
            for first in range(0, len(paths), GROUP):
                yield flags, paths[first:first + GROUP]

    def run(self, flags, paths):
        """The findings, and whether there are none."""
        together = self.folder / f"{hashlib.md5(repr(paths).encode()).hexdigest()}.cpp"
        together.write_text("".join(f'#include "{path}"  // NOLINT(bugprone-suspicious-include)\n' for path in paths))
        command = ["-Wno-unknown-warning-option", *flags]
        place = self.entries[paths[0]]["directory"]
        if len(paths) > 1:
            reads = subprocess.run(["clang++", "-fsyntax-only", "-w", *command, str(together)], cwd=place, capture_output=True)
            if reads.returncode != 0:
                half = len(paths) // 2
                return [found for part in (paths[:half], paths[half:]) for found in self.run(flags, part)]
        target = str(together) if len(paths) > 1 else paths[0]
        done = subprocess.run(["clang-tidy", "--quiet", "--warnings-as-errors=*", f"--config-file={CONFIG}", target, "--", *command],
                              cwd=place, capture_output=True, text=True)
        return [(done.returncode, done.stdout, done.stderr if done.returncode else "")]


CONFIG = pathlib.Path(__file__).resolve().parent.parent / ".clang-tidy"


def main():
    build, *sources = [pathlib.Path(argument) for argument in sys.argv[1:]]
    linter = Linter(build.resolve())
    failed = False
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for results in pool.map(lambda group: linter.run(*group), list(linter.groups(sources))):
            for status, out, err in results:
                failed |= status != 0
                if status:
                    print(out + err, end="")
    sys.exit(failed)


if __name__ == "__main__":
    main()
