"""Imports and exports that fail: an error that says why, and nothing left behind in the scene or on the disk.

blender -b --factory-startup --python check_import_errors.py -- BENDY FILE.bendy FILE.glb FOLDER
"""
import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from posing import arguments, check          # first: it makes the add-on known
from bendy_file import enable_addon

BLOCKS = ('objects', 'meshes', 'armatures', 'actions', 'materials', 'images', 'shape_keys', 'collections', 'scenes')


def state():
    scene = bpy.context.scene
    blocks = {name: sorted(block.name for block in getattr(bpy.data, name)) for name in BLOCKS}
    selected = [obj.name for obj in bpy.context.selected_objects]
    return blocks, sorted(scene.keys()), scene.render.fps, scene.frame_start, scene.frame_end, selected


def error_of(operator, **options):
    try:
        result = operator(**options)
    except RuntimeError as error:
        return str(error)
    check(result == {'CANCELLED'}, f'{operator} has {result}')
    return ''


def fails(what, wanted, operator, **options):
    before = state()
    error = error_of(operator, **options)
    check(wanted in error and 'Traceback' not in error, f'{what}: {error!r} does not say {wanted!r}')
    check(state() == before, f'{what}: {before} is now {state()}')


def set_program(path):
    bpy.context.preferences.addons['bendy_rig'].preferences.program = path


def check_imports(bendy, path, glb, folder):
    read = bpy.ops.import_scene.bendy
    broken = os.path.join(folder, 'broken.bendy')
    with open(path, 'rb') as source, open(broken, 'wb') as file:
        file.write(source.read()[:5000])
    fails('a broken file', 'broken.bendy', read, filepath=broken)
    fails('a file of another kind', 'not a bendy file', read, filepath=glb)
    fails('no file', 'missing.bendy', read, filepath=os.path.join(folder, 'missing.bendy'))
    set_program(os.path.join(folder, 'no_program'))
    fails('no program', 'is not a program', read, filepath=path)
    set_program('')
    searched, os.environ['PATH'] = os.environ['PATH'], folder
    places, sys.modules['bendy_rig.program'].PLACES = sys.modules['bendy_rig.program'].PLACES, (folder,)
    fails('no program on the PATH', 'is not on the PATH', read, filepath=path)
    os.symlink(bendy, os.path.join(folder, 'bendy'))
    check(sys.modules['bendy_rig.program'].find_program() == os.path.join(folder, 'bendy'), 'not found on the PATH')
    os.environ['PATH'], sys.modules['bendy_rig.program'].PLACES = searched, places
    set_program(bendy)
    import_rig = sys.modules['bendy_rig.import_rig']
    working = import_rig.make_bones

    def failing(rig, chains):
        raise sys.modules['bendy_rig.program'].BendyError('made to fail')
    import_rig.make_bones = failing
    try:
        fails('half-way', 'made to fail', read, filepath=path)
    finally:
        import_rig.make_bones = working
    check(read(filepath=path) == {'FINISHED'}, 'the next import fails too')


def check_exports(folder):
    write, out = bpy.ops.export_scene.bendy, os.path.join(folder, 'out.bendy')
    set_program(os.path.join(folder, 'no_program'))
    fails('no program', 'is not a program', write, filepath=out)
    check(not os.path.exists(out), 'a failed export has left a file')
    with open(out, 'w', encoding='utf-8') as file:
        file.write('kept')
    fails('no program', 'is not a program', write, filepath=out)
    with open(out, encoding='utf-8') as file:
        check(file.read() == 'kept', 'a failed export has changed a file')
    check(write.get_rna_type().properties['check_existing'].default, 'Blender does not ask before it replaces a file')


def check_menus():
    for menu, module in ((bpy.types.TOPBAR_MT_file_import, 'import_operator'), (bpy.types.TOPBAR_MT_file_export, 'export_operator'),
                         (bpy.types.VIEW3D_MT_pose_constraints, 'pose_constraints')):
        drawn = [function.__module__ for function in menu._dyn_ui_initialize()]
        check(f'bendy_rig.{module}' in drawn, f'no menu entry of {module}')


def main():
    bendy, path, glb, folder = arguments()
    bpy.ops.wm.read_factory_settings()
    enable_addon(bendy)
    check_menus()
    check_imports(bendy, path, glb, folder)
    check_exports(folder)
    print('Import errors: said, and nothing is left behind')


main()
