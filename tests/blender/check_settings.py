"""Limits that an import makes of records with frames of all kinds: Blender keeps to them as the record says.

blender -b --factory-startup --python check_settings.py

A frame may be each of the 24 turns that put its axes on the bone's. Rotations inside a record must stay; others must end up inside
it. Records are judged by limits.py, which knows nothing of Blender.
"""
import itertools
import math
import os
import random
import sys

from mathutils import Matrix, Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from limits import angle_between, conjugate, excess, from_euler, normalized, product
from posing import TOLERANCE, check, evaluated, local_rotation, move_target, one_bone_rig, random_rotation, set_rotation
from bendy_rig.joint_settings import apply_settings, bone_settings, read_settings
from bendy_rig.kept_records import CONSTRAINTS, keep
from bendy_rig.limits_panel import lines_of

POSES = 12
LETTERS = 'xyz'


def frames():
    """x y z w of the turns that put axes on axes."""
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            matrix = Matrix([[signs[column] if order[column] == row else 0 for column in range(3)] for row in range(3)])
            if matrix.determinant() > 0:
                q = matrix.to_quaternion()
                yield (q.x, q.y, q.z, q.w)


def in_radians(record):
    """As limits.py has it: a hinge is a box without room about two axes."""
    limit = {'model': 'euler_box', 'order': record.get('order', 'XYZ'), 'frame': record['frame']}
    for axis in LETTERS:
        limit[axis] = [math.radians(v) for v in record.get(axis, (0, 0))]
    return {**limit, 'model': record['model']} if record['model'].startswith('swing') else limit


def random_record(rng, model, frame):
    record = {'model': model, 'frame': list(frame)}
    if model == 'euler_box':
        record['order'] = rng.choice(['XYZ', 'XZY', 'YXZ', 'YZX', 'ZXY', 'ZYX'])
    for axis in {'hinge': 'x', 'locked': ''}.get(model, LETTERS):
        record[axis] = [-rng.randint(5, 50), rng.randint(5, 50)]
    return record


def limited_bone(record):
    rig, bone = one_bone_rig()
    settings, notes = bone_settings([record])
    apply_settings(bone, settings, is_muted=False)
    check(read_settings(bone) == settings, f'{record}: {settings} is read as {read_settings(bone)}')
    return rig, bone, notes


def check_limit_rotation(rng, model, frame):
    record = random_record(rng, model, frame)
    rig, bone, notes = limited_bone(record)
    check(not any('Limit Rotation' in note for note in notes), f'{record}: {notes}')
    limit, worst = in_radians(record), 0.0
    for number in range(POSES):
        is_inside = number % 2 == 0
        asked = inside(rng, limit) if is_inside else random_rotation(rng)
        asked = set_rotation(bone, asked)
        got = local_rotation(evaluated(rig), 'b')
        worst = max(worst, excess(limit, got), angle_between(asked, got) if is_inside else 0.0)
    check(worst < TOLERANCE, f'{record}: {worst}')
    return worst


def inside(rng, limit):
    """A rotation relative to rest, C R conj(C)."""
    rotation = from_euler([rng.uniform(*limit[axis]) for axis in LETTERS], limit['order'])
    return normalized(product(product(limit['frame'], rotation), conjugate(limit['frame'])))


def check_ik(rng, frame):
    """A chain of one bone whose target is out of its reach."""
    record = random_record(rng, 'swing_twist_ellipse', frame)
    rig, bone, notes = limited_bone(record)
    check(not any('IK' in note for note in notes), f'{record}: {notes}')
    constraint = bone.constraints.new('IK')
    constraint.target, constraint.subtarget, constraint.chain_count, constraint.iterations = rig, 't', 1, 500
    limit, worst, moved = in_radians(record), 0.0, 0
    for _ in range(POSES):
        direction = Vector([rng.gauss(0, 1) for _ in range(3)]).normalized() * 2.0
        move_target(rig, 't', Matrix.Translation(bone.bone.head_local + direction))
        got = local_rotation(evaluated(rig), 'b')
        worst, moved = max(worst, excess(limit, got)), moved + (angle_between((0, 0, 0, 1), got) > 0.01)
    check(worst < TOLERANCE and moved > POSES / 2, f'{record}: {worst}, {moved} moved')
    return worst


def twists_about_y(frame):
    """Blender's IK limits twist about the bone's Y."""
    x, y, z, w = frame
    return abs(abs(2 * (x * y + z * w)) - 1) < 1e-6


def check_other_axes(rng):
    """Axes near the bone's get IK limits about those, others the largest angle; the panel shows the record in words."""
    rig, bone = one_bone_rig()
    near = {'model': 'swing_twist_pyramid', 'frame': [0.1, 0, 0, 0.99498744], 'x': [-10, 20], 'y': [-30, 40], 'z': [-50, 60]}
    settings, notes = bone_settings([near])
    check({axis: tuple(round(math.degrees(v)) for v in ends) for axis, ends in settings['ik'].items()} ==
          {'x': (-10, 20), 'y': (-30, 40), 'z': (-50, 60)}, f'{settings}')
    check(settings['limit_rotation'] is None and len(notes) == 2, f'{settings}, {notes}')
    far = random_record(rng, 'euler_box', (0.1, 0.4, 0.3, 0.8602325))
    largest = max(abs(end) for axis in LETTERS for end in far[axis])
    settings, notes = bone_settings([far])
    check(all(abs(math.degrees(high) - largest) < 1e-3 and low == -high for low, high in settings['ik'].values()) and
          len(settings['ik']) == 3, f'{settings}')
    check(len(notes) == 2 and all('axes' in note for note in notes), f'{notes}')
    keep(bone, CONSTRAINTS, [far])
    apply_settings(bone, settings, is_muted=True)
    lines = [text for _, text in lines_of(bone)]
    check(lines[0].startswith('Euler box: x ') and sum(' of the bone' in line for line in lines) == 3, f'{lines}')
    check(all(any(note in line for line in lines) for note in notes), f'{lines}')


def main():
    rng, all_frames = random.Random(8), list(frames())
    check(len(all_frames) == 24, f'{len(all_frames)} frames')
    worst = max(check_limit_rotation(rng, model, frame) for model in ('euler_box', 'hinge', 'locked') for frame in all_frames)
    print(f'Settings: Limit Rotation in {len(all_frames)} frames, worst {worst:.1e} radians')
    twisting = [frame for frame in all_frames if twists_about_y(frame)]
    check(len(twisting) == 8, f'{len(twisting)} frames twist about Y')
    worst = max(check_ik(rng, frame) for frame in twisting)
    print(f'Settings: IK limits in {len(twisting)} frames, worst {worst:.1e} radians')
    check_other_axes(rng)


main()
