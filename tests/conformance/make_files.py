#!/usr/bin/env python3
"""Makes the conformance files and their reports from descriptions/*.txt.

    python3 tests/conformance/make_files.py              write files/
    python3 tests/conformance/make_files.py --check      change nothing; say what differs; exit 1 if anything does
    python3 tests/conformance/make_files.py --large DIR  write into DIR what is too large to be kept

Python 3, nothing else.
"""

import json
import pathlib
import re
import sys

sys.dont_write_bytecode = True
import notation  # noqa: E402
import payloads  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
FILES = HERE / 'files'


def read_classes():
    """code -> class, from the tables of spec/diagnostics.md"""
    page = (payloads.ROOT / 'spec' / 'diagnostics.md').read_text(encoding='utf-8')
    return dict(re.findall(r'^\| `([A-Z0-9_]+)` \| (\w+) \|', page, re.MULTILINE))


def report(file, classes):
    """What a reader has to say of the file, as JSON text."""
    faults = [{'code': code, 'class': classes[code], 'path': path, 'offset': offset} for offset, code, path in file.faults]
    return json.dumps({'file': file.name + '.bendy', 'why': file.why, 'valid': not faults, 'faults': faults},
                      indent=2, ensure_ascii=False) + '\n'


def made(files, folder, classes):
    """path -> bytes"""
    result = {}
    for file in files:
        base = folder / file.family / file.name
        result[base.with_suffix('.bendy')] = file.data
        result[base.with_suffix('.json')] = report(file, classes).encode('utf-8')
    return result


def main(arguments):
    classes = read_classes()
    if len(arguments) == 2 and arguments[0] == '--large':
        for path, data in made(notation.read_all(HERE / 'descriptions', True), pathlib.Path(arguments[1]), classes).items():
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        return 0
    if arguments not in ([], ['--check']):
        sys.exit(__doc__)
    wanted = made(notation.read_all(HERE / 'descriptions', False), FILES, classes)
    kept = {path for path in FILES.glob('*/*') if path.is_file()}
    stale = 0
    for path in sorted(kept | set(wanted)):
        if path in kept and path in wanted and path.read_bytes() == wanted[path]:
            continue
        stale += 1
        print('%s is not what make_files.py makes' % path.relative_to(HERE) if arguments else path.relative_to(HERE))
        if arguments:
            continue
        if path not in wanted:
            path.unlink()
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(wanted[path])
    return 1 if arguments and stale else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
