#!/usr/bin/env python3
"""Reads `llvm-cov export` from standard input and prints each branch of files that went one way only, with its line.

    missed_branches.py [FILE...]     no file: those of verification
"""

import json
import sys

from branches import branches_of, files_of, text_of
from coverage_table import VERIFICATION

wanted = sys.argv[1:] or VERIFICATION
for path, entry in files_of(json.load(sys.stdin)):
    if path not in wanted:
        continue
    lines = text_of(path)
    for (line, column), (is_true, is_false) in sorted(branches_of(entry, lines).items()):
        if not is_true or not is_false:
            way = "reached" if is_true == is_false else "true" if not is_true else "false"
            print(f"{path}:{line}:{column}: never {way}: {lines[line - 1].strip()}")
