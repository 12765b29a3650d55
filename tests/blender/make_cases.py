"""Makes cases.json, or compares it with what this Blender says.

blender -b -t 1 --factory-startup --python make_cases.py -- cases.json [check]
"""
import itertools
import json
import math
import os
import random
import sys

import bpy
from mathutils import Matrix, Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from limits import (about, all_orders, angle_between, each_clamped, excess, from_euler, limited_part, limits_of_extras, must_agree,
                    nearest_in_ellipse, nearest_in_euler_box, outside_axes)
from posing import (TOLERANCE, arguments, blender_quaternion, check, evaluated, local_rotation, move_target, one_bone_rig,
                    random_rotation, set_rotation)
from bendy_rig.axes import FileAxes
from bendy_rig.joint_limits import joint_record

WHAT = [
    'Rotations that Blender limited. One case a line. Quaternions are x y z w, relative to the rest pose; angles are radians.',
    'from: limit_rotation, the constraint of that name; or ik_limits, the IK limits of a bone, in the IK solver.',
    'limit: the constraint as the Blender add-on writes it and spec/rig.md reads it; an axis that is not there is free.',
    'in: what was asked for. out: what Blender made of it. out is legal: clamping it moves it by no more than tolerance.',
    'same: clamping in to the nearest legal rotation gives out, within tolerance. Where it is false, Blender gives another '
    'legal rotation, and the nearest is no further from in than out is.',
]


def number(value):
    return round(value, 9) + 0.0


def case(source, limit, asked, got, same):
    check(excess(limit, got) < TOLERANCE, f'{source}: {limit} {asked} -> {got} is not legal')
    return {'from': source, 'limit': limit, 'in': [number(v) for v in asked], 'out': [number(v) for v in got], 'same': same}


# ------------------------------------------------------------------------------------------------- Limit Rotation

def limit_kinds(rng):
    """Ranges by axis, in degrees: three axes, two, one, a hinge, without rest, wide."""
    span = lambda: (-rng.randint(5, 80), rng.randint(5, 80))
    axis = rng.choice('xyz')
    others = [a for a in 'xyz' if a != axis]
    yield {a: span() for a in 'xyz'}
    yield {a: span() for a in others}
    yield {axis: span()}
    yield {axis: (-rng.randint(0, 20), rng.randint(60, 150)), others[0]: (0, 0), others[1]: (0, 0)}
    yield {axis: (10, rng.randint(30, 70)), others[0]: span(), others[1]: span()}
    yield {a: (-rng.randint(90, 170), rng.randint(90, 170)) for a in 'xyz'}


def asked_rotations(limit, rng):
    """One inside, one a little outside, one about a single axis, one anywhere."""
    pairs = [limit.get(axis, [-1.5, 1.5]) for axis in 'xyz']
    yield from_euler([rng.uniform(low, high) for low, high in pairs], limit['order'])
    yield from_euler([rng.uniform(low - 0.4, high + 0.4) for low, high in pairs], limit['order'])
    axis = rng.randrange(3)
    yield about(axis, rng.choice([pairs[axis][0] - 0.3, pairs[axis][1] + 0.3]))
    middle = 'XYZ'.index(limit['order'][1])
    angles = [rng.uniform(low, high) for low, high in pairs]
    angles[middle] = pairs[middle][1] + 0.2
    yield from_euler(angles, limit['order'])
    yield random_rotation(rng)


def limit_rotation_cases():
    from rigkit import limit_rotation
    rng = random.Random(3)
    for order in all_orders():
        for kind in limit_kinds(rng):
            rig, bone = one_bone_rig()
            limit_rotation(bone, kind, order)
            limit = limits_of_extras(joint_record(bone, FileAxes(True)))[0]
            for wanted in asked_rotations(limit, rng):
                asked = set_rotation(bone, wanted)
                got = local_rotation(evaluated(rig), 'b')
                _, angles = each_clamped(limit, asked)
                same = not outside_axes(limit, angles) or must_agree(limit, angles, angle_between(asked, got))
                check(not same or angle_between(nearest_in_euler_box(limit, asked), got) < TOLERANCE, f'{limit} {asked} -> {got}')
                yield case('limit_rotation', limit, asked, got, same)


# ------------------------------------------------------------------------------------------------- IK limits

def ik_cases():
    """A single bone aims at a target beyond its reach, about one of its axes or about any; or is asked to twist."""
    rng = random.Random(5)
    for free, locked in 2 * list(itertools.product(['', 'x', 'y', 'z'], repeat=2)):
        if locked == 'y' and free in ('x', 'z'):
            continue                # Blender forgets the other swing limit then; the add-on says so
        rig, bone = limited_ik_bone(rng, free, locked)
        limit = limits_of_extras(joint_record(bone, FileAxes(True)))[1]
        constraint = bone.constraints.new('IK')
        constraint.target, constraint.subtarget, constraint.chain_count, constraint.iterations = rig, 't', 1, 500
        for axis in (0, 2, None):
            turn = rng.uniform(1.4, 2.2) * rng.choice((-1, 1))
            direction = rng.uniform(0, 2 * math.pi)
            asked = about(axis, turn) if axis is not None else (
                math.cos(direction) * math.sin(turn / 2), 0.0, math.sin(direction) * math.sin(turn / 2), math.cos(turn / 2))
            yield ik_case(rig, bone, limit, asked)
        constraint.use_rotation = True
        yield ik_case(rig, bone, limit, about(1, rng.uniform(-2.5, 2.5)))


def limited_ik_bone(rng, free, locked):
    """With a random range about each axis, different on both sides; free and locked: the letter of an axis or none."""
    rig, bone = one_bone_rig()
    for axis in 'xyz':
        setattr(bone, f'use_ik_limit_{axis}', axis != free)
        setattr(bone, f'ik_min_{axis}', -math.radians(rng.randint(5, 75)))
        setattr(bone, f'ik_max_{axis}', math.radians(rng.randint(5, 75)))
        setattr(bone, f'lock_ik_{axis}', axis == locked)
    return rig, bone


def ik_case(rig, bone, limit, asked):
    """asked: where the bone would be if it were free."""
    rest = bone.bone.matrix_local
    move_target(rig, 't', rest @ blender_quaternion(asked).to_matrix().to_4x4() @ Matrix.Translation(Vector((0, bone.bone.length, 0))))
    got = local_rotation(evaluated(rig), 'b')
    nearest, margin = nearest_in_ellipse(limit, limited_part(limit, asked))
    off = angle_between(nearest, limited_part(limit, got))
    check(angle_between(nearest, limited_part(limit, asked)) < angle_between(asked, got) + TOLERANCE, f'{limit} {asked}: not the nearest')
    same = off < TOLERANCE / 5 and margin > 0.05        # of two that are as near, the program may choose the other one
    return case('ik_limits', limit, asked, got, same)


# ------------------------------------------------------------------------------------------------- the file

def as_text(document):
    head = json.dumps({key: value for key, value in document.items() if key != 'cases'}, indent=1)
    lines = ',\n'.join(json.dumps(c, separators=(',', ':')) for c in document['cases'])
    return head[:-2] + ',\n "cases": [\n' + lines + '\n]}\n'


def compare(committed, made):
    check(len(committed['cases']) == len(made['cases']), 'another number of cases: make cases.json again')
    worst = 0.0
    for old, new in zip(committed['cases'], made['cases']):
        check((old['from'], old['limit']) == (new['from'], new['limit']), f'{old} is now {new}: make cases.json again')
        check(angle_between(old['in'], new['in']) < 1e-6, f'{old} is now {new}: make cases.json again')
        worst = max(worst, angle_between(old['out'], new['out']))
    print(f'  - cases.json: this Blender differs by {worst:.1e} radians at most')
    check(worst < TOLERANCE, 'Blender does otherwise than cases.json says')


def main():
    path, *mode = arguments()
    cases = [*limit_rotation_cases(), *ik_cases()]
    made = {'what': WHAT, 'blender': '.'.join(map(str, bpy.app.version[:2])), 'tolerance': TOLERANCE, 'cases': cases}
    for source in ('limit_rotation', 'ik_limits'):
        own = [c for c in cases if c['from'] == source]
        print(f'Cases of {source}: {len(own)}, {sum(c["same"] for c in own)} where the nearest legal rotation is what Blender gives')
    if not mode:
        with open(path, 'w', encoding='utf-8', newline='\n') as file:
            file.write(as_text(made))
        return
    with open(path, encoding='utf-8') as file:
        committed = json.load(file)
    if committed['blender'] == made['blender']:
        compare(committed, made)
    else:
        print(f'  - cases.json is of Blender {committed["blender"]}: not compared')


main()
