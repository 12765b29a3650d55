"""An IK chain, as a rig file has it (spec/rig.md), as settings of an IK constraint, and what Blender has no setting for.

A chain's tip may be anywhere in the space of its last bone; Blender's is the tail of a bone. Where the two differ, the constraint
sits on a bone of its own, that reaches to the tip and is rigid. A chain without a target or pole joint gets a control: a bone too.
Neither is exported.
"""
import math

from mathutils import Quaternion, Vector

from .axes import Y_UP
from .shortest import as_float32

HELPER = 'bendy_helper'             # custom property of objects that an import made and an export leaves out
TIP, CONTROL, ROOT = 'tip', 'control', 'root'       # bones for a tip, target or pole; an armature that is not a joint
DEFAULT_ITERATIONS = 500            # Blender's; a file need not give a number
ALONG_BONE = 1e-4                   # of the bone's length: how far the tip may be from where the tail can be
STRAIGHT = 1e-4                     # of the chain's length
TOLERANCE = 1e-5                    # metres or radians, of what is computed from rest positions
NO_COUNTERPART = ('priority', 'tolerance', 'compress', 'weights')


def is_helper(owner):
    return HELPER in owner


def links_of(rig, record):
    """The names of the bones that the chain turns, from the start to the effector; None if the rig lacks these bones."""
    bone, names = rig.pose.bones.get(record['effector']), []
    while bone:
        names.insert(0, bone.name)
        if bone.name == record['start']:
            return names
        bone = bone.parent
    return None


def chain_settings(rig, record):
    """(settings, notes). The names in the record are those of the rig's bones."""
    notes, data = [], rig.data.bones
    links = links_of(rig, record)
    offset = Vector(record.get('tip_offset', (0.0, 0.0, 0.0)))
    rotates = record.get('rotation_weight', 0) > 0
    # If the tip is at the effector's head, the effector's own rotation matters only if the chain has an orientation to reach.
    if len(links) > 1 and offset.length == 0.0 and not rotates:
        last = data[links[-2]]
        tip = last.matrix_local.inverted() @ data[links[-1]].head_local
        links = links[:-1]
    else:
        last = data[links[-1]]
        tip = offset
    place = last.matrix_local @ tip
    settings = {
        'joints': links,
        'tip': tip,
        'iterations': record.get('iterations', 0) or DEFAULT_ITERATIONS,
        'influence': as_float32(record.get('influence', 1.0)),
        'weight': as_float32(record.get('position_weight', 1.0)),
        'use_location': record.get('position_weight', 1.0) > 0,
        'use_rotation': rotates,
        'orient_weight': as_float32(record.get('rotation_weight', 0)) if rotates else 1.0,
        'use_stretch': record.get('stretch', 0) > 0,
        'target': record.get('target'),
        'pole': record.get('pole'),
        'target_place': place,
        'pole_place': None,
        'pole_angle': 0.0,
    }
    if settings['pole'] or any(record.get('pole_vector', ())):
        settings['pole_place'] = pole_place(rig, record, links, place)
        settings['pole_angle'] = pole_angle(rig, links, place, settings['pole_place'], math.radians(record.get('pole_angle', 0)))
    missing = [name for key in ('target', 'pole') for name in [settings[key]] if name and name not in data]
    if missing:
        notes.append('the target or pole is not a bone of the armature')
        settings.update({key: None for key in ('target', 'pole') if settings[key] in missing})
    unused = [key.replace('_', ' ') for key in NO_COUNTERPART if record.get(key)]
    if record.get('solver', 'any') not in ('any', 'two_bone'):
        unused.insert(0, f'solver {record["solver"]}')
    if record.get('stretch', 0) > 0:
        unused.append(f'stretch of {record["stretch"]:.6g}')
    if rotates and Quaternion(xyzw_to_wxyz(record.get('tip_rotation', (0, 0, 0, 1)))).angle > 1e-6:
        unused.append('tip rotation')
    if unused:
        notes.append(f'no {", ".join(unused)}')
    return settings, notes


def xyzw_to_wxyz(q):
    return (q[3], *q[:3])


def pole_place(rig, record, links, tip):
    """The pole's place at rest, in the armature's space: the pole joint's, or a point on the pole vector, as far from the start as the tip."""
    data = rig.data.bones
    if record.get('pole', '') in data:
        return data[record['pole']].head_local.copy()
    start = data[links[0]]
    direction = Vector(record.get('pole_vector', (0.0, 0.0, 1.0)))
    direction = start.parent.matrix_local.to_3x3() @ direction if start.parent else Y_UP.to_3x3().inverted() @ direction
    return start.head_local + direction.normalized() * max((tip - start.head_local).length, 1e-3)


def pole_angle(rig, links, tip, pole, angle):
    """Blender's pole angle: Blender turns the axis X * cos + Z * sin of the first bone to the pole; the file's angle runs from the pole to
    the bend."""
    data = rig.data.bones
    start = data[links[0]].head_local
    line = (tip - start).normalized()
    across = lambda vector: vector - line * vector.dot(line)
    bends = [across(data[name].head_local - start) for name in links[1:]]
    bend = max(bends, key=lambda vector: vector.length, default=Vector())
    if bend.length <= STRAIGHT * (tip - start).length:
        bend, angle = across(pole - start), 0.0             # a straight chain has no bend: at rest it stays where it is
    wanted = Quaternion(line, -angle) @ bend
    side = line.cross(wanted)
    x, z = (data[links[0]].matrix_local.to_3x3().col[i] for i in (0, 2))
    found = math.atan2(-x.dot(side), z.dot(side))
    if (x * math.cos(found) + z * math.sin(found)).dot(wanted) < 0:
        found += math.pi
    return as_float32(math.remainder(found, 2.0 * math.pi))


# ------------------------------------------------------------------------------------------------- to and from a constraint

def apply_constraint(rig, name, bone, settings, helpers, is_muted):
    """bone: the one whose tail is the tip; helpers: 'target' and 'pole' -> the control made for it."""
    constraint = rig.pose.bones[bone].constraints.new('IK')
    constraint.name, constraint.mute = name, is_muted
    constraint.chain_count = len(settings['joints']) + is_helper(rig.pose.bones[bone])
    for key in ('iterations', 'influence', 'weight', 'use_location', 'use_rotation', 'orient_weight', 'use_stretch'):
        setattr(constraint, key, settings[key])
    constraint.target, constraint.subtarget = rig, settings['target'] or helpers['target']
    pole = settings['pole'] or helpers.get('pole')
    if pole:
        constraint.pole_target, constraint.pole_subtarget, constraint.pole_angle = rig, pole, settings['pole_angle']
    return constraint


def chain_joints(bone, constraint):
    """The names of a chain's bones from its start to the last one that turns; empty if it has none."""
    bone, names, count = (bone if constraint.use_tail else bone.parent), [], constraint.chain_count
    while bone and (count == 0 or len(names) < count):
        names.insert(0, bone.name)
        bone = bone.parent
    return names[:-1] if names and is_helper(constraint.id_data.pose.bones[names[-1]]) else names


def chain_tip(bone, constraint):
    """In the space of the last bone that turns: its tail, or that of the bone that an import has made for the tip."""
    bone = bone if constraint.use_tail else bone.parent
    if not is_helper(bone):
        return [0.0, bone.bone.length, 0.0]
    return list(bone.parent.bone.matrix_local.inverted() @ bone.bone.tail_local)


def is_as_set(rig, bone, constraint, settings):
    """Whether an IK constraint is still as the import set it."""
    if chain_joints(bone, constraint) != settings['joints'] or not is_near(chain_tip(bone, constraint), settings['tip']):
        return False
    for key in ('iterations', 'influence', 'weight', 'use_location', 'use_rotation', 'orient_weight', 'use_stretch'):
        if getattr(constraint, key) != settings[key]:
            return False
    has_pole = settings['pole_place'] is not None
    if bool(constraint.pole_target) != has_pole:
        return False
    if has_pole and abs(math.remainder(constraint.pole_angle - settings['pole_angle'], 2.0 * math.pi)) > 1e-3:
        return False
    return (is_control(rig, constraint.target, constraint.subtarget, settings['target'])
            and (not has_pole or is_control(rig, constraint.pole_target, constraint.pole_subtarget, settings['pole'])))


def is_near(a, b):
    return (Vector(a) - Vector(b)).length <= TOLERANCE + ALONG_BONE * Vector(b).length


def is_control(rig, obj, name, wanted):
    """Whether a constraint's target is the bone that the record names, or the import's own control if it names none."""
    if obj != rig or name not in rig.pose.bones:
        return False
    return name == wanted if wanted else is_helper(rig.pose.bones[name])
