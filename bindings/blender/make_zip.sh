#!/bin/sh
# Makes bendy_rig.zip, which Blender's preferences install: make_zip.sh [FOLDER]. The same files give the same bytes.
if [ $# -gt 1 ] || [ ! -d "${1:-.}" ]; then
    echo "usage: make_zip.sh [FOLDER]: a folder that is there" >&2
    exit 2
fi
python3 -B - "$(dirname "$0")" "${1:-.}" <<'END'
import pathlib, sys, zipfile
source, folder = map(pathlib.Path, sys.argv[1:])
sys.path.insert(0, str(source))
import check_manifest
manifest = source / 'bendy_rig' / 'blender_manifest.toml'
faults = check_manifest.faults(manifest.read_text(encoding='utf-8'))
if faults:
    sys.exit('\n'.join(f'{manifest}: {fault}' for fault in faults))
with zipfile.ZipFile(folder / 'bendy_rig.zip', 'w') as archive:
    for path in [*sorted([*(source / 'bendy_rig').glob('*.py'), manifest]), source.resolve().parents[1] / 'LICENSE']:
        entry = zipfile.ZipInfo(f'bendy_rig/{path.name}')  # of 1980, whenever it was checked out
        entry.compress_type, entry.create_system, entry.external_attr = zipfile.ZIP_DEFLATED, 3, 0o100644 << 16
        archive.writestr(entry, path.read_bytes())
END
