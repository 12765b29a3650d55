"""Runs the block of docs/languages.md for Blender: what it imports is there, and what it exports is the same character.

blender -b --factory-startup --python check_languages.py -- BENDY docs/languages.md FOLDER_WITH_MANNEQUIN
"""
import os
import re
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from posing import arguments, check          # first: it makes the add-on known
from bendy_file import BendyFile, enable_addon


def main():
    bendy, page, folder = arguments()
    enable_addon(bendy)
    with open(page, encoding='utf-8') as file:
        block = re.search(r'^```python\n(import bpy\n.*?)^```$', file.read(), re.MULTILINE | re.DOTALL)[1]
    os.chdir(folder)
    exec(compile(block, page, 'exec'), {})
    check(any(obj.type == 'ARMATURE' for obj in bpy.data.objects), 'nothing was imported')
    before, after = (BendyFile(bendy, name) for name in ('mannequin.bendy', 'changed.bendy'))
    check([clip['name'] for clip in after.clips()] == [clip['name'] for clip in before.clips()], 'other clips')
    check(len(after.rig()['chains']) == len(before.rig()['chains']) > 0, 'other chains')


main()
