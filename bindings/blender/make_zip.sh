#!/bin/sh
# Makes bendy_rig.zip, which Blender's preferences install: make_zip.sh [FOLDER]
python3 - "$(dirname "$0")" "${1:-.}" <<'END'
import pathlib, sys, zipfile
source, folder = map(pathlib.Path, sys.argv[1:])
with zipfile.ZipFile(folder / 'bendy_rig.zip', 'w', zipfile.ZIP_DEFLATED) as archive:
    for path in sorted([*(source / 'bendy_rig').glob('*.py'), source / 'bendy_rig' / 'blender_manifest.toml']):
        archive.write(path, path.relative_to(source))
END
