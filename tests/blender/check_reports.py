"""What the add-on tells when Blender says more than the records can, and when something goes wrong.

blender -b --factory-startup --python check_reports.py -- FOLDER
"""
import hashlib
import json
import math
import os
import sys

import addon_utils
import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from file_nodes import Nodes
from limits import angle_between
from posing import arguments, check, read_glb
from rigkit import empty_scene, make_armature

UP = (0, -1, 0)


def strange_rig():
    """Of everything that is not said, or not quite, one."""
    empty_scene(1)
    bones = [dict(name=f'b{i}', head=(0.1 * (i % 2), 0, i), tail=(0.1 * ((i + 1) % 2), 0, i + 1), z_axis=UP,
                  parent=f'b{i - 1}' if i else None) for i in range(8)]
    rig = make_armature('Strange', bones + [dict(name='aim', head=(2, 0, 2), tail=(2, 0, 3), z_axis=UP, deform=False)])
    rig.rotation_euler, rig.location = (0.3, 0.2, 0.1), (1, 2, 3)
    bone = rig.pose.bones
    bone['b0'].constraints.new('COPY_ROTATION').name = 'Follow'
    bone['b0'].constraints.new('DAMPED_TRACK').mute = True
    for name, space in (('b1', 'POSE'), ('b2', 'CUSTOM'), ('b3', 'LOCAL'), ('b4', 'LOCAL'), ('b5', 'LOCAL')):
        limit = bone[name].constraints.new('LIMIT_ROTATION')
        limit.owner_space, limit.use_limit_x, limit.min_x, limit.max_x = space, True, -0.1, 0.2
    bone['b2'].constraints[0].space_object = rig
    bone['b3'].constraints[0].mute = True
    bone['b4'].constraints[0].influence = 0.25
    bone['b5'].constraints[0].min_x = 0.7                   # above the maximum, which wins
    place = bone['b5'].constraints.new('LIMIT_LOCATION')
    place.owner_space, place.use_max_z, place.max_z = 'LOCAL', True, 0.5
    second = bone['b5'].constraints.new('LIMIT_ROTATION')
    second.owner_space, second.use_limit_y = 'LOCAL', True
    bone['b6'].lock_ik_y = bone['b6'].use_ik_limit_x = True
    bone['b7'].use_ik_limit_z = True
    bone['b6'].ik_min_x, bone['b6'].ik_stretch = -0.5, 0.25
    for name in ('b3', 'b7'):
        ik = bone[name].constraints.new('IK')
        ik.target, ik.subtarget, ik.chain_count = rig, 'aim', 2
    bone['b7'].constraints[0].use_rotation = True
    bone['b7'].constraints[0].orient_weight = 0.5
    bpy.ops.object.camera_add()
    bpy.context.object.constraints.new('LIMIT_ROTATION')
    return rig


EXPECTED = [
    'b0: Copy Rotation "Follow" has no record: left out; clips are exported with its effect',
    'b1: Limit Rotation is not in local space, so what it allows depends on the pose of the parents',
    'b2: Limit Rotation is in the space of Strange',
    'b3: Limit Rotation is muted: left out',
    'b4: Limit Rotation has the influence 0.25',
    'b5: 2 Limit Rotation constraints, which Blender keeps one after the other',
    "b6: IK limits: one swing axis is free and the twist is locked, so Blender itself forgets the other one's limit",
    'Camera: Limit Rotation: only bones have limits and chains: left out',
    'IK.b7: one of several chains named IK',
]


def hooks():
    """The add-on's module, which is there once the add-on is enabled."""
    return sys.modules['bendy_rig.export_hooks']


def export(path, **options):
    """Through the add-on's operator; returns the error's text, or None."""
    try:
        result = bpy.ops.export_scene.bendy_rig(filepath=path, options=json.dumps(options))
    except RuntimeError as error:
        return str(error)
    check(result == {'FINISHED'}, 'no error and not finished')
    return None


def joints(document):
    return {node['name']: node['extras']['rig_joint'] for node in document['nodes'] if 'rig_joint' in node.get('extras', {})}


def chains(document):
    return [chain for node in document['nodes'] for chain in node.get('extras', {}).get('rig_ik', {}).get('chains', [])]


def check_strange(path):
    check(export(path, export_cameras=True) is None, 'not exported')
    notes = hooks().LastExport.report.notes
    for text in EXPECTED:
        check(text in notes, f'"{text}" is not among {notes}')
    check(len(notes) == len(EXPECTED), f'more than expected: {sorted(set(notes) - set(EXPECTED))}')
    document = read_glb(path)
    records = joints(document)
    check({name for name, record in records.items() if record.get('approximated')} == {'b1', 'b2', 'b4', 'b5'}, 'approximated')
    check({name for name, record in records.items() if 'notes' in record} == {'b0', 'b1', 'b2', 'b3', 'b4', 'b5', 'b6'}, 'notes')
    check('euler_limits' not in records['b0'] and 'euler_limits' not in records['b3'], 'muted')
    check(records['b1']['euler_limits'][0]['space'] == 'armature' and 'zero' in records['b1']['euler_limits'][0], f'{records["b1"]}')
    check(records['b4']['euler_limits'][0]['influence'] == 0.25, f'{records["b4"]}')
    check(records['b5']['euler_limits'][0]['x'] == [0.2, 0.2], f'{records["b5"]}')
    check(records['b5']['location_limits'] == [{'space': 'rest', 'z': [None, 0.5]}], f'{records["b5"]}')
    check(records['b6']['stretch'] == 0.25, f'{records["b6"]}')
    check([chain['name'] for chain in chains(document)] == ['IK', 'IK.b7'], 'names of chains')
    check(chains(document)[1]['orientation_weight'] == 0.5, 'orientation weight')


def check_places(path):
    """The armature is turned and moved, and the file's second sources say the same."""
    document = read_glb(path)
    nodes = Nodes(document)
    for name, record in joints(document).items():
        if 'rest_orientation' in record:
            check(angle_between(record['rest_orientation'], nodes.rotation(name)) < 1e-5, f'{name}: rest orientation')
    for chain in chains(document):
        check(math.dist(chain['target']['position'], nodes.position('aim', above='Strange')) < 1e-5, f'{chain["name"]}: target')


def check_again(path):
    """The same bytes a second time, from the plain exporter too while the add-on is enabled; not the rig when it is not."""
    def digest(name):
        with open(name, 'rb') as file:
            return hashlib.sha256(file.read()).hexdigest()
    first = digest(path)
    check(export(path, export_cameras=True) is None and digest(path) == first, 'other bytes the second time')
    check('bendy_rig' not in bpy.context.preferences.addons, 'the preferences are not as before')
    bpy.ops.export_scene.gltf(filepath=path, export_cameras=True)
    check(not joints(read_glb(path)), 'the rig is written though the add-on is not enabled')
    addon_utils.enable('bendy_rig', default_set=True)
    bpy.ops.export_scene.gltf(filepath=path, export_cameras=True, export_extras=True)
    check(digest(path) == first, 'the plain exporter writes something else')
    addon_utils.disable('bendy_rig', default_set=True)
    addon_utils.enable('bendy_rig')


def check_options(folder):
    path = os.path.join(folder, 'separate.gltf')
    check(export(path, export_def_bones=True) is None, 'not exported')
    with open(path, encoding='utf-8') as file:
        document = json.load(file)
    check(len(chains(document)) == 2 and 'aim' not in [node['name'] for node in document['nodes']], 'deformation bones only')
    check(any('its target aim is not in the file' in note for note in hooks().LastExport.report.notes), f'{hooks().LastExport.report.notes}')
    check('no option export_nothing' in export(path, export_nothing=1), 'an option that is none')


def check_failure(folder):
    """A hook that fails must not end in a file that looks well."""
    path, working = os.path.join(folder, 'failed.glb'), hooks().joint_record

    def failing(bone, axes):
        raise KeyError('made to fail')
    hooks().joint_record = failing
    try:
        error = export(path)
    finally:
        hooks().joint_record = working
    check(error and 'made to fail' in error and 'Traceback' not in error, f'{error}')
    check(not os.path.exists(path), 'a file was written')
    check(export(path) is None, 'the next export fails too')


def check_menu():
    """The entry is there, and goes when the add-on goes."""
    drawn = lambda: [f.__module__ for f in bpy.types.TOPBAR_MT_file_export._dyn_ui_initialize()]
    check('bendy_rig.export_operator' in drawn(), 'no menu entry')


def main():
    folder = arguments()[0]
    strange_rig()                   # loads factory settings, which know no add-on
    addon_utils.enable('bendy_rig')
    path = os.path.join(folder, 'strange.glb')
    check_strange(path)
    check_places(path)
    check_again(path)
    check_options(folder)
    check_failure(folder)
    check_menu()
    print(f'Reports: {len(EXPECTED)} notes, failures and options are as they should be')


main()
