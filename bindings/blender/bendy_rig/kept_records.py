"""Keeps the records of an imported rig in custom properties, so that an export writes the same records.

Blender's constraints express less than the records, or express it differently. So each record is kept, and exported again as
long as the bone or constraint is as the import set it; otherwise Blender's settings are exported.
"""
import json
import math

from . import chain_settings, joint_settings
from .shortest import as_float32, shortest

CONSTRAINTS = 'bendy_constraints'   # of a pose bone or an object: the list of a joint's constraints
CHAINS = 'bendy_chains'             # of an armature object: [{"record": a chain, "bone" and "constraint": names or null}]
MARKERS = 'bendy_markers'           # of an action: [{"time": seconds, "name": text}]
CLIP = 'bendy_clip'                 # of an action: the number of its clip, because the exporter sorts clips by name
CURVES = 'bendy_curves'             # of an object: the list of the file's curves
ROLE = 'bendy_role'                 # of a pose bone or an object: what it is in the body, 'leftHand' or 'tail:2'
REST = 'bendy_rest'                 # of an object or shape keys that clips move: data path -> the values of the rest pose
EXTRAS = 'bendy_extras'             # of what has extras: name -> [the file's value, the one that Blender exports, or null]
RECORD = 'bendy_record'             # of a camera or a light: {"record": the file's, "settings": Blender's after the import}
DOCUMENTS = 'bendy_documents'       # of a scene: what is kept of each file, by the file's key: kept_document.py
MARK = 'bendy_mark'                 # of a pose bone, an object, a mesh or a material: its file's key and its number there, 'KEY:NUMBER'
ANGLES = ('x', 'y', 'z', 'angle', 'preferred', 'soft_zone', 'pole_angle')       # degrees in a rig file, radians in extras


def keep(owner, key, value):
    """Stored as text: a custom property would round numbers, and cannot hold nulls."""
    owner[key] = json.dumps(value, ensure_ascii=False)


def kept(owner, key):
    try:
        return json.loads(owner[key]) if key in owner else None
    except (TypeError, ValueError):
        return None                 # the user has put something else there


def without_kept(extras):
    """The extras that the exporter made from an owner's custom properties, without those of this module."""
    left = {key: value for key, value in (extras or {}).items()
            if key not in (CONSTRAINTS, CHAINS, MARKERS, CLIP, CURVES, ROLE, REST, EXTRAS, RECORD, DOCUMENTS, MARK, chain_settings.HELPER)}
    return left or None


def is_muted(bone, constraint):
    """A muted constraint is not exported, unless an import made it: those are muted so that clips play as stored."""
    return constraint.mute and not is_imported(bone, constraint)


def is_imported(bone, constraint):
    if constraint.type != 'IK':
        return CONSTRAINTS in bone
    place = (bone.name, constraint.name)
    return any((entry['bone'], entry['constraint']) == place for entry in kept(bone.id_data, CHAINS) or [])


# ------------------------------------------------------------------------------------------------- joints

def kept_limits(bone):
    """(limits for rig_joint or None, whether the bone has changed since the import)."""
    record = kept(bone, CONSTRAINTS)
    if record is None:
        return None, False
    if joint_settings.read_settings(bone) != joint_settings.bone_settings(record)[0]:
        return None, True
    return in_radians(record), False


# ------------------------------------------------------------------------------------------------- chains

def kept_chains(rig, exported):
    """(chains for rig_ik, their (bone, constraint) names, names of chains that have changed). exported: names of the bones in the file."""
    chains, constraints, changed = [], set(), []
    for entry in kept(rig, CHAINS) or []:
        record, place = entry['record'], (entry['bone'], entry['constraint'])
        joints = [record[key] for key in ('start', 'effector', 'target', 'pole') if key in record]
        if entry['constraint'] is not None and not all(joint in exported for joint in joints):
            changed.append(record['name'])
        elif entry['constraint'] is None:
            chains.append(in_radians(record))
        elif is_unchanged(rig, record, *place):
            chains.append(in_radians(record))
            constraints.add(place)
        else:
            changed.append(record['name'])
    return chains, constraints, changed


def is_unchanged(rig, record, bone, constraint):
    bone = rig.pose.bones.get(bone)
    constraint = bone and bone.constraints.get(constraint)
    if not constraint or constraint.type != 'IK' or not chain_settings.links_of(rig, record):
        return False
    return chain_settings.is_as_set(rig, bone, constraint, chain_settings.chain_settings(rig, record)[0])


# ------------------------------------------------------------------------------------------------- markers

def kept_markers(action, rate):
    """A clip's pose markers with their original times, unless the user has moved one to another frame."""
    left = list(kept(action, MARKERS) or [])
    markers = []
    for pose_marker in action.pose_markers:
        marker = {'time': pose_marker.frame / rate, 'name': pose_marker.name}
        same = next((m for m in left if m['name'] == marker['name'] and round(m['time'] * rate) == pose_marker.frame), None)
        if same:
            left.remove(same)
        markers.append(same or marker)
    return sorted(markers, key=lambda marker: marker['time'])


# ------------------------------------------------------------------------------------------------- angles

def in_radians(record):
    """A constraint, a list of them or a chain, with angles as in extras: the floats that the converter computes from degrees."""
    if isinstance(record, list):
        return [in_radians(item) for item in record]
    return {key: angles_in_radians(value) if key in ANGLES else value for key, value in record.items()}


def angles_in_radians(value):
    if isinstance(value, list):
        return [angles_in_radians(item) for item in value]
    return None if value is None else shortest(as_float32(value * (math.pi / 180.0)))
