#!/usr/bin/env python3
"""Holds spec/constraints.md against itself: python3 check_constraints.py [SOURCE_DIR]

Clamps rotations as the page has it, works its example again from the bytes of every_chunk.bendy, looks for the numbers on
the page, and tries the page's promises on many rotations. Python 3, nothing else.
"""

import math
import pathlib
import random
import struct
import sys

FREE, LOCKED, HINGE, ELLIPSE, PYRAMID, BOX, LARGEST = range(7)
ORDERS = ('xyz', 'xzy', 'yxz', 'yzx', 'zxy', 'zyx')


# --- rotations: (x, y, z, w) -----------------------------------------------------------------------------------------

def multiply(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def conj(q):
    return (-q[0], -q[1], -q[2], q[3])


def normalised(q):
    length = math.sqrt(sum(number * number for number in q))
    return tuple(number / length for number in q)


def about(axis, angle):
    q = [0.0, 0.0, 0.0, math.cos(angle / 2)]
    q[axis] = math.sin(angle / 2)
    return tuple(q)


def angle_between(a, b):
    d = multiply(conj(a), b)
    return 2 * math.atan2(math.hypot(*d[:3]), abs(d[3]))


def split(r):
    """Twist angle in (-pi, pi] and swing with w >= 0."""
    x, _, _, w = r
    angle = math.remainder(2 * math.atan2(x, w), 2 * math.pi) if math.hypot(x, w) > 1e-12 else 0.0
    swing = multiply(r, conj(about(0, angle)))
    return angle, swing if swing[3] >= 0 else tuple(-number for number in swing)


# --- clamping --------------------------------------------------------------------------------------------------------

def holds(low, angle, high):
    """On the circle."""
    if low == -math.inf or high == math.inf or high - low >= 2 * math.pi:
        return True
    return math.ceil((low - angle) / (2 * math.pi)) * 2 * math.pi + angle <= high


def clamp_angle(low, angle, high):
    if holds(low, angle, high):
        return angle
    return min((low, high), key=lambda end: abs(math.remainder(angle - end, 2 * math.pi)))


def half_axis(limit):
    return math.sin(min(abs(limit), math.pi) / 2)


def nearest_on_ellipse(a, b, y, z):
    """Of the quarter with half axes a, b, for a point outside it with y, z >= 0; by bisection."""
    if a == 0 or b == 0:
        return (0.0 if a == 0 else min(y, a)), (0.0 if b == 0 else min(z, b))
    low, high = 0.0, math.hypot(a * y, b * z)
    for _ in range(200):
        middle = (low + high) / 2
        outside = (a * y / (a * a + middle)) ** 2 + (b * z / (b * b + middle)) ** 2 > 1
        low, high = (middle, high) if outside else (low, middle)
    return a * a * y / (a * a + high), b * b * z / (b * b + high)


def clamp_ellipse(low, high, swing):
    _, y, z, _ = swing
    a = half_axis(high[1] if y >= 0 else low[1])
    b = half_axis(high[2] if z >= 0 else low[2])
    inside = (y == 0 if a == 0 else abs(y) <= a) and (z == 0 if b == 0 else abs(z) <= b)
    if inside and (a == 0 or b == 0 or (y / a) ** 2 + (z / b) ** 2 <= 1 + 1e-12):
        return swing
    py, pz = nearest_on_ellipse(a, b, abs(y), abs(z))
    py, pz = math.copysign(py, y), math.copysign(pz, z)
    return (0.0, py, pz, math.sqrt(max(0.0, 1 - py * py - pz * pz)))


def clamp_pyramid(low, high, swing):
    _, y, z, w = swing
    u = min(max(2 * math.atan2(y, w), low[1]), high[1])
    v = min(max(2 * math.atan2(z, w), low[2]), high[2])
    if u == 2 * math.atan2(y, w) and v == 2 * math.atan2(z, w):
        return swing
    return normalised((0.0, math.tan(u / 2), math.tan(v / 2), 1.0))


def euler_forms(order, r):
    """Both forms of the rotation: angles about the axes in the order in which they turn."""
    i, j, k = ('xyz'.index(letter) for letter in ORDERS[order])
    sign = 1 if (j - i) % 3 == 1 else -1
    x, y, z, w = r
    matrix = ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
              (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
              (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
    middle = math.asin(max(-1.0, min(1.0, -sign * matrix[k][i])))
    first = math.atan2(sign * matrix[k][j], matrix[k][k])
    last = math.atan2(sign * matrix[j][i], matrix[i][i])
    return (first, middle, last), (first + math.pi, math.pi - middle, last + math.pi)


def from_euler(order, angles):
    i, j, k = ('xyz'.index(letter) for letter in ORDERS[order])
    return multiply(about(k, angles[2]), multiply(about(j, angles[1]), about(i, angles[0])))


def clamp_box(order, low, high, r):
    axes = ['xyz'.index(letter) for letter in ORDERS[order]]
    best = []
    for form in euler_forms(order, r):
        best.append(from_euler(order, [clamp_angle(low[axis], angle, high[axis]) for axis, angle in zip(axes, form)]))
    return min(best, key=lambda q: angle_between(q, r))


def clamp(model, low, high, r, order=0):
    """The rotation R, brought inside limits in radians."""
    angle, swing = split(r)
    if model == LOCKED:
        return (0.0, 0.0, 0.0, 1.0)
    if model == HINGE:
        return about(0, clamp_angle(low[0], angle, high[0]))
    if model in (ELLIPSE, PYRAMID):
        swing = (clamp_ellipse if model == ELLIPSE else clamp_pyramid)(low, high, swing)
        return multiply(swing, about(0, clamp_angle(low[0], angle, high[0])))
    if model == BOX:
        return clamp_box(order, low, high, r)
    if model == LARGEST:
        size = 2 * math.atan2(math.hypot(*r[:3]), abs(r[3]))
        if size <= high[0]:
            return r
        scale = math.sin(high[0] / 2) / math.hypot(*r[:3]) * math.copysign(1, r[3])
        return (r[0] * scale, r[1] * scale, r[2] * scale, math.cos(high[0] / 2))
    return r


# --- the page --------------------------------------------------------------------------------------------------------

def payload_of(data, letters):
    """The payload of the first leaf of this id; the sample's ids stand in no text."""
    at = data.index(letters)
    return data[at + 16:at + 16 + (struct.unpack_from('<Q', data, at + 8)[0] & (1 << 48) - 1)]


def example_numbers(source):
    """Every number of the example, as the page should have it, worked from the file's bytes."""
    record = payload_of((source / 'spec' / 'examples' / 'every_chunk.bendy').read_bytes(), b'LIMT')
    model = record[0]
    numbers = struct.unpack_from('<23f', record, 4)
    frame, low, high = numbers[1:5], numbers[5:8], numbers[8:11]
    swing_angle = math.radians(60)
    swing = (0.0, 0.8 * math.sin(swing_angle / 2), 0.6 * math.sin(swing_angle / 2), math.cos(swing_angle / 2))
    r = multiply(swing, about(0, math.radians(50)))
    angle, again = split(r)
    a, b = half_axis(high[1]), half_axis(high[2])
    clamped = clamp(model, low, high, r)
    clamped_angle, p = split(clamped)
    size = 2 * math.acos(p[3])
    q = multiply(multiply(frame, clamped), conj(frame))

    def words(values):
        return '(%s)' % '  '.join('%.5f' % value for value in values)
    yield words(r)
    yield words(clamped)
    yield words(q)
    yield words(p[1:3])
    yield 't = 2 atan2(%.5f, %.5f) = %g°' % (r[0], r[3], round(math.degrees(angle), 5))
    yield 't becomes **%g°**' % round(math.degrees(clamped_angle), 4)
    yield '= %.5f, outside' % ((again[1] / a) ** 2 + (again[2] / b) ** 2)
    yield 'a = sin 20° = %.5f' % a
    yield 'l = %.6f' % (a * a * (again[1] / p[1] - 1))
    yield 'w = sqrt(1 - p.y² - p.z²) = %.5f' % p[3]
    yield '%.3f° about (0 %.5f %.5f)' % (math.degrees(size), p[1] / math.sin(size / 2), p[2] / math.sin(size / 2))
    yield '%.3f° from R' % math.degrees(angle_between(r, clamped))
    for before, after in ((-20, 0), (170, 150)):
        assert round(math.degrees(clamp_angle(0, math.radians(before), math.radians(150)))) == after
        yield '%d° becomes %d°' % (before, after)
    assert round(math.degrees(clamp_angle(0, math.radians(-120), math.radians(150)))) == 150


def check_promises():
    """To clamp twice is to clamp once; what is legal stays; hinge and largest angle are the nearest."""
    source = random.Random(7)

    def rotation():
        return normalised([source.gauss(0, 1) for _ in range(4)])

    for _ in range(3000):
        low = [-source.choice((0, 0.3, 1, 2, 4, math.inf)) for _ in range(3)]
        high = [source.choice((0, 0.3, 1, 2, 4, math.inf)) for _ in range(3)]
        order = source.randrange(6)
        r = rotation()
        for form in euler_forms(order, r):
            assert angle_between(from_euler(order, form), r) < 1e-6, (order, r)
        for model in range(7):
            once = clamp(model, low, high, r, order)
            assert abs(math.hypot(*once) - 1) < 1e-6
            twice = clamp(model, low, high, once, order)
            assert angle_between(once, twice) < 1e-5, (model, low, high, r)
            assert angle_between((0, 0, 0, 1), clamp(model, low, high, (0, 0, 0, 1), order)) < 1e-9
            flipped = clamp(model, low, high, tuple(-number for number in r), order)
            assert angle_between(once, flipped) < 1e-6, (model, low, high, r)
        hinge = angle_between(clamp(HINGE, low, high, r), r)
        largest = angle_between(clamp(LARGEST, low, high, r), r)
        for _ in range(20):
            other = about(0, source.uniform(max(low[0], -math.pi), min(high[0], math.pi)))
            assert hinge <= angle_between(other, r) + 1e-6
            other = clamp(LARGEST, low, high, rotation())
            assert largest <= angle_between(other, r) + 1e-6


def main(arguments):
    source = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent.parent).resolve()
    page = (source / 'spec' / 'constraints.md').read_text(encoding='utf-8')
    words = ' '.join(page.split())
    missing = 0
    for number in example_numbers(source):
        if ' '.join(number.split()) not in words:
            print('spec/constraints.md: the example lacks: ' + number)
            missing += 1
    check_promises()
    return 1 if missing else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
