"""Lists settings of Blender that the records cannot express, as texts for the user and for the file.

A note is (approximated, text): approximated if a record is written but Blender behaves differently from it.
"""
from .clip_curves import action_curves
from .ik_chains import is_import_helper
from .joint_limits import SPACES, is_at_work
from .kept_records import is_muted, kept_limits

KINDS = {'LIMIT_ROTATION': 'Limit Rotation', 'LIMIT_LOCATION': 'Limit Location', 'IK': 'Inverse Kinematics'}


def bone_notes(bone):
    """Notes on a bone's limits, and on its constraints that have no record."""
    limits, has_changed = kept_limits(bone)
    if limits is not None:
        others = [c for c in bone.constraints if c.type not in ('LIMIT_ROTATION', 'LIMIT_LOCATION')]
        return [note for constraint in others for note in other_notes(bone, constraint)]
    notes = []
    if has_changed:
        notes.append((False, 'its constraints were changed since the import: written as Blender has them'))
    for constraint in bone.constraints:
        notes += limit_notes(bone, constraint) if constraint.type in ('LIMIT_ROTATION', 'LIMIT_LOCATION') else other_notes(bone, constraint)
    for kind in ('LIMIT_ROTATION', 'LIMIT_LOCATION'):
        count = sum(c.type == kind and is_at_work(bone, c) for c in bone.constraints)
        if count > 1:
            notes.append((True, f'{count} {KINDS[kind]} constraints, which Blender keeps one after the other'))
    return notes + ik_limit_notes(bone)


def ik_limit_notes(bone):
    """Measured in Blender 3.4: its solver ignores a swing limit if the other swing axis is free and the twist is locked."""
    limited = bone.use_ik_limit_x + bone.use_ik_limit_z
    if bone.lock_ik_y and not (bone.lock_ik_x or bone.lock_ik_z) and limited == 1:
        return [(False, 'IK limits: one swing axis is free and the twist is locked, so Blender itself forgets the other one\'s limit')]
    return []


def limit_notes(bone, constraint):
    what = described(constraint)
    if is_muted(bone, constraint):
        return [(False, f'{what} is muted: left out')]
    if constraint.influence <= 0.0:
        return [(False, f'{what} has no influence: left out')]
    notes = [(False, f'{what}: {text}') for text in moving_values(bone, constraint)]
    space = SPACES.get(constraint.owner_space)
    if space in (None, 'custom'):
        owner = getattr(constraint, 'space_object', None)
        notes.append((True, f'{what} is in the space of {owner.name if owner else "nothing"}'))
    elif space != 'rest':
        notes.append((True, f'{what} is not in local space, so what it allows depends on the pose of the parents'))
    elif not bone.bone.use_inherit_rotation:
        notes.append((True, f'{what}: the bone does not inherit rotation, so its local space does not turn with its parent'))
    if space == 'rest' and constraint.type == 'LIMIT_LOCATION' and not bone.bone.use_local_location:
        notes.append((True, f'{what}: the bone has Local Location off, so its axes are the armature\'s'))
    if constraint.influence < 1.0:
        notes.append((True, f'{what} has the influence {constraint.influence:.6g}'))
    return notes


def other_notes(bone, constraint):
    if constraint.type == 'IK':
        return [(False, f'{described(constraint)} is muted: left out')] if is_muted(bone, constraint) else []
    if not is_at_work(bone, constraint):
        return []
    return [(False, f'{described(constraint)} has no record: left out; clips are exported with its effect')]


def chain_notes(bone, constraint, joints, exported):
    """exported: names of the rig's bones that are in the file."""
    rig, notes = bone.id_data, [(False, text) for text in moving_values(bone, constraint)]
    if rig.pose.ik_solver != 'LEGACY':
        notes.append((True, f'the solver is {rig.pose.ik_solver}, whose limits and weights mean something else'))
    missing = [name for name in joints if name not in exported]
    if missing:
        notes.append((True, f'not in the file: {", ".join(missing)}'))
    for what, obj, subtarget in (('target', constraint.target, constraint.subtarget),
                                 ('pole', constraint.pole_target, constraint.pole_subtarget)):
        if obj and subtarget and obj.type != 'ARMATURE':
            notes.append((True, f'its {what} is the vertex group {subtarget} of {obj.name}: the object was written'))
        elif obj and subtarget and subtarget not in obj.data.bones:
            notes.append((True, f'its {what} {subtarget} does not exist: {obj.name} was written'))
        elif obj is rig and subtarget and subtarget not in exported and not is_import_helper(obj, subtarget):
            notes.append((True, f'its {what} {subtarget} is not in the file'))
    if not constraint.target:
        notes.append((False, 'it has no target'))
    return notes


def moving_values(bone, constraint):
    """A record has a single value, so an animated setting is noted."""
    place = f'pose.bones["{bone.name}"].constraints["{constraint.name}"].'
    curves = all_curves(bone.id_data.animation_data)
    moving = sorted({curve.data_path[len(place):] for curve in curves if curve.data_path.startswith(place)})
    return [f'{name} is animated or driven: {getattr(constraint, name, "one value")} was written' for name in moving]


def all_curves(animation):
    """The drivers and the curves of every action on an object."""
    if not animation:
        return
    yield from animation.drivers
    actions = [animation.action] + [strip.action for track in animation.nla_tracks for strip in track.strips]
    for action in filter(None, actions):
        yield from action_curves(action)


def object_notes(obj):
    """Notes on an object that is not an armature: its constraints cannot be exported."""
    return [(False, f'{described(c)}: only bones have limits and chains: left out') for c in obj.constraints
            if c.type in KINDS and is_at_work(obj, c)]


def described(constraint):
    """The constraint's kind, and its name if the user gave it one."""
    kind = KINDS.get(constraint.type, constraint.type.replace('_', ' ').title())
    return kind if constraint.name == kind else f'{kind} "{constraint.name}"'
