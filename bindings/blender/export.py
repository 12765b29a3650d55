"""Exports a Blender file without a display and without installing the add-on.

blender -b fox.blend --python-exit-code 1 --python export.py -- fox.bendy|fox.glb|fox.gltf [EXPORTER-OPTION=JSON-VALUE ...]
"""
import json
import os
import sys

import addon_utils
import bpy

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))


def main():
    arguments = sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else []
    if not arguments:
        sys.exit(__doc__)
    path, *options = arguments
    options = dict(option.split('=', 1) for option in options)
    addon_utils.enable('bendy_rig')
    export = bpy.ops.export_scene.bendy if path.lower().endswith('.bendy') else bpy.ops.export_scene.bendy_rig
    export(filepath=os.path.abspath(path), options=json.dumps({name: json.loads(value) for name, value in options.items()}))


main()
