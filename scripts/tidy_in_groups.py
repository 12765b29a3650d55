#!/usr/bin/env python3
"""clang-tidy over several sources at once: scripts/tidy_in_groups.py BUILD-FOLDER SOURCE...

Most of clang-tidy's time goes into the headers, so sources with the same flags are read as one: a file that includes
them. A source that does not compile with those before it (both define a function of one name) goes to a later group.
"""
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

GROUP = 40
CONFIG = pathlib.Path(__file__).resolve().parent.parent / ".clang-tidy"


def flags_of(entry):
    """The compiler's arguments without the program, the output and the source."""
    words = entry["arguments"] if "arguments" in entry else shlex.split(entry["command"])
    while not words[0].endswith("++"):  # a launcher
        words = words[1:]
    kept, skip = [], False
    for word in words[1:]:
        if skip or word in ("-o", "-MF", "-MT", "-c", "-MD", entry["file"]):
            skip = not skip and word in ("-o", "-MF", "-MT")
            continue
        kept.append(word)
    return ("-Wno-unknown-warning-option", *kept)


def read_build(build):
    """The flags of every source of the build, also of those that it compiles several at a time."""
    flags = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        file = pathlib.Path(entry["directory"], entry["file"])
        if file.suffix == ".c":
            continue
        sources = [str(file)]
        if file.parent.parent.name == "batches":
            sources = [os.path.normpath(file.parent / name) for name in re.findall(r'^#include "(.*)"$', file.read_text(), re.MULTILINE)]
        for source in sources:
            flags[source] = flags_of(entry)
    return flags


class Group:
    """Sources that compile as one."""

    def __init__(self, folder, flags, sources):
        self.flags = flags
        self.sources = sources
        self.file = folder / f"{hashlib.md5(repr((flags, sources)).encode()).hexdigest()}.cpp"
        self.lines = []
        for number, source in enumerate(sources):
            self.lines += ["#undef main", f"#define main main_{number}"]  # programs go together, too
            self.lines.append(f'#include "{source}"  // NOLINT(bugprone-suspicious-include)')
        self.file.write_text("\n".join(self.lines) + "\n")

    def misfits(self):
        """Those that do not compile behind the others."""
        if len(self.sources) == 1:
            return []
        done = subprocess.run(["clang++", "-fsyntax-only", "-w", "-ferror-limit=0", *self.flags, str(self.file)],
                              capture_output=True, text=True)
        faulty = {self.lines[int(line) - 1] for line in re.findall(rf"^In file included from {re.escape(str(self.file))}:(\d+):", done.stderr, re.MULTILINE)}
        if done.returncode == 0:
            return []
        return [source for source in self.sources if any(f'"{source}"' in line for line in faulty)] or self.sources[1:]

    def lint(self):
        """Exit status and findings."""
        target = self.file if len(self.sources) > 1 else self.sources[0]
        done = subprocess.run(["clang-tidy", "--quiet", "--warnings-as-errors=*", f"--config-file={CONFIG}", str(target), "--", *self.flags],
                              capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr


def make_groups(folder, flags, sources):
    groups = []
    while sources:
        chosen, later = sources[:GROUP], sources[GROUP:]
        group = Group(folder, flags, chosen)
        while misfits := group.misfits():
            later += misfits
            group = Group(folder, flags, [source for source in group.sources if source not in misfits])
        groups.append(group)
        sources = later
    return groups


def main():
    build, *sources = [pathlib.Path(argument).resolve() for argument in sys.argv[1:]]
    flags = read_build(build)
    by_flags = collections.defaultdict(list)
    for source in map(str, sources):
        if source not in flags:
            sys.exit(f"{source}: not in the build, so nobody knows its flags")
        by_flags[flags[source]].append(source)
    folder = build / "lint"
    folder.mkdir(exist_ok=True)
    failed = False
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as workers:
        groups = [group for made in workers.map(lambda item: make_groups(folder, *item), by_flags.items()) for group in made]
        groups.sort(key=lambda group: -len(group.sources))
        for status, text in workers.map(Group.lint, groups):
            failed |= status != 0
            if status:
                print(text, end="")
    sys.exit(failed)


if __name__ == "__main__":
    main()
