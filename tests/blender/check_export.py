"""The extras of an exported rig against the rig as Blender has it.

blender -b FILE.blend --python check_export.py -- OUT.glb

Compares each value with Blender's property, bit for bit; and what has a second source in the file (rest orientations, positions
of targets, the path from a chain's end to its start) with that.
"""
import math
import os
import struct
import sys

import addon_utils
import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from file_nodes import Nodes
from limits import angle_between
from posing import arguments, check, only_armature, read_glb

ROTATION_ERROR, POSITION_ERROR = 1e-6, 1e-6     # of 32-bit floats that went through a few products


def as_float(value):
    return struct.unpack('f', struct.pack('f', value))[0]


def same_numbers(record, wanted, what):
    check(len(record) == len(wanted) and all(as_float(a) == as_float(b) for a, b in zip(record, wanted)), f'{what}: {record}, not {wanted}')


def check_joint(bone, record, nodes):
    limits = [c for c in bone.constraints if c.type == 'LIMIT_ROTATION' and not c.mute]
    check(len(record.get('euler_limits', [])) == len(limits), f'{bone.name}: number of Limit Rotations')
    for limit, constraint in zip(record.get('euler_limits', []), limits):
        check(limit['space'] == 'rest' and limit['order'] == constraint.euler_order, f'{bone.name}: {limit}')
        for axis in 'xyz':
            check((axis in limit) == getattr(constraint, f'use_limit_{axis}'), f'{bone.name}: {axis}')
            if axis in limit:
                same_numbers(limit[axis], [getattr(constraint, f'{end}_{axis}') for end in ('min', 'max')], f'{bone.name}: {axis}')
    swing_twist = record.get('swing_twist', {})
    for axis, key in (('x', 'swing_x'), ('y', 'twist_y'), ('z', 'swing_z')):
        if getattr(bone, f'lock_ik_{axis}'):
            same_numbers(swing_twist[key], [0, 0], f'{bone.name}: {key}')
        elif getattr(bone, f'use_ik_limit_{axis}'):
            same_numbers(swing_twist[key], [getattr(bone, f'ik_min_{axis}'), getattr(bone, f'ik_max_{axis}')], f'{bone.name}: {key}')
        else:
            check(key not in swing_twist, f'{bone.name}: {key} is free')
    same_numbers(record.get('stiffness', [0, 0, 0]), [getattr(bone, f'ik_stiffness_{axis}') for axis in 'xyz'], f'{bone.name}: stiffness')
    check(record.get('locks', {}).get('rotation', [False] * 3) == list(bone.lock_rotation), f'{bone.name}: locks')
    check(as_float(record['length']) == bone.bone.length, f'{bone.name}: length')
    check(angle_between(record['rest_orientation'], nodes.rotation(bone.name)) < ROTATION_ERROR, f'{bone.name}: rest orientation')


def check_chain(rig, constraint, bone, chain, nodes):
    name = chain['joints'][-1]
    check(name == bone.name, f'{chain["name"]}: its last joint')
    for joint in reversed(chain['joints'][:-1]):
        name = nodes.parent[name]
        check(name == joint, f'{chain["name"]}: {joint} is not the parent')
    check(len(chain['joints']) == constraint.chain_count, f'{chain["name"]}: length')
    same_numbers(chain['effector_offset'], [0, bone.bone.length, 0], f'{chain["name"]}: tip')
    for key, value in (('iterations', constraint.iterations), ('position', constraint.use_location), ('rotation', constraint.use_rotation),
                       ('stretch', constraint.use_stretch), ('solver', 'blender_legacy')):
        check(chain[key] == value, f'{chain["name"]}: {key}')
    same_numbers([chain['influence'], chain['weight']], [constraint.influence, constraint.weight], f'{chain["name"]}: weights')
    for key, joint in (('target', constraint.subtarget), ('pole', constraint.pole_subtarget)):
        check((chain[key]['object'], chain[key]['joint']) == (rig.name, joint), f'{chain["name"]}: {key}')
        check(math.dist(chain[key]['position'], nodes.position(joint)) < POSITION_ERROR, f'{chain["name"]}: position of {key}')
    same_numbers([chain['pole']['angle']], [constraint.pole_angle], f'{chain["name"]}: pole angle')


def main():
    out = arguments()[0]
    addon_utils.enable('bendy_rig')
    check(bpy.ops.export_scene.bendy_rig(filepath=out) == {'FINISHED'}, 'not exported')
    rig, document = only_armature(), read_glb(out)
    nodes = Nodes(document)
    records = {name: node['extras']['rig_joint'] for name, node in nodes.by_name.items() if 'rig_joint' in node.get('extras', {})}
    limited = {b.name for b in rig.pose.bones if any(c.type == 'LIMIT_ROTATION' for c in b.constraints)}
    check(set(records) == limited and limited, 'other joints have limits')
    for name, record in records.items():
        check_joint(rig.pose.bones[name], record, nodes)
    chains = nodes.by_name[rig.name]['extras']['rig_ik']['chains']
    wanted = [(c, bone) for bone in rig.pose.bones for c in bone.constraints if c.type == 'IK']
    check([chain['name'] for chain in chains] == [c.name for c, _ in wanted] and chains, 'other chains')
    for chain, (constraint, bone) in zip(chains, wanted):
        check_chain(rig, constraint, bone, chain, nodes)
    print(f'Export: {len(records)} joints and {len(chains)} chains are as Blender has them')


main()
