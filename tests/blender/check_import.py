"""What an import makes of a rig, against the Blender file that the rig comes from; and what an export says of what was changed then.

blender -b --factory-startup FILE.blend --python check_import.py -- BENDY FILE.bendy FOLDER
"""
import math
import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from posing import arguments, check, evaluated, move_target, only_armature       # first: it makes the add-on known
from bendy_file import BendyFile, enable_addon

ANGLE = 2e-3                        # radians, of a pole: where a chain is nearly straight, its bend is not known better
LENGTH = 1e-5                       # metres
EXACT = ('chain_count', 'use_location', 'use_rotation', 'use_stretch', 'iterations', 'influence', 'subtarget', 'pole_subtarget')


def limits_of(bone):
    """Blender's limits, as plain data."""
    limit = next((c for c in bone.constraints if c.type == 'LIMIT_ROTATION'), None)
    data = {}
    for axis in 'xyz':
        if limit and getattr(limit, f'use_limit_{axis}'):
            data[f'rotation {axis}'] = (getattr(limit, f'min_{axis}'), getattr(limit, f'max_{axis}'))
        if getattr(bone, f'lock_ik_{axis}'):
            data[f'ik {axis}'] = (0.0, 0.0)
        elif getattr(bone, f'use_ik_limit_{axis}'):
            data[f'ik {axis}'] = (getattr(bone, f'ik_min_{axis}'), getattr(bone, f'ik_max_{axis}'))
        data[f'stiffness {axis}'] = getattr(bone, f'ik_stiffness_{axis}')
    if limit:
        data['order'], data['space'] = limit.euler_order, limit.owner_space
    data['locks'] = tuple(bone.lock_rotation)
    return data


def chains_of(rig):
    chains = {}
    for bone in rig.pose.bones:
        for constraint in bone.constraints:
            if constraint.type == 'IK':
                chains[constraint.name] = {'bone': bone.name, 'length': bone.bone.length, 'pole_angle': constraint.pole_angle,
                                           **{key: getattr(constraint, key) for key in EXACT}}
    return chains


def compare(source, imported):
    """(limits of bones, chains) each."""
    check(source[0].keys() == imported[0].keys(), 'other bones')
    for name, data in source[0].items():
        check(data == imported[0][name], f'{name}: {data} is now {imported[0][name]}')
    check(source[1].keys() == imported[1].keys(), f'chains: {list(imported[1])}')
    for name, data in source[1].items():
        got = imported[1][name]
        for key in ('bone', *EXACT):
            check(data[key] == got[key], f'{name}: {key} {data[key]} is now {got[key]}')
        check(abs(data['length'] - got['length']) < LENGTH, f'{name}: the tip is at {got["length"]}, not at {data["length"]}')
        check(abs(math.remainder(data['pole_angle'] - got['pole_angle'], 2 * math.pi)) < ANGLE,
              f'{name}: pole angle {data["pole_angle"]} is now {got["pole_angle"]}')
    return sum('space' in data for data in source[0].values()), len(source[1])


def check_muted(rig, is_muted):
    for bone in rig.pose.bones:
        for constraint in bone.constraints:
            check(constraint.mute == is_muted, f'{bone.name}: {constraint.name} is {"" if constraint.mute else "not "}muted')


def check_reach(rig, name):
    """With the constraints enabled, the chain's tip goes with its target."""
    bone, constraint = next((b, c) for b in rig.pose.bones for c in b.constraints if c.type == 'IK' and c.name == name)
    constraint.influence = 1.0
    for pose_bone in rig.pose.bones:
        pose_bone.matrix_basis.identity()
    target = rig.pose.bones[constraint.subtarget].bone.matrix_local.copy()
    start = rig.pose.bones[bone.name].bone.tail_local.copy()
    target.translation = start * 0.98 + rig.data.bones[bone.parent.name].head_local * 0.02
    move_target(rig, constraint.subtarget, target)
    off = (evaluated(rig).pose.bones[bone.name].tail - target.translation).length
    check(off < 5e-3, f'{name}: the tip is {off} m from its target')
    return off


def check_changes(bendy, path, rig, folder):
    """What was changed is exported as Blender has it, even if it is muted; the rest as it came."""
    first = BendyFile(bendy, path).rig()
    limited = [bone for bone in rig.pose.bones if any(c.type == 'LIMIT_ROTATION' for c in bone.constraints)]
    chain = first['chains'][0]['name']
    edited, removed, renamed = limited[1:4]
    edited.constraints[0].min_x, edited.constraints[0].use_limit_x = math.radians(-7), True
    removed.constraints.remove(removed.constraints[0])
    for axis in 'xyz':
        setattr(removed, f'lock_ik_{axis}', False)
        setattr(removed, f'use_ik_limit_{axis}', False)
        setattr(removed, f'ik_stiffness_{axis}', 0.0)
    old_name, edited_name, removed_name = renamed.name, edited.name, removed.name
    renamed.name = 'renamed'
    constraint = next(c for bone in rig.pose.bones for c in bone.constraints if c.type == 'IK' and c.name == chain)
    constraint.iterations = 33
    out = os.path.join(folder, 'changed.bendy')
    check(bpy.ops.export_scene.bendy(filepath=out, export_animations=False) == {'FINISHED'}, 'not exported')
    second = BendyFile(bendy, out).rig()
    check(set(second['joints']) == set(first['joints']) - {removed_name, old_name} | {'renamed'}, f'{list(second["joints"])}')
    for name, record in first['joints'].items():
        if name not in (edited_name, removed_name):
            now = second['joints']['renamed' if name == old_name else name]
            check(record == now, f'{name}: {record} is now {now}')
    box = next(record for record in second['joints'][edited_name][0] if record['model'] == 'euler_box')
    check(box['x'][0] == -7, f'{box}')
    now = next(other for other in second['chains'] if other['name'] == chain)
    check(now['iterations'] == 33 and now['start'] == first['chains'][0]['start'], f'{now}')


def check_warning(rig, is_given):
    """Imported chains that are enabled act in all actions of an export, which warns of it."""
    from bendy_rig.export_operator import ExportOptions
    from types import SimpleNamespace
    told = []
    operator = SimpleNamespace(export_animations=True, bl_label='Export', report=lambda _level, text: told.append(text))
    added = [bpy.data.actions.new(name) for name in ('one', 'two')]
    ExportOptions.warn_of_enabled_chains(operator, bpy.context)
    check([f'act in all {len(bpy.data.actions)} actions' in text for text in told] == [True] * is_given, f'{rig.name}: {told}')
    for action in added:
        bpy.data.actions.remove(action)


def main():
    bendy, path, folder = arguments()
    rig = only_armature()
    source = {bone.name: limits_of(bone) for bone in rig.pose.bones}, chains_of(rig)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    enable_addon(bendy)
    check(bpy.ops.import_scene.bendy(filepath=path, enable_constraints=True) == {'FINISHED'}, 'not imported')
    rig = only_armature()
    joints, chains = compare(source, ({bone.name: limits_of(bone) for bone in rig.pose.bones}, chains_of(rig)))
    check_muted(rig, False)
    check_warning(rig, True)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.pose.bendy_constraints(enable=False)
    check_muted(rig, True)
    check_warning(rig, False)
    check_changes(bendy, path, rig, folder)
    bpy.ops.pose.bendy_constraints(enable=True)
    if rig.animation_data:
        rig.animation_data.action = None
    off = max(check_reach(rig, name) for name in source[1])
    print(f'Import: {joints} joints and {chains} chains are as in the file that they come from; tips at most {off:.1e} m from their targets')


main()
