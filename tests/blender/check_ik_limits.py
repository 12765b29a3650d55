"""What Blender's IK solver keeps to, against the records that the add-on wrote.

blender -b FILE.blend --python check_ik_limits.py -- FILE.glb

50 random targets for each chain. Without a pole every joint of a chain must stay inside its record. With one, Blender turns the
whole chain about the line to the target when it has solved, so the first joint may be outside: that is printed, not judged.
"""
import os
import random
import sys

from mathutils import Matrix, Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from limits import excess, limits_of_extras
from posing import (TOLERANCE, arguments, check, evaluated, joint_records, local_rotation, move_target, mute_all, only_armature,
                    read_glb, stop_animation)

TARGETS = 50


def constraint_of(rig, chain):
    return next(c for bone in rig.pose.bones for c in bone.constraints if c.type == 'IK' and c.name == chain['name'])


def random_target(rig, chain, rng):
    """Around the chain's start, a little further than it reaches."""
    bones = [rig.data.bones[name] for name in chain['joints']]
    direction = Vector([rng.gauss(0, 1) for _ in range(3)]).normalized()
    return bones[0].head_local + direction * sum(bone.length for bone in bones) * rng.uniform(0.2, 1.2)


def shrunken(limit):
    """The same limit with a thousandth less room: what is outside of it is at its limit."""
    return {**limit, **{axis: [0.999 * v for v in limit[axis]] for axis in 'xyz' if axis in limit}}


def mistaken(limit):
    """With swings mirrored: a test that this passes would prove nothing."""
    return {**limit, **{axis: [-limit[axis][1], -limit[axis][0]] for axis in 'yz' if axis in limit}}


def main():
    path = arguments()[0]
    rig = only_armature()
    stop_animation(rig)
    mute_all(rig, but='IK')
    limits = {name: limits_of_extras(record)[1] for name, record in joint_records(path).items()}
    chains = [chain for node in read_glb(path)['nodes'] for chain in node.get('extras', {}).get('rig_ik', {}).get('chains', [])]
    rng = random.Random(11)
    rotations = at_limit = caught = 0
    worst = {'no pole': 0.0, 'pole, first joint': 0.0, 'pole, other joints': 0.0}
    for has_pole in (False, True):
        for chain in chains:
            constraint = constraint_of(rig, chain)
            constraint.influence = 1.0
            if not has_pole:
                constraint.pole_target = None
            elif constraint.pole_target is None:
                constraint.pole_target, constraint.pole_subtarget = rig, chain['pole']['joint']
        for _ in range(TARGETS):
            for chain in chains:
                move_target(rig, chain['target']['joint'], Matrix.Translation(random_target(rig, chain, rng)))
            posed = evaluated(rig)
            for chain in chains:
                for place, name in enumerate(chain['joints']):
                    over = 0.0 if limits[name] is None else excess(limits[name], local_rotation(posed, name))
                    kind = 'no pole' if not has_pole else 'pole, other joints' if place else 'pole, first joint'
                    worst[kind] = max(worst[kind], over)
                    if limits[name] and not has_pole:
                        rotations += 1
                        at_limit += excess(shrunken(limits[name]), local_rotation(posed, name)) > 1e-6
                        caught += excess(mistaken(limits[name]), local_rotation(posed, name)) > TOLERANCE
    print(f'IK limits: {len(chains)} chains, {TARGETS} targets each, {rotations} rotations, {at_limit} at a limit')
    print('  - worst excess, radians: ' + '; '.join(f'{kind} {over:.1e}' for kind, over in worst.items()))
    print(f'  - {caught} rotations are outside of the mirrored limits')
    check(at_limit >= 50, 'the solver hardly met a limit')
    check(worst['no pole'] < TOLERANCE and worst['pole, other joints'] < TOLERANCE, 'outside')
    asymmetric = any(limit and mistaken(limit) != limit for limit in limits.values())
    check(caught > 0 or not asymmetric, 'mirrored limits would have passed')


main()
