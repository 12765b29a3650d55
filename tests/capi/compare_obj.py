#!/usr/bin/env python3
"""Runs commands that write OBJ, and holds what they write against each other: compare_obj.py COMMAND... -- COMMAND... [-- COMMAND...]

Vertices, normals and triangles must be the same: numbers as floats, to the bit."""

import itertools
import struct
import subprocess
import sys


def elements(command):
    text = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    lists = {"v": [], "vn": [], "f": []}
    for line in text.splitlines():
        keyword, *words = line.split()
        if keyword == "f":
            lists["f"].append(words)
        elif keyword in lists:
            lists[keyword].append(struct.pack(f"{len(words)}f", *map(float, words)))
    return lists


def main():
    groups = itertools.groupby(sys.argv[1:], lambda word: word == "--")
    commands = [list(words) for is_separator, words in groups if not is_separator]
    first, *others = [elements(command) for command in commands]
    if not others or not all(first.values()):
        sys.exit("nothing to compare")
    for command, other in zip(commands[1:], others):
        for keyword, list_ in first.items():
            if other[keyword] != list_:
                sys.exit(f"{command[0]}: {keyword} differs from what {commands[0][0]} writes")
    print(f"{len(first['v'])} vertices, {len(first['f'])} triangles are the same from {len(commands)} programs")


if __name__ == "__main__":
    main()
