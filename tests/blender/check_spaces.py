"""Limits in Blender's other spaces: what the records mean, said in the file's axes, against what Blender does.

blender -b --factory-startup --python check_spaces.py

Of a joint in the file, G is its orientation (in armature: in the space of the armature's node; in world: in the file's space). What
is limited is G * conj(zero); with the parent's motion in rest_with_parent, it is relative to the rest orientation.
"""
import math
import os
import random
import sys

from mathutils import Euler

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from limits import angle_between, conjugate, each_clamped, product
from posing import TOLERANCE, check, evaluated, one_bone_rig, random_rotation, set_rotation, xyzw
from bendy_rig.axes import FileAxes
from bendy_rig.joint_limits import joint_record

POSES = 50
AXES = FileAxes(True)


def orientation(rig, space):
    """G of the bone b in the file, x y z w."""
    matrix = rig.pose.bones['b'].matrix
    if space == 'rest_with_parent':
        return xyzw((rig.pose.bones['b'].bone.matrix_local.inverted() @ matrix).to_quaternion())
    if space == 'world':
        matrix = rig.matrix_world @ matrix
    return xyzw((AXES.matrix @ matrix).to_quaternion())


def limited_bone(owner_space, order):
    rig, bone = one_bone_rig()
    rig.rotation_euler = (0.4, -0.3, 1.2)
    constraint = bone.constraints.new('LIMIT_ROTATION')
    constraint.owner_space, constraint.euler_order = owner_space, order
    for axis, low, high in (('x', -0.3, 0.9), ('y', -0.5, 0.2), ('z', -1.0, 0.7)):
        setattr(constraint, f'use_limit_{axis}', True)
        setattr(constraint, f'min_{axis}', low)
        setattr(constraint, f'max_{axis}', high)
    return rig, bone, constraint


def check_rotation(owner_space, space, order):
    rig, bone, constraint = limited_bone(owner_space, order)
    rng, worst, moved = random.Random(2), 0.0, 0
    for _ in range(POSES):
        set_rotation(rig.pose.bones['base'], random_rotation(rng, 1.0))
        set_rotation(bone, random_rotation(rng))
        constraint.mute = True
        asked = orientation(evaluated(rig), space)
        constraint.mute = False
        got = orientation(evaluated(rig), space)
        limit = joint_record(bone, AXES)['euler_limits'][0]
        check(limit['space'] == space, f'{limit}')
        zero = tuple(limit.get('zero', (0, 0, 0, 1)))
        expected = product(each_clamped(limit, product(asked, conjugate(zero)))[0], zero)
        worst = max(worst, angle_between(expected, got))
        moved += angle_between(asked, got) > 0.1
    check(worst < TOLERANCE and moved > POSES / 2, f'{owner_space} {order}: {worst}, {moved} moved')
    return worst


def check_location(owner_space, space):
    rig, bone = one_bone_rig()
    bone.bone.use_inherit_rotation = True
    rig.location, rig.rotation_euler = (0.1, 0.2, 0.3), Euler((0.4, -0.3, 1.2))
    child = rig.pose.bones['t']
    constraint = child.constraints.new('LIMIT_LOCATION')
    constraint.owner_space = owner_space
    for key, value in (('min_x', -0.1), ('max_x', 0.2), ('min_y', -0.3), ('max_z', 0.15)):
        setattr(constraint, key, value)
        setattr(constraint, f'use_{key}', True)
    limit = joint_record(child, AXES)['location_limits'][0]
    check(limit['space'] == space, f'{limit}')
    rng, worst = random.Random(4), 0.0
    for _ in range(POSES):
        child.location = [rng.uniform(-1, 1) for _ in range(3)]
        constraint.mute = True
        asked = place(evaluated(rig), space)
        constraint.mute = False
        got = place(evaluated(rig), space)
        for axis, name in enumerate('xyz'):
            low, high = limit.get(name, [None, None])
            expected = max(asked[axis], -math.inf if low is None else low)
            expected = min(expected, math.inf if high is None else high)
            worst = max(worst, abs(expected - got[axis]))
    check(worst < 1e-5, f'{owner_space}: {worst}')
    return worst


def place(rig, space):
    """Of the bone t in the file: from its rest position along its own axes, or in the node's or the file's space."""
    bone = rig.pose.bones['t']
    if space == 'rest':
        return (bone.bone.matrix_local.inverted() @ bone.matrix).translation
    matrix = bone.matrix if space == 'armature' else rig.matrix_world @ bone.matrix
    return (AXES.matrix @ matrix).translation


def main():
    worst = max(check_rotation(owner, space, order) for order in ('XYZ', 'YXZ', 'ZXY', 'ZYX')
                for owner, space in (('POSE', 'armature'), ('WORLD', 'world'), ('LOCAL_WITH_PARENT', 'rest_with_parent')))
    print(f'Spaces: Limit Rotation, worst {worst:.1e} radians')
    worst = max(check_location(owner, space) for owner, space in (('LOCAL', 'rest'), ('POSE', 'armature'), ('WORLD', 'world')))
    print(f'Spaces: Limit Location, worst {worst:.1e} metres')


main()
