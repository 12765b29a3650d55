"""Blender's own evaluation of Limit Rotation against the records that the add-on wrote.

blender -b FILE.blend --python check_limit_rotation.py -- FILE.glb

For 50 random poses, inside and outside of the limits, and each bone that has the constraint:
- clamping each Euler angle of the record for itself gives what Blender gives: order, signs, rest and ranges are Blender's;
- what Blender gives is legal by the record;
- a rotation that Blender leaves alone is its own nearest legal rotation;
- the nearest legal rotation is never further away than Blender's; and it is Blender's where the theory says so (must_agree).
Where Blender's is another one it is counted, no more: the format asks for the nearest, and Blender does not look for it.
"""
import math
import os
import random
import sys

import mathutils

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from limits import (about, all_orders, angle_between, each_clamped, excess, from_euler, limits_of_extras, must_agree,
                    nearest_in_euler_box, outside_axes, ranges)
from posing import (TOLERANCE, arguments, check, evaluated, joint_records, local_rotation, mute_all, only_armature, random_rotation,
                    set_rotation, stop_animation)

POSES = 50


def check_orders():
    """Blender's Euler orders are ours."""
    for order in all_orders():
        q = mathutils.Euler((0.3, -0.7, 1.1), order).to_quaternion()
        check(angle_between((q.x, q.y, q.z, q.w), from_euler((0.3, -0.7, 1.1), order)) < 1e-6, order)


def pose_for(limit, rng, number):
    """Inside, a little outside, about one axis only, anywhere."""
    low_high = [(-math.pi if math.isinf(low) else low, math.pi if math.isinf(high) else high) for low, high in ranges(limit)]
    if number % 4 == 0:
        return from_euler([rng.uniform(low, high) for low, high in low_high], limit['order'])
    if number % 4 == 1:
        return from_euler([rng.uniform(low - 0.5, high + 0.5) for low, high in low_high], limit['order'])
    if number % 4 == 2:
        return about(rng.randrange(3), rng.uniform(-2, 2))
    return random_rotation(rng)


class Tally:
    def __init__(self):
        self.inside = self.outside = self.must_agree = self.same = self.turned_over = 0
        self.worst_replay = self.worst_excess = self.worst_inside = self.worst_agreed = self.largest_difference = 0.0

    def add(self, limit, asked, got):
        replayed, angles = each_clamped(limit, asked)
        nearest = nearest_in_euler_box(limit, asked)
        check(angle_between(asked, nearest) <= angle_between(asked, got) + TOLERANCE, f'{limit} {asked}: Blender is nearer')
        self.worst_replay = max(self.worst_replay, angle_between(replayed, got))
        self.worst_excess = max(self.worst_excess, excess(limit, got))
        outside, difference = outside_axes(limit, angles), angle_between(nearest, got)
        if not outside:
            self.inside += 1
            self.worst_inside = max(self.worst_inside, difference)
        elif angle_between(asked, nearest) < 1e-9:
            self.turned_over += 1       # the other triple of angles is legal, and Blender does not look at it
        else:
            self.outside += 1
            self.same += difference < TOLERANCE
            self.largest_difference = max(self.largest_difference, difference)
            if must_agree(limit, angles, angle_between(asked, got)):
                self.must_agree += 1
                self.worst_agreed = max(self.worst_agreed, difference)

    def print(self):
        print(f'  - {self.inside} inside, {self.outside} outside, {self.turned_over} legal by their other angles')
        print(f'  - worst, radians: each angle clamped is not what Blender does {self.worst_replay:.1e}; what Blender gives is not legal '
              f'{self.worst_excess:.1e}; inside, moved {self.worst_inside:.1e}')
        print(f'  - outside, nearest is what Blender gives: {self.same}; {self.must_agree} of them must be, worst {self.worst_agreed:.1e}; '
              f'largest difference of the others {self.largest_difference:.2g}')

    def judge(self):
        check(min(self.inside, self.outside, self.must_agree) >= 20, 'too few cases')
        for worst in (self.worst_replay, self.worst_excess, self.worst_inside, self.worst_agreed):
            check(worst < TOLERANCE, f'{worst} is more than {TOLERANCE}')


def main():
    check_orders()
    rig = only_armature()
    stop_animation(rig)
    mute_all(rig, but='LIMIT_ROTATION')
    limits = {name: limits_of_extras(record)[0] for name, record in joint_records(arguments()[0]).items()}
    limits = {name: limit for name, limit in limits.items() if limit}
    check(set(limits) == {b.name for b in rig.pose.bones if any(c.type == 'LIMIT_ROTATION' for c in b.constraints)}, 'other joints')
    rng, tally = random.Random(7), Tally()
    for number in range(POSES):
        asked = {name: set_rotation(rig.pose.bones[name], pose_for(limit, rng, number)) for name, limit in limits.items()}
        posed = evaluated(rig)
        for name, limit in limits.items():
            tally.add(limit, asked[name], local_rotation(posed, name))
    print(f'Limit Rotation: {len(limits)} joints, {POSES} poses')
    tally.print()
    tally.judge()


main()
