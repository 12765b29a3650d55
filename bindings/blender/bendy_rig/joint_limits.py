"""A pose bone's limits as node.extras["rig_joint"]; spec/rig.md says what the keys mean."""
from .kept_records import is_muted, kept_limits
from .shortest import quaternion_xyzw, shortest, shortest_list

SPACES = {'LOCAL': 'rest', 'LOCAL_WITH_PARENT': 'rest_with_parent', 'POSE': 'armature', 'WORLD': 'world', 'CUSTOM': 'custom'}
IK_AXES = {'x': 'swing_x', 'y': 'twist_y', 'z': 'swing_z'}


def joint_record(bone, axes):
    """The bone's limits; None if it has none. A record from an import is complete in itself."""
    limits, _ = kept_limits(bone)
    record = blender_limits(bone, axes) if limits is None else {'limits': limits}
    if bone.ik_stretch:
        record['stretch'] = shortest(bone.ik_stretch)
    locks = {kind: [bool(v) for v in getattr(bone, f'lock_{kind}')] for kind in ('rotation', 'location', 'scale')}
    locks = {kind: values for kind, values in locks.items() if any(values)}
    if locks:
        record['locks'] = locks
    if not record:
        return None
    return {'rest_orientation': rest_orientation(bone, axes), 'length': shortest(bone.bone.length), **record}


def blender_limits(bone, axes):
    """The bone's limits from Blender's settings."""
    record = {}
    for key, kind, make in (('euler_limits', 'LIMIT_ROTATION', euler_limit), ('location_limits', 'LIMIT_LOCATION', location_limit)):
        limits = [make(c, bone, axes) for c in bone.constraints if c.type == kind and is_at_work(bone, c)]
        limits = [limit for limit in limits if any(axis in limit for axis in 'xyz')]
        if limits:
            record[key] = limits
    swing_twist = ik_limits(bone)
    if swing_twist:
        record['swing_twist'] = swing_twist
    stiffness = shortest_list(getattr(bone, f'ik_stiffness_{axis}') for axis in 'xyz')
    if any(stiffness):
        record['stiffness'] = stiffness
    return record


def says_a_limit(record):
    """Whether a record of extras, or None, contains more than locked channels and notes."""
    return any(key in (record or {}) for key in ('limits', 'euler_limits', 'location_limits', 'swing_twist', 'stiffness'))


def is_at_work(owner, constraint):
    """owner: a pose bone or an object."""
    return not is_muted(owner, constraint) and constraint.influence > 0.0


def rest_orientation(bone, axes):
    """In the file's space, below the armature's own transform, as the exporter computes inverse bind matrices."""
    return quaternion_xyzw((axes.matrix @ bone.id_data.matrix_world @ bone.bone.matrix_local).to_quaternion())


def euler_limit(constraint, bone, axes):
    ranges = {axis: in_order(shortest(getattr(constraint, f'min_{axis}')), shortest(getattr(constraint, f'max_{axis}')))
              for axis in 'xyz' if getattr(constraint, f'use_limit_{axis}')}
    order = euler_order(constraint, bone)
    record = {'space': SPACES.get(constraint.owner_space, 'custom')}
    if record['space'] in ('armature', 'world'):
        ranges, order = axes.ranges(ranges), axes.order(order)
        record['zero'] = quaternion_xyzw(axes.zero())
    record.update(order=order, **ranges)
    return with_influence(record, constraint)


def euler_order(constraint, bone):
    """The constraint's order; "as the bone" means XYZ for bones rotated by quaternions."""
    order = getattr(constraint, 'euler_order', 'AUTO')
    if order == 'AUTO':
        order = bone.rotation_mode
    return order if order not in ('QUATERNION', 'AXIS_ANGLE') else 'XYZ'


def location_limit(constraint, bone, axes):
    ranges = {}
    for axis in 'xyz':
        low, high = (shortest(getattr(constraint, f'{end}_{axis}')) if getattr(constraint, f'use_{end}_{axis}') else None
                     for end in ('min', 'max'))
        if low is not None or high is not None:
            ranges[axis] = in_order(low, high)
    space = SPACES.get(constraint.owner_space, 'custom')
    if space in ('armature', 'world'):
        ranges = axes.ranges(ranges)
    return with_influence({'space': space, **ranges}, constraint)


def in_order(low, high):
    """Blender clamps to the minimum first, so the maximum wins if it is lower."""
    if low is not None and high is not None and low > high:
        low = high
    return [low, high]


def with_influence(record, constraint):
    if constraint.influence != 1.0:
        record['influence'] = shortest(constraint.influence)
    return record


def ik_limits(bone):
    """The limits of the IK solver. A locked axis has no freedom, whatever its limits."""
    limits = {}
    for axis, name in IK_AXES.items():
        if getattr(bone, f'lock_ik_{axis}'):
            limits[name] = [0.0, 0.0]
        elif getattr(bone, f'use_ik_limit_{axis}'):
            limits[name] = [shortest(getattr(bone, f'ik_min_{axis}')), shortest(getattr(bone, f'ik_max_{axis}'))]
    return limits
