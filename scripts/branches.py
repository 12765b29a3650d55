"""Branches in what `llvm-cov export` writes, all instantiations of a template together."""

import os


def branches_of(entry, lines):
    """{(line, column): [times true, times false]} of a file's entry; `lines` is its text. A branch that the compiler
    decides is none."""
    counts = {}
    for line, column, _, _, is_true, is_false, *_ in entry["branches"]:
        if "if constexpr" in lines[line - 1]:
            continue
        before = counts.setdefault((line, column), [0, 0])
        before[0] += is_true
        before[1] += is_false
    return counts


def text_of(path):
    with open(path, encoding="utf-8") as source:
        return source.read().split("\n")


def files_of(export):
    """Path from the project's root, and entry, of each of the project's files."""
    here = os.path.realpath(".") + "/"
    for entry in export["data"][0]["files"]:
        path = os.path.realpath(entry["filename"])
        if path.startswith(here):
            yield path.removeprefix(here), entry
