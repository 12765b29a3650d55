"""The meaning of a joint constraint, written a second time and in another way than the program's, to hold Blender against.

Quaternions are tuples (x, y, z, w), angles radians. A limit is a dict as in a rig file, but with radians: model, order, frame,
x, y, z -> [low, high]; None in place of a number, or of the pair, is free. A joint's rotation relative to its rest pose is
C * R * conj(C), C the frame; R is what is limited. Python 3, nothing else.
"""
import itertools
import math

NO_ROTATION = (0.0, 0.0, 0.0, 1.0)
BONE_FRAME = (0.5, 0.5, 0.5, 0.5)       # of Blender's IK limits: X -> bone Y (twist), Y -> bone Z, Z -> bone X
FREE = [None, None]


def product(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def conjugate(q):
    return (-q[0], -q[1], -q[2], q[3])


def normalized(q):
    length = math.sqrt(sum(v * v for v in q))
    return tuple(v / length for v in q)


def about(axis, angle):
    """The rotation about axis number 0 to 2."""
    q = [0.0, 0.0, 0.0, math.cos(angle / 2)]
    q[axis] = math.sin(angle / 2)
    return tuple(q)


def angle_between(a, b):
    """Of two rotations, 0 to pi."""
    x, y, z, w = product(conjugate(a), b)
    return 2 * math.atan2(math.sqrt(x * x + y * y + z * z), abs(w))


def ranges(limit):
    """[low, high] of X, Y, Z, infinite where free."""
    pairs = [limit.get(axis) or FREE for axis in 'xyz']
    return [(-math.inf if low is None else low, math.inf if high is None else high) for low, high in pairs]


def limited_part(limit, q):
    """R of a rotation relative to rest."""
    frame = limit.get('frame', NO_ROTATION)
    return normalized(product(product(conjugate(frame), q), frame))


def excess(limit, q):
    """How far outside the limit the rotation is: radians, 0 inside."""
    rotation = limited_part(limit, q)
    if limit['model'] == 'euler_box':
        return angle_between(rotation, nearest_in_euler_box(limit, rotation))
    if limit['model'] == 'swing_twist_ellipse':
        return swing_twist_excess(limit, rotation)
    raise ValueError(limit['model'])


# ------------------------------------------------------------------------------------------------- swing and twist

def swing_and_twist(rotation):
    """R = swing * twist, twist about X. Returns the swing's y and z with w >= 0, and the twist's angle in [-pi, pi]."""
    x, _, _, w = rotation
    twist = normalized((x, 0.0, 0.0, w)) if math.hypot(x, w) > 1e-12 else NO_ROTATION
    swing = product(rotation, conjugate(twist))
    sign = -1.0 if swing[3] < 0 else 1.0
    angle = 2 * math.atan2(twist[0], twist[3])
    return (sign * swing[1], sign * swing[2]), math.remainder(angle, 2 * math.pi)


def half_axis(value, low_high):
    """Of the ellipse on the side of value. A free axis has no end, so that the other one keeps to a band."""
    end = abs(low_high[1] if value > 0 else low_high[0])
    return math.inf if math.isinf(end) else max(math.sin(min(end, math.pi) / 2), 1e-9)


def swing_twist_excess(limit, rotation):
    """The larger of the twist's excess, the short way round, and of the swing's: towards rest, until it meets the ellipse."""
    swing, twist = swing_and_twist(rotation)
    bounds = ranges(limit)
    low, high = bounds[0]
    over = 0.0 if low <= twist <= high else min(abs(math.remainder(twist - end, 2 * math.pi)) for end in (low, high))
    size, reach = 0.0, math.hypot(*swing)
    for value, (low, high) in zip(swing, bounds[1:]):
        most = half_axis(value, (low, high))
        if most > 1e-9:
            size = math.hypot(size, value / most)
        else:
            over = max(over, 2 * math.asin(min(1.0, abs(value))))
    if size > 1.0:
        over = max(over, 2 * math.asin(min(1.0, reach)) - 2 * math.asin(min(1.0, reach / size)))
    return over


def ellipse_swing(limit, turn, size):
    """The swing of the ellipse in direction turn, size 0 to 1 of the way to its edge; after half a turn no twist can be told."""
    swing = (math.cos(turn), math.sin(turn))
    length = math.hypot(*(value / half_axis(value, low_high) for value, low_high in zip(swing, ranges(limit)[1:])))
    reach = size * min(1.0 - 1e-9, 1.0 / length if length > 0.0 else 1.0)
    return (0.0, swing[0] * reach, swing[1] * reach, math.sqrt(max(0.0, 1.0 - reach * reach)))


def nearest_in_ellipse(limit, rotation, swing_of=ellipse_swing):
    """(the nearest legal rotation, how much nearer it is than any that is not beside it), by search.

    For a given swing the best twist is known; so swings are tried all round and at all sizes, and the best place is refined.
    """
    twist = ranges(limit)[0]

    def rotation_at(turn, size):
        swing = swing_of(limit, turn, size)
        left = product(conjugate(swing), rotation)
        return product(swing, about(0, clamp_angle(2 * math.atan2(left[0], left[3]), *twist)))

    def distance(place):
        return angle_between(rotation, rotation_at(*place))

    places = [(math.pi * turn / 60, size / 15) for turn in range(120) for size in range(16)]
    tried = sorted((distance(place), place) for place in places)
    over, best = tried[0]
    step = 0.1
    while step > 1e-8:
        beside = [(best[0] + dx * step, min(1.0, max(0.0, best[1] + dy * step))) for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
        nearest = min(beside, key=distance)
        if distance(nearest) < over - 1e-12:
            over, best = distance(nearest), nearest
        else:
            step /= 2
    found = rotation_at(*best)
    others = (d for d, place in tried if angle_between(rotation_at(*place), found) > 0.3)
    return found, next(others, math.inf) - over


# ------------------------------------------------------------------------------------------------- Euler angles

def axes_of(order):
    return ['XYZ'.index(letter) for letter in order]


def from_euler(angles, order):
    """angles: about X, Y, Z. "XYZ" is Rz * Ry * Rx: the axis named first turns first."""
    q = NO_ROTATION
    for axis in axes_of(order):
        q = product(about(axis, angles[axis]), q)
    return q


def both_eulers(rotation, order):
    """The two triples of angles about X, Y, Z that give the rotation; the first has its middle angle in [-pi/2, pi/2]."""
    i, j, k = axes_of(order)
    parity = 1.0 if (j - i) % 3 == 1 else -1.0
    m = matrix(rotation)
    first = math.atan2(parity * m[k][j], m[k][k])
    middle = math.atan2(-parity * m[k][i], math.hypot(m[i][i], m[j][i]))
    last = math.atan2(parity * m[j][i], m[i][i])
    other = [math.remainder(angle, 2 * math.pi) for angle in (first + math.pi, math.pi - middle, last + math.pi)]
    result = []
    for values in ((first, middle, last), other):
        angles = [0.0, 0.0, 0.0]
        for axis, angle in zip((i, j, k), values):
            angles[axis] = angle
        result.append(angles)
    return result


def matrix(q):
    x, y, z, w = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]


def each_clamped(limit, rotation):
    """What Blender's Limit Rotation does up to 4.1: the triple with the smaller sum, each angle clamped for itself, no wrap."""
    bounds = ranges(limit)
    angles = min(both_eulers(rotation, limit['order']), key=lambda triple: sum(map(abs, triple)))
    clamped = [min(max(angle, low), high) for angle, (low, high) in zip(angles, bounds)]
    return from_euler(clamped, limit['order']), angles


def outside_axes(limit, angles):
    return [axis for axis, (angle, (low, high)) in enumerate(zip(angles, ranges(limit))) if not low <= angle <= high]


NEAR = 1.0                              # radians: further away, another part of a wide box may be nearer


def must_agree(limit, angles, moved):
    """Whether Blender's clamp, which moves by so many radians, must be the nearest legal rotation too.

    It is where only the angle that turns second is outside: the other two turn about axes that are perpendicular to its own,
    so they can win nothing. An angle that turns first or last shares its axis in part with the other one, unless the middle
    one is 0; it is taken here where it is the only turn.
    """
    outside = outside_axes(limit, angles)
    if len(outside) != 1 or moved > NEAR:
        return False
    if outside[0] == axes_of(limit['order'])[1]:
        return abs(angles[outside[0]]) <= math.pi / 2
    return all(abs(angle) < 1e-6 for axis, angle in enumerate(angles) if axis != outside[0])


def clamp_angle(angle, low, high):
    """The value in [low, high] that is nearest to angle on the circle."""
    if math.isinf(low) or math.isinf(high):
        return angle
    turned = math.remainder(angle - (low + high) / 2, 2 * math.pi) + (low + high) / 2
    return min(max(turned, low), high)


def nearest_in_euler_box(limit, rotation):
    """The rotation with all angles in their ranges that is nearest to rotation.

    Seen as a function of one angle, the cosine of half the distance is a cosine, whose best legal value is known. So each angle
    is set to its best in turn until none moves, from several starts.
    """
    bounds, order = ranges(limit), limit['order']
    starts = []
    for triple in both_eulers(rotation, order):
        starts.append([clamp_angle(angle, low, high) for angle, (low, high) in zip(triple, bounds)])
        starts.append([min(max(angle, low), high) for angle, (low, high) in zip(triple, bounds)])
    candidates = [climb(start, rotation, bounds, order) for start in starts]
    return min(candidates, key=lambda q: angle_between(q, rotation))


def climb(angles, rotation, bounds, order):
    angles, turning = list(angles), axes_of(order)
    for _ in range(400):
        moved = 0.0
        for place, axis in enumerate(turning):
            before, after = NO_ROTATION, NO_ROTATION
            for other in turning[:place]:
                before = product(about(other, angles[other]), before)
            for other in turning[place + 1:]:
                after = product(about(other, angles[other]), after)
            wanted = product(product(conjugate(after), rotation), conjugate(before))
            best = clamp_angle(2 * math.atan2(wanted[axis], wanted[3]), *bounds[axis])
            moved = max(moved, abs(best - angles[axis]))
            angles[axis] = best
        if moved < 1e-10:
            break
    return from_euler(angles, order)


# ------------------------------------------------------------------------------------------------- extras as limits

def limits_of_extras(record):
    """The constraints that a node's extras.rig_joint means: (from Limit Rotation, from the IK limits), None where there is none."""
    euler = next((limit for limit in record.get('euler_limits', []) if limit['space'] == 'rest'), None)
    rotation = euler and {'model': 'euler_box', 'order': euler['order'], **{axis: euler[axis] for axis in 'xyz' if axis in euler}}
    ik = record.get('swing_twist')
    names = {'x': 'twist_y', 'y': 'swing_z', 'z': 'swing_x'}
    ik = ik and {'model': 'swing_twist_ellipse', 'frame': list(BONE_FRAME),
                 **{axis: ik[name] for axis, name in names.items() if name in ik}}
    return rotation or None, ik or None


def all_orders():
    return [''.join(letters) for letters in itertools.permutations('XYZ')]
