#!/usr/bin/env python3
"""Holds the files of every version against its SHA256SUMS: released bytes never change. Python 3, nothing else."""

import hashlib
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent


def main():
    wrong = 0
    for sums in sorted(HERE.glob('*/SHA256SUMS')):
        stated = dict(reversed(line.split()) for line in sums.read_text(encoding='utf-8').splitlines())
        found = {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sums.parent.iterdir() if path != sums}
        for name in sorted(stated.keys() | found.keys()):
            if stated.get(name) != found.get(name):
                wrong += 1
                print('%s/%s has changed, is new or is gone' % (sums.parent.name, name))
    versions = [path for path in HERE.iterdir() if path.is_dir() and path.name[0].isdigit()]
    for folder in versions:
        if not (folder / 'SHA256SUMS').is_file():
            wrong += 1
            print('%s has no SHA256SUMS' % folder.name)
    return 1 if wrong or not versions else 0


if __name__ == '__main__':
    sys.exit(main())
