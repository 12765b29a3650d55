"""IK constraints as the chains of extras["rig_ik"]; spec/rig.md says what the keys mean."""
import math

from .chain_settings import chain_tip, is_helper
from .kept_records import is_muted
from .shortest import shortest, shortest_list


def ik_constraints(rig):
    """(pose bone, constraint) of each IK constraint that is not muted."""
    return [(bone, c) for bone in rig.pose.bones for c in bone.constraints if c.type == 'IK' and not is_muted(bone, c)]


def chain_record(name, joints, bone, constraint, axes, has_node):
    """has_node: the rig has a node of its own, and positions are in its space; otherwise they are in the file's space."""
    rig = bone.id_data
    record = {
        'name': name,
        'joints': joints,
        'effector_offset': shortest_list(chain_tip(bone, constraint)),
        'solver': 'blender_' + rig.pose.ik_solver.lower(),
        'iterations': constraint.iterations,
        'influence': shortest(constraint.influence),
        'weight': shortest(constraint.weight),
        'position': constraint.use_location,
        'rotation': constraint.use_rotation,
        'stretch': constraint.use_stretch,
    }
    if constraint.use_rotation:
        record['orientation_weight'] = shortest(constraint.orient_weight)
    to_space = axes.matrix @ rig.matrix_world.inverted_safe() if has_node else axes.matrix
    if constraint.target and not is_import_helper(constraint.target, constraint.subtarget):
        record['target'] = control_record(to_space, constraint.target, constraint.subtarget)
    if constraint.pole_target:
        angle = constraint.pole_angle       # the axis of the first joint that turns towards the pole
        record['pole'] = {**control_record(to_space, constraint.pole_target, constraint.pole_subtarget), 'angle': shortest(angle),
                          'axis': shortest_list((math.cos(angle), 0.0, math.sin(angle)))}
    return record


def control_record(to_space, obj, subtarget):
    """A target or pole: its object, its joint if it is a joint, its rest position."""
    record, position = {'object': obj.name}, obj.matrix_world.translation
    if is_joint(obj, subtarget):
        if not is_import_helper(obj, subtarget):
            record['joint'] = subtarget
        position = obj.matrix_world @ obj.data.bones[subtarget].head_local
    record['position'] = shortest_list(to_space @ position)
    return record


def is_joint(obj, subtarget):
    return obj.type == 'ARMATURE' and subtarget in obj.data.bones


def is_import_helper(obj, subtarget):
    """A control that an import made, and that is not in the file."""
    return is_joint(obj, subtarget) and is_helper(obj.pose.bones[subtarget])
