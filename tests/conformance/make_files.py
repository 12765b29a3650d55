#!/usr/bin/env python3
"""Makes the conformance files and their reports, one manifest FAMILY.json for each family, from descriptions/*.txt.

    python3 tests/conformance/make_files.py              write the manifests
    python3 tests/conformance/make_files.py --check      change nothing; print which manifests differ; exit 1 if any does
    python3 tests/conformance/make_files.py --large DIR  write into DIR the cases that are too large for a manifest, unpacked

Python 3, nothing else.
"""

import json
import pathlib
import re
import sys

sys.dont_write_bytecode = True
import notation  # noqa: E402
import payloads  # noqa: E402
import unpack  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent


def read_classes():
    """code -> class, from the tables of spec/diagnostics.md"""
    page = (payloads.ROOT / 'spec' / 'diagnostics.md').read_text(encoding='utf-8')
    return dict(re.findall(r'^\| `([A-Z0-9_]+)` \| (\w+) \|', page, re.MULTILINE))


def read_cases(large):
    """family -> cases, as the manifest stores them"""
    classes = read_classes()
    families = {}
    for file in notation.read_all(HERE / 'descriptions', large):
        faults = [{'code': code, 'class': classes[code], 'path': path, 'offset': offset} for offset, code, path in file.faults]
        families.setdefault(file.family, []).append(
            {'name': file.name, 'why': file.why, 'valid': not faults, 'faults': faults, 'bytes': file.data.hex()})
    return families


def manifest(family, cases):
    """The manifest's text: two lines for each case, the report and the bytes."""
    lines = []
    for case in sorted(cases, key=lambda case: case['name']):
        report = json.dumps({key: value for key, value in case.items() if key != 'bytes'}, ensure_ascii=False)
        lines.append('%s,\n "bytes": "%s"}' % (report[:-1], case['bytes']))
    return '{"family": "%s", "cases": [\n%s\n]}\n' % (family, ',\n'.join(lines))


def main(arguments):
    if len(arguments) == 2 and arguments[0] == '--large':
        for family, cases in read_cases(True).items():
            unpack.write(cases, pathlib.Path(arguments[1]) / family)
        return 0
    if arguments not in ([], ['--check']):
        sys.exit(__doc__)
    wanted = {HERE / (family + '.json'): manifest(family, cases).encode('utf-8') for family, cases in read_cases(False).items()}
    stale = 0
    for path in sorted({*HERE.glob('*.json'), *wanted}):
        if path.exists() and path.read_bytes() == wanted.get(path):
            continue
        stale += 1
        print('%s is not what make_files.py makes' % path.name if arguments else path.name)
        if arguments:
            continue
        if path in wanted:
            path.write_bytes(wanted[path])
        elif path.read_text(encoding='utf-8').startswith('{"family": '):  # it has made no other
            path.unlink()
    return 1 if arguments and stale else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
