#!/usr/bin/env python3
"""Holds what `bendy validate --json` says of every conformance file against its report.

    python3 check_reports.py --bendy PROGRAM [--large]

With --large also what make_files.py --large makes. Paths and offsets count: every fault of the report must be said, and no other.
Saying a fault twice is no difference, nor is the order (spec/diagnostics.md).
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import make_files  # noqa: E402
import unpack  # noqa: E402


def faults_of(report):
    return {(fault['offset'], fault['code'], fault['class'], fault['path']) for fault in report['faults']}


def shown(fault):
    offset, code, _, path = fault
    return '%s at %d, %s' % (code, offset, path if len(path) < 100 else path[:50] + '...' + path[-20:])


def check(program, folder):
    """(files, differences)"""
    files = sorted(folder.glob('*/*.bendy'))
    run = subprocess.run([program, 'validate', '--json', *map(str, files)], stdout=subprocess.PIPE, check=False)
    if run.returncode not in (0, 1):
        sys.exit('%s ended with %d' % (program, run.returncode))
    differences = 0
    for path, said in zip(files, json.loads(run.stdout), strict=True):
        wanted = json.loads(path.with_suffix('.json').read_text(encoding='utf-8'))
        missing = faults_of(wanted) - faults_of(said)
        extra = faults_of(said) - faults_of(wanted)
        if not missing and not extra and said['valid'] == wanted['valid'] and said['faultsLeftOut'] == 0:
            continue
        differences += 1
        print('%s/%s: %s' % (path.parent.name, path.name, wanted['why']))
        for fault in sorted(missing):
            print('    not said:   ' + shown(fault))
        for fault in sorted(extra):
            print('    said wrongly: ' + shown(fault))
    return len(files), differences


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--bendy', required=True)
    parser.add_argument('--large', action='store_true')
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        unpack.unpack(folder)
        if arguments.large:
            make_files.main(['--large', folder])
        count, differences = check(arguments.bendy, pathlib.Path(folder))
    print('%d files, %d differences' % (count, differences))
    return 1 if differences else 0


if __name__ == '__main__':
    sys.exit(main())
