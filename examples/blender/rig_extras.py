"""Writes a Blender rig's joint limits and IK chains into the extras of a glTF file.

Blender's glTF exporter drops constraints. It calls glTF2ExportUserExtension of every enabled add-on, and this is one.

node.extras["rig_joint"], on a joint:
  rest_orientation  quaternion x y z w, model space: the rest orientation that the limits were written against
  length            metres, along the joint's Y
  euler_limits      list, from Limit Rotation: space, order, and x, y, z -> [low, high]
  swing_twist       from the pose bone's IK limits: swing_x, twist_y, swing_z -> [low, high]; the IK solver's only
  stiffness         x, y, z, each 0 to 1; the IK solver's only
  locks             rotation, location, scale -> three booleans
node.extras["rig_ik"], on the armature's node: the chains, joints and targets by name.

Angles are radians. Rotations are inverse(rest) * current in the node's axes, which are Blender's bone axes: Y from head to
tail. Only a root joint carries the turn from Z up to Y up, inside its rest rotation. Order "XYZ" means Rz * Ry * Rx.
A swing is a vector axis * sin(angle / 2) inside an ellipse with the half axes sin(limit / 2), one per quadrant.
"""
import math

import bpy
from mathutils import Matrix, Quaternion

bl_info = {'name': 'Rig limits and IK chains in glTF extras', 'version': (1, 0, 0), 'blender': (3, 4, 0), 'category': 'Import-Export'}

Y_UP = Matrix.Rotation(-math.pi / 2, 4, 'X')
SPACES = {'LOCAL': 'rest', 'LOCAL_WITH_PARENT': 'rest_with_parent', 'POSE': 'armature', 'WORLD': 'world'}


def rounded(value):
    return round(float(value), 6) + 0.0


def joint_record(pose_bone):
    """What is known about a joint's freedom, or None when nothing limits it."""
    record = {}
    limits = [euler_limit(c, pose_bone) for c in pose_bone.constraints if c.type == 'LIMIT_ROTATION' and not c.mute and c.influence]
    if limits:
        record['euler_limits'] = limits
    swing_twist = {}
    for axis, name in zip('xyz', ('swing_x', 'twist_y', 'swing_z')):
        if getattr(pose_bone, f'lock_ik_{axis}'):
            swing_twist[name] = [0.0, 0.0]
        elif getattr(pose_bone, f'use_ik_limit_{axis}'):
            swing_twist[name] = [rounded(getattr(pose_bone, f'ik_min_{axis}')), rounded(getattr(pose_bone, f'ik_max_{axis}'))]
    if swing_twist:
        record['swing_twist'] = swing_twist
    stiffness = [rounded(getattr(pose_bone, f'ik_stiffness_{axis}')) for axis in 'xyz']
    if any(stiffness):
        record['stiffness'] = stiffness
    locks = {kind: [bool(v) for v in getattr(pose_bone, f'lock_{kind}')] for kind in ('rotation', 'location', 'scale')}
    locks = {kind: values for kind, values in locks.items() if any(values)}
    if locks:
        record['locks'] = locks
    if not record:
        return None
    q: Quaternion = (Y_UP @ pose_bone.bone.matrix_local).to_quaternion()
    return {'rest_orientation': [rounded(v) for v in (q.x, q.y, q.z, q.w)], 'length': rounded(pose_bone.bone.length), **record}


def euler_limit(constraint, pose_bone):
    """A Limit Rotation constraint as a record; limits about the world's axes are turned to Y up."""
    ranges = {axis: [rounded(getattr(constraint, f'min_{axis}')), rounded(getattr(constraint, f'max_{axis}'))]
              for axis in 'xyz' if getattr(constraint, f'use_limit_{axis}')}
    order = constraint.euler_order
    if order == 'AUTO':
        order = pose_bone.rotation_mode if pose_bone.rotation_mode not in ('QUATERNION', 'AXIS_ANGLE') else 'XYZ'
    space = SPACES.get(constraint.owner_space, 'custom')
    if space in ('armature', 'world'):
        turned = {'x': ranges.get('x'), 'y': ranges.get('z'), 'z': ranges.get('y') and [-ranges['y'][1], -ranges['y'][0]]}
        ranges = {axis: r for axis, r in turned.items() if r}
        order = order.translate(str.maketrans('YZ', 'ZY'))
    record = {'space': space, 'order': order, **ranges}
    if constraint.influence != 1.0:
        record['influence'] = rounded(constraint.influence)
    return record


def ik_record(pose_bone, constraint):
    """An IK constraint as a chain, its joints from the start to the one whose tail is the effector."""
    bone, names = (pose_bone if constraint.use_tail else pose_bone.parent), []
    while bone and (constraint.chain_count == 0 or len(names) < constraint.chain_count):
        names.insert(0, bone.name)
        bone = bone.parent
    rig = pose_bone.id_data
    tip = rig.pose.bones[names[-1]]
    record = {
        'name': constraint.name,
        'joints': names,
        'effector_offset': [0.0, rounded(tip.bone.length), 0.0],
        'solver': 'blender_' + rig.pose.ik_solver.lower(),
        'iterations': constraint.iterations,
        'influence': rounded(constraint.influence),
        'weight': rounded(constraint.weight),
        'position': constraint.use_location,
        'rotation': constraint.use_rotation,
        'stretch': constraint.use_stretch,
    }
    if constraint.target:
        record['target'] = control_record(rig, constraint.target, constraint.subtarget)
    if constraint.pole_target:
        angle = constraint.pole_angle       # the axis of the first joint that is turned to the pole
        record['pole'] = {**control_record(rig, constraint.pole_target, constraint.pole_subtarget), 'angle': rounded(angle),
                          'axis': [rounded(math.cos(angle)), 0.0, rounded(math.sin(angle))]}
    return record


def control_record(rig, obj, bone):
    """A target or pole: its object, its joint if it is one, its rest position in the space of the rig's node."""
    record, position = {'object': obj.name}, obj.matrix_world.translation
    if obj.type == 'ARMATURE' and bone:
        record['joint'] = bone
        position = obj.matrix_world @ obj.data.bones[bone].head_local
    position = Y_UP @ (rig.matrix_world.inverted() @ position)
    record['position'] = [rounded(v) for v in position]
    return record


class glTF2ExportUserExtension:
    """The exporter's hooks; the names are the exporter's."""

    def gather_joint_hook(self, node, blender_bone, export_settings):
        record = joint_record(blender_bone)
        if record:
            node.extras = {**(node.extras or {}), 'rig_joint': record}

    def gather_node_hook(self, node, blender_object, export_settings):
        if not blender_object or blender_object.type != 'ARMATURE':
            return
        chains = [ik_record(bone, c) for bone in blender_object.pose.bones for c in bone.constraints if c.type == 'IK' and not c.mute]
        if chains:
            node.extras = {**(node.extras or {}), 'rig_ik': {'up': '+Y', 'order_rule': 'XYZ means Rz*Ry*Rx', 'chains': chains}}


def register():
    """Nothing to register: the exporter finds the class by its name."""


def unregister():
    """Nothing to undo."""
