#!/usr/bin/env python3
"""Writes the cases of the manifests as single files: DIR/FAMILY/NAME.bendy, and its report NAME.json beside it.

    python3 tests/conformance/unpack.py DIR [FAMILY ...]   without a family: all of them

Python 3, nothing else.
"""

import json
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent


def write(cases, folder):
    """Writes the cases of one family into its folder; returns the number of cases."""
    folder.mkdir(parents=True, exist_ok=True)
    for case in cases:
        file = folder / (case['name'] + '.bendy')
        file.write_bytes(bytes.fromhex(case['bytes']))
        report = {'file': file.name, **{key: case[key] for key in ('why', 'valid', 'faults')}}
        text = json.dumps(report, indent=2, ensure_ascii=False) + '\n'
        file.with_suffix('.json').write_bytes(text.encode('utf-8'))
    return len(cases)


def unpack(folder, families=()):
    """Unpacks the manifests of these families, or of all, into the folder; returns the number of cases."""
    manifests = [HERE / (family + '.json') for family in families] or sorted(HERE.glob('*.json'))
    count = 0
    for path in manifests:
        content = json.loads(path.read_text(encoding='utf-8'))
        count += write(content['cases'], pathlib.Path(folder) / content['family'])
    return count


if __name__ == '__main__':
    if len(sys.argv) < 2 or sys.argv[1].startswith('-'):
        sys.exit(__doc__)
    print('%d files' % unpack(sys.argv[1], sys.argv[2:]))
