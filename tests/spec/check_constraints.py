#!/usr/bin/env python3
"""Holds spec/constraints.md against itself: python3 check_constraints.py [SOURCE_DIR]

Works the page's example again from the bytes of every_chunk.bendy and looks for the numbers on the page. Says once more what
is legal, clamps by slow searches (../blender/limits.py), and tries whether any legal rotation is nearer. Python 3, nothing else.
"""

import math
import pathlib
import random
import struct
import sys

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / 'blender'))
from limits import (NO_ROTATION, about, all_orders, angle_between, both_eulers, clamp_angle, conjugate, ellipse_swing,  # noqa: E402
                    from_euler, nearest_in_ellipse, nearest_in_euler_box, normalized, product, ranges, swing_and_twist)

MODELS = ('free', 'locked', 'hinge', 'swing_twist_ellipse', 'swing_twist_pyramid', 'euler_box', 'largest_angle')
EDGE = 1e-9


# --- what is legal ---------------------------------------------------------------------------------------------------

def in_range(angle, low, high):
    """On the circle."""
    return high - low >= 2 * math.pi or abs(math.remainder(angle - (low + high) / 2, 2 * math.pi)) <= (high - low) / 2 + EDGE


def in_ellipse(s, y, z):
    """s: the swing vector; y, z: its ranges."""
    inside = 0.0
    for value, (low, high) in zip(s, (y, z)):
        limit = high if value > 0 else -low
        if math.isinf(limit):
            continue
        axis = math.sin(min(limit, math.pi) / 2)
        if abs(value) > axis + EDGE:
            return False
        inside += (value / axis) ** 2 if axis > EDGE else 0.0
    return inside <= 1 + EDGE


def in_pyramid(s, y, z):
    w = math.sqrt(max(0.0, 1 - s[0] ** 2 - s[1] ** 2))
    return all(low - EDGE <= 2 * math.atan2(value, w) <= high + EDGE for value, (low, high) in zip(s, (y, z)))


def is_legal(limit, r):
    model, (x, y, z) = limit['model'], ranges(limit)
    if model == 'largest_angle':
        return angle_between(r, NO_ROTATION) <= x[1] + EDGE
    if model == 'euler_box':
        return any(all(in_range(angle, *bounds) for angle, bounds in zip(form, (x, y, z))) for form in both_eulers(r, limit['order']))
    swing, twist = swing_and_twist(r)
    if model in ('locked', 'hinge'):
        return math.hypot(*swing) < EDGE and (model == 'hinge' and in_range(twist, *x) or abs(twist) < EDGE)
    if model == 'free':
        return True
    return in_range(twist, *x) and (in_ellipse if model == 'swing_twist_ellipse' else in_pyramid)(swing, y, z)


# --- the nearest -----------------------------------------------------------------------------------------------------

def pyramid_swing(limit, turn, size):
    """As ellipse_swing. Y and Z by w: the pyramid is a rectangle of tangents of half angles."""
    swing, reach = (math.cos(turn), math.sin(turn)), math.inf
    for value, (low, high) in zip(swing, ranges(limit)[1:]):
        end = high if value > 0 else -low
        if end < math.pi:
            reach = min(reach, max(math.tan(end / 2), 1e-9) / max(abs(value), 1e-15))
    half = size * min(math.atan(reach), math.pi / 2 - 3e-5)
    return (0.0, swing[0] * math.sin(half), swing[1] * math.sin(half), math.cos(half))


def clamp(limit, r):
    if is_legal(limit, r):
        return r
    model, (x, _, _) = limit['model'], ranges(limit)
    if model == 'locked':
        return NO_ROTATION
    if model == 'hinge':
        return about(0, clamp_angle(swing_and_twist(r)[1], *x))
    if model == 'largest_angle':
        scale = math.copysign(math.sin(x[1] / 2) / math.hypot(*r[:3]), r[3])
        return (r[0] * scale, r[1] * scale, r[2] * scale, math.cos(x[1] / 2))
    if model == 'euler_box':
        return nearest_in_euler_box(limit, r)
    return nearest_in_ellipse(limit, r, ellipse_swing if model == 'swing_twist_ellipse' else pyramid_swing)[0]


# --- the page --------------------------------------------------------------------------------------------------------

def payload_of(data, letters):
    """The payload of the first leaf of this id; the sample's ids stand in no text."""
    at = data.index(letters)
    return data[at + 16:at + 16 + (struct.unpack_from('<Q', data, at + 8)[0] & (1 << 48) - 1)]


def top(f, low, high):
    """Where f, with one hill in [low, high], is largest."""
    while high - low > 1e-12:
        a, b = low + (high - low) / 3, high - (high - low) / 3
        low, high = (a, high) if f(a) < f(b) else (low, b)
    return low


def best_twist(swing, r):
    left = product(conjugate(swing), r)
    return math.degrees(2 * math.atan2(left[0], left[3]))


def example_numbers(source, rng):
    """Every number of the example, as the page should have it, worked from the file's bytes."""
    record = payload_of((source / 'spec' / 'examples' / 'every_chunk.bendy').read_bytes(), b'LIMT')
    numbers = struct.unpack_from('<23f', record, 4)
    frame, low, high = numbers[1:5], numbers[5:8], numbers[8:11]
    limit = {'model': MODELS[record[0]], 'x': (low[0], high[0]), 'y': (low[1], high[1]), 'z': (low[2], high[2])}
    r = product((0.0, 0.4, 0.3, math.cos(math.radians(30))), about(0, math.radians(50)))
    s, twist = swing_and_twist(r)
    a, b = math.sin(high[1] / 2), math.sin(high[2] / 2)

    def words(values):
        return '(%s)' % '  '.join('%.5f' % value for value in values)
    yield words(r)
    yield 't = 2 atan2(%.5f, %.5f) = %g°' % (r[0], r[3], round(math.degrees(twist), 5))
    yield 'a = sin 20° = %.5f' % a
    yield '= %.5f, outside' % ((s[0] / a) ** 2 + (s[1] / b) ** 2)

    twists = [best_twist(ellipse_swing(limit, math.pi * turn / 500, size / 4), r) for turn in range(1000) for size in range(5)]
    assert math.degrees(high[0]) < min(twists) and max(twists) < 180
    yield 'from %.2f° to %.2f°' % (min(twists), max(twists))

    v = product(r, conjugate(about(0, high[0])))
    on_edge = lambda turn: (0.0, a * math.cos(turn), b * math.sin(turn),
                            math.sqrt(1 - (a * math.cos(turn)) ** 2 - (b * math.sin(turn)) ** 2))
    p = on_edge(top(lambda turn: sum(m * n for m, n in zip(v[1:], on_edge(turn)[1:])), 0, math.pi / 2))
    slopes = [v[axis] - v[3] / p[3] * p[axis] for axis in (1, 2)]
    mu = slopes[0] * a * a / p[1]
    assert abs(mu - slopes[1] * b * b / p[2]) < 1e-6
    half = math.acos(p[3])
    clamped = product(p, about(0, high[0]))
    yield words(v)
    yield 'v = (w y z) = ' + words((v[3], v[1], v[2]))
    yield 'mu = %.6f: p = %s w = %.5f v.w / w = %.5f' % (mu, words(p[1:3]), p[3], v[3] / p[3])
    yield '%.5f - %.5f p.y = %.5f' % (v[1], v[3] / p[3], slopes[0])
    yield '%.5f - %.5f p.z = %.5f' % (v[2], v[3] / p[3], slopes[1])
    yield '%.3f° about (0 %.5f %.5f)' % (math.degrees(2 * half), p[1] / math.sin(half), p[2] / math.sin(half))
    yield words(clamped)
    yield '%.3f° from R' % math.degrees(angle_between(r, clamped))
    yield words(product(product(frame, clamped), conjugate(frame)))
    assert is_legal(limit, clamped) and angle_between(clamp(limit, r), clamped) < 1e-5
    check_nearest(limit, r, clamped, rng, 20000)

    bend = {'model': 'hinge', 'x': (0.0, math.radians(150))}
    for before, after in ((-20, 0), (170, 150), (-120, 150)):
        assert angle_between(clamp(bend, about(0, math.radians(before))), about(0, math.radians(after))) < 1e-9
    yield '-20° becomes 0°; 170° becomes 150°'


# --- promises --------------------------------------------------------------------------------------------------------

def random_rotation(rng):
    return normalized([rng.gauss(0, 1) for _ in range(4)])


def check_nearest(limit, r, found, rng, tries):
    """Of rotations anywhere and close to what was found, no legal one is nearer to r."""
    nearest = angle_between(r, found)
    for _ in range(tries):
        size = rng.choice((0.003, 0.03, 0.3, 10))
        other = normalized(product(found, (rng.gauss(0, size), rng.gauss(0, size), rng.gauss(0, size), 1.0)))
        if limit['model'] == 'hinge':
            other = normalized((other[0], 0.0, 0.0, other[3]))
        assert not is_legal(limit, other) or angle_between(r, other) >= nearest - 1e-5, (limit, r, found, other)


def check_promises(rng):
    """What clamping gives is legal, stays as it is, and nothing legal is nearer."""
    for model in MODELS:
        for _ in range(40):
            limit = {'model': model, 'order': rng.choice(all_orders())}
            limit.update((axis, (-rng.choice((0.0, 0.3, 1.0, 2.0, 4.0, math.inf)), rng.choice((0.0, 0.3, 1.0, 2.0, 4.0, math.inf))))
                         for axis in 'xyz')
            if model == 'largest_angle':
                limit['x'] = (0.0, rng.choice((0.0, 0.3, 2.0, 4.0)))
            r = random_rotation(rng)
            found = clamp(limit, r)
            again = clamp(limit, found)
            assert angle_between(found, again) < 1e-6, (limit, r)
            assert angle_between(found, clamp(limit, tuple(-number for number in r))) < 1e-5, (limit, r)
            check_nearest(limit, r, found, rng, 400)


def main(arguments):
    source = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent.parent).resolve()
    page = (source / 'spec' / 'constraints.md').read_text(encoding='utf-8')
    text, rng = ' '.join(page.split()), random.Random(7)
    missing = [number for number in example_numbers(source, rng) if ' '.join(number.split()) not in text]
    for number in missing:
        print('spec/constraints.md: the example lacks: ' + number)
    check_promises(rng)
    return 1 if missing else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
