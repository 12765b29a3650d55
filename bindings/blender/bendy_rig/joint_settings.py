"""A joint's constraints, as a rig file has them (spec/rig.md), as settings of Blender's pose bone, and what Blender has no setting for.

Settings are plain data, so that an export can compare the import's settings with the bone's current ones.
"""
import json
import math

from mathutils import Quaternion

from .shortest import as_float32

LETTERS = 'xyz'
ALONG_AXIS = 1e-6                   # sine of the largest angle between an axis of a constraint's frame and a bone axis that counts as equal
NEAR_AXIS = 0.5                     # the same for assigning IK limits to the bone's nearest axis: 30 degrees
STIFFEST = 0.99                     # Blender's largest IK stiffness
NO_RANGE = (None, None)
HALF_TURN = as_float32(math.pi)
OTHER_AXES = ' about other axes than the bone\'s'
AXES_OF_MODEL = {'hinge': 1, 'euler_box': 3, 'swing_twist_ellipse': 3, 'swing_twist_pyramid': 3}     # of the frame, that a model is about
UNUSED = {'soft_zone': 'soft zone', 'preferred': 'preferred angles'}     # keys of a constraint that Blender has no setting for


class Axes:
    """Maps the axes of a constraint's frame to axes of the bone; None for an axis that lies between the bone's axes."""

    def __init__(self, frame, tolerance=ALONG_AXIS):
        x, y, z, w = frame or (0.0, 0.0, 0.0, 1.0)
        matrix = Quaternion((w, x, y, z)).normalized().to_matrix()
        self.of = [self.bone_axis(matrix.col[i], tolerance) for i in range(3)]      # frame's axis -> (bone's axis, sign) or None

    @staticmethod
    def bone_axis(column, tolerance):
        axis = max(range(3), key=lambda i: abs(column[i]))
        others = math.hypot(*(column[i] for i in range(3) if i != axis))
        return (axis, 1 if column[axis] > 0 else -1) if others < tolerance else None

    def are_bone_axes(self):
        return all(self.of)

    def ranges(self, ranges):
        """Frame's axis -> [low, high], as bone's axis -> (low, high)."""
        turned = {}
        for axis, limits in ranges.items():
            bone_axis, sign = self.of[LETTERS.index(axis)]
            low, high = limits
            turned[LETTERS[bone_axis]] = (low, high) if sign > 0 else (negative(high), negative(low))
        return turned

    def order(self, order):
        return ''.join('XYZ'[self.of['XYZ'.index(letter)][0]] for letter in order)


def negative(number):
    return None if number is None else 0.0 - number


def radians(degrees):
    return as_float32(degrees * (math.pi / 180.0))


# ------------------------------------------------------------------------------------------------- from a record to settings

def bone_settings(constraints):
    """(settings, notes) for a joint's constraints; the notes list what Blender does not do."""
    by_scope = {constraint.get('scope', 'every_pose'): constraint for constraint in constraints}
    every = by_scope.get('every_pose')
    settings, notes = {'limit_rotation': None, 'limit_location': None, 'ik': {}, 'stiffness': (0.0, 0.0, 0.0)}, []
    posing, solving = by_scope.get('all_but_ik', every), by_scope.get('ik_only', every)
    if posing:
        add_pose_limits(settings, posing, notes)
    if solving:
        add_ik_limits(settings, solving, notes)
    for constraint in constraints:
        unused = [key for key in UNUSED if any_number(constraint.get(key, 0))]
        if unused:
            notes.append(f'no {" or ".join(UNUSED[key] for key in unused)}')
    if any_number([constraint.get('stiffness', 0) for constraint in constraints if constraint is not solving]):
        notes.append('stiffness is for IK only')
    return settings, notes


def any_number(value):
    return any(map(any_number, value)) if isinstance(value, list) else bool(value)


def limited(constraint, letters=LETTERS):
    """Frame's axis -> [low, high] in radians, for the limited axes; an open range, or one of a full turn, is free."""
    found = {}
    for axis in letters:
        low, high = constraint.get(axis, NO_RANGE)
        if low is not None and high is not None and high - low < 360.0:
            found[axis] = [radians(low), radians(high)]
    return found


def half_open(constraint):
    """The swings of an ellipse or pyramid that have a limit on one side."""
    found = {}
    for axis in 'yz' if constraint['model'].startswith('swing_twist') else '':
        low, high = constraint.get(axis, NO_RANGE)
        if (low is None) != (high is None):
            found[axis] = [-HALF_TURN if low is None else radians(low), HALF_TURN if high is None else radians(high)]
    return found


def add_pose_limits(settings, constraint, notes):
    """Limit Rotation and Limit Location, which everything except IK obeys."""
    axes, model = Axes(constraint.get('frame')), constraint['model']
    ranges, order = None, 'XYZ'
    if model == 'locked':
        ranges = {axis: (0.0, 0.0) for axis in LETTERS}
    elif model == 'hinge' and axes.of[0]:
        about = LETTERS[axes.of[0][0]]
        ranges = {**{axis: (0.0, 0.0) for axis in LETTERS}, about: axes.ranges(limited(constraint, 'x')).get(about)}
    elif model == 'euler_box' and axes.are_bone_axes():
        ranges, order = axes.ranges(limited(constraint)), axes.order(constraint.get('order', 'XYZ'))
    elif model != 'free':
        notes.append(f'no Limit Rotation for {named(model)}{OTHER_AXES if model in ("hinge", "euler_box") else ""}')
    ranges = {axis: limits for axis, limits in (ranges or {}).items() if limits}
    if ranges:
        settings['limit_rotation'] = {'order': order, **ranges}
    place = constraint.get('translation', {})
    place = {axis: limits for axis, limits in place.items() if any(limit is not None for limit in limits)}
    if place and axes.are_bone_axes():
        settings['limit_location'] = {axis: tuple(None if v is None else as_float32(v) for v in limits)
                                      for axis, limits in axes.ranges(place).items()}
    elif place:
        notes.append(f'no Limit Location for ranges{OTHER_AXES}')


def add_ik_limits(settings, constraint, notes):
    """The pose bone's Inverse Kinematics panel, for Blender's IK solver: an ellipse of swings and a range of twists about Y."""
    axes, model = Axes(constraint.get('frame')), constraint['model']
    is_turned = model in AXES_OF_MODEL and not all(axes.of[:AXES_OF_MODEL[model]])
    ranges, is_same = ik_ranges(Axes(constraint.get('frame'), NEAR_AXIS) if is_turned else axes, constraint)
    for axis, limits in ranges.items():
        if limits:
            low, high = max(min(limits[0], 0.0), -HALF_TURN), min(max(limits[1], 0.0), HALF_TURN)
            is_same = is_same and (low, high) == tuple(limits)
            settings['ik'][axis] = (low, high)
    if is_turned:
        notes.append(f'IK limits are about the bone\'s axes, those of {named(model)} about others')
    elif not is_same:
        notes.append(f'IK limits are close to {named(model)}, not equal')
    stiffness = constraint.get('stiffness', [0.0, 0.0, 0.0])
    if any(stiffness) and axes.are_bone_axes():
        values = {axes.of[i][0]: as_float32(min(stiffness[i], STIFFEST)) for i in range(3)}
        settings['stiffness'] = (values[0], values[1], values[2])
        if max(stiffness) > STIFFEST:
            notes.append(f'IK stiffness is at most {STIFFEST}')
    elif any(stiffness):
        notes.append(f'no IK stiffness for one{OTHER_AXES}')


def ik_ranges(axes, constraint):
    """(bone's axis -> (low, high) in radians, whether these equal the constraint). If no axis of the bone is near,
    each axis gets the constraint's largest angle."""
    model = constraint['model']
    if model == 'locked':
        return {axis: (0.0, 0.0) for axis in LETTERS}, True
    if model == 'largest_angle':
        angle = constraint.get('angle')
        return alike(None if angle is None else radians(angle)), angle is None or angle >= 180.0
    if model == 'hinge' and axes.of[0]:
        about = LETTERS[axes.of[0][0]]
        return {**{axis: (0.0, 0.0) for axis in LETTERS}, about: axes.ranges(limited(constraint, 'x')).get(about)}, True
    if model == 'hinge':
        return alike(largest(limited(constraint, 'x').values())), False
    if model not in AXES_OF_MODEL:
        return {}, True
    if not axes.are_bone_axes():
        found = {**limited(constraint), **half_open(constraint)}
        return alike(largest(found.values()) if len(found) == 3 else None), False
    ranges = axes.ranges({**limited(constraint), **half_open(constraint)})
    moving = [axis for axis in LETTERS if ranges.get(axis) != (0.0, 0.0)]
    return ranges, len(moving) <= 1 or (model == 'swing_twist_ellipse' and axes.of[0][0] == 1)


def alike(angle):
    """The same range for each axis; none for half a turn or more."""
    return {axis: (-angle, angle) for axis in LETTERS} if angle is not None and angle < HALF_TURN else {}


def largest(ranges):
    return max((abs(end) for limits in ranges for end in limits), default=None)


def named(model):
    return {'euler_box': 'an Euler box', 'swing_twist_ellipse': 'a swing-twist ellipse', 'swing_twist_pyramid': 'a swing-twist pyramid',
            'largest_angle': 'a largest angle', 'hinge': 'a hinge', 'locked': 'locked', 'free': 'free'}[model]


# ------------------------------------------------------------------------------------------------- descriptions

def described(constraint):
    """Lines of text that describe what a constraint of a rig file allows."""
    model, frame = constraint['model'], constraint.get('frame')
    angles = [f'{axis} {range_text(constraint[axis])}' for axis in LETTERS if axis in constraint]
    if 'angle' in constraint:
        angles.append(f'at most {constraint["angle"]:g}')
    lines = [named(model).split(' ', 1)[-1].capitalize() + (f': {", ".join(angles)} degrees' if angles else '')]
    if frame and model in AXES_OF_MODEL and not all(Axes(frame).of[:AXES_OF_MODEL[model]]):
        x, y, z, w = frame
        columns = Quaternion((w, x, y, z)).normalized().to_matrix().col
        lines += [f'{LETTERS[i]} is about ({", ".join(f"{number:.2f}" for number in columns[i])}) of the bone'
                  for i in range(AXES_OF_MODEL[model])]
    place = constraint.get('translation', {})
    if place:
        lines.append('Moves: ' + ', '.join(f'{axis} {range_text(limits)}' for axis, limits in place.items()) + ' m')
    lines += [f'{key.replace("_", " ").capitalize()}: {json.dumps(constraint[key])}' for key in ('scope', 'order', *UNUSED, 'stiffness')
              if key in constraint]
    return lines


def range_text(limits):
    low, high = ('open' if end is None else f'{end:g}' for end in limits)
    return f'{low} to {high}'


# ------------------------------------------------------------------------------------------------- to and from a pose bone

def apply_settings(bone, settings, is_muted):
    """Makes the constraints on a bone that has none yet."""
    rotation, location = settings['limit_rotation'], settings['limit_location']
    if rotation:
        limit = new_limit(bone, 'LIMIT_ROTATION', is_muted)
        limit.euler_order = rotation['order']
        for axis in LETTERS:
            if axis in rotation:
                setattr(limit, f'use_limit_{axis}', True)
                setattr(limit, f'min_{axis}', rotation[axis][0])
                setattr(limit, f'max_{axis}', rotation[axis][1])
    if location:
        limit = new_limit(bone, 'LIMIT_LOCATION', is_muted)
        for axis, ends in location.items():
            for end, value in zip(('min', 'max'), ends):
                if value is not None:
                    setattr(limit, f'use_{end}_{axis}', True)
                    setattr(limit, f'{end}_{axis}', value)
    for axis, (low, high) in settings['ik'].items():
        if low == high == 0.0:
            setattr(bone, f'lock_ik_{axis}', True)
        else:
            setattr(bone, f'use_ik_limit_{axis}', True)
            setattr(bone, f'ik_min_{axis}', low)
            setattr(bone, f'ik_max_{axis}', high)
    for axis, value in zip(LETTERS, settings['stiffness']):
        setattr(bone, f'ik_stiffness_{axis}', value)


def new_limit(bone, kind, is_muted):
    limit = bone.constraints.new(kind)
    limit.owner_space, limit.mute = 'LOCAL', is_muted
    return limit


def read_settings(bone):
    """The bone's current settings; None if settings cannot express them."""
    settings = {'limit_rotation': None, 'limit_location': None, 'ik': {}}
    for constraint in bone.constraints:
        kind = constraint.type.lower()
        if kind not in ('limit_rotation', 'limit_location'):
            continue
        if settings[kind] or constraint.owner_space != 'LOCAL' or constraint.influence != 1.0:
            return None
        settings[kind] = read_rotation(constraint) if kind == 'limit_rotation' else read_location(constraint)
    for axis in LETTERS:
        if getattr(bone, f'lock_ik_{axis}'):
            settings['ik'][axis] = (0.0, 0.0)
        elif getattr(bone, f'use_ik_limit_{axis}'):
            settings['ik'][axis] = (getattr(bone, f'ik_min_{axis}'), getattr(bone, f'ik_max_{axis}'))
    settings['stiffness'] = tuple(getattr(bone, f'ik_stiffness_{axis}') for axis in LETTERS)
    return settings


def read_rotation(constraint):
    ranges = {axis: (getattr(constraint, f'min_{axis}'), getattr(constraint, f'max_{axis}'))
              for axis in LETTERS if getattr(constraint, f'use_limit_{axis}')}
    return {'order': getattr(constraint, 'euler_order', 'XYZ'), **ranges}


def read_location(constraint):
    ranges = {}
    for axis in LETTERS:
        ends = tuple(getattr(constraint, f'{end}_{axis}') if getattr(constraint, f'use_{end}_{axis}') else None for end in ('min', 'max'))
        if ends != NO_RANGE:
            ranges[axis] = ends
    return ranges
