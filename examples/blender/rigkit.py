"""Armatures, joint constraints, IK chains and clips for the example characters.

Space: Blender's world, metres, Z up; angles are degrees where a parameter says so, else radians.
"""
import math
import sys

import bpy
from mathutils import Matrix, Vector


def script_arguments():
    """The arguments after "--" on Blender's command line."""
    return sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else []


def empty_scene(last_frame, frames_per_second=30):
    """An empty scene. Clips begin at frame 0, so that they begin at time 0 in the glTF file."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = frames_per_second
    scene.frame_start, scene.frame_end = 0, last_frame
    scene.unit_settings.system = 'METRIC'


def make_armature(name, bones):
    """bones: dicts of name, head, tail, z_axis (what bone Z turns to); optional parent, connect, deform."""
    armature = bpy.data.armatures.new(name)
    rig = bpy.data.objects.new(name, armature)
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode='EDIT')
    for b in bones:
        bone = armature.edit_bones.new(b['name'])
        bone.head, bone.tail = Vector(b['head']), Vector(b['tail'])
        if b.get('parent'):
            bone.parent = armature.edit_bones[b['parent']]
            bone.use_connect = b.get('connect', False)
        bone.align_roll(Vector(b['z_axis']))
        bone.use_deform = b.get('deform', True)
    bpy.ops.object.mode_set(mode='OBJECT')
    rig.animation_data_create()
    return rig


def limit_rotation(pose_bone, limits, order):
    """A Limit Rotation constraint in the bone's own space. limits: axis x, y, z -> (low, high), degrees."""
    c = pose_bone.constraints.new('LIMIT_ROTATION')
    c.owner_space, c.euler_order, c.use_transform_limit = 'LOCAL', order, False
    for axis, (low, high) in limits.items():
        setattr(c, f'use_limit_{axis}', True)
        setattr(c, f'min_{axis}', math.radians(low))
        setattr(c, f'max_{axis}', math.radians(high))


def limit_ik(pose_bone, limits, stiffness=(0.0, 0.0, 0.0), locked=''):
    """The limits for Blender's IK solver. They must include 0, so ranges that do not are widened to it."""
    for axis, (low, high) in limits.items():
        setattr(pose_bone, f'use_ik_limit_{axis}', True)
        setattr(pose_bone, f'ik_min_{axis}', math.radians(min(low, 0)))
        setattr(pose_bone, f'ik_max_{axis}', math.radians(max(high, 0)))
    for axis, value in zip('xyz', stiffness):
        setattr(pose_bone, f'ik_stiffness_{axis}', value)
        setattr(pose_bone, f'lock_ik_{axis}', axis in locked)


def add_ik(rig, bone, name, target, pole, pole_angle, length, iterations):
    """An IK constraint: the tail of bone goes to the bone target; pole_angle in degrees, length in bones."""
    ik = rig.pose.bones[bone].constraints.new('IK')
    ik.name = name
    ik.target, ik.subtarget = rig, target
    ik.pole_target, ik.pole_subtarget, ik.pole_angle = rig, pole, math.radians(pole_angle)
    ik.chain_count, ik.iterations, ik.use_stretch = length, iterations, False
    return ik


def rest(rig):
    """Puts every bone into its rest pose."""
    for bone in rig.pose.bones:
        bone.matrix_basis = Matrix()


def begin_clip(rig, name, loop=True):
    """Starts an action on the rig; loop is kept as the glTF animation's extras."""
    action = bpy.data.actions.new(name)
    action['loop'] = loop
    rig.animation_data.action = action


def end_clip(owner):
    """Moves the action to an NLA track of its name: the exporter makes one glTF animation of all tracks with one name."""
    action = owner.animation_data.action
    track = owner.animation_data.nla_tracks.new()
    track.name = action.name
    track.strips.new(action.name, int(action.frame_range[0]), action)
    track.mute = True
    owner.animation_data.action = None


def shape_key(obj, name, moved):
    """A morph target. moved: vertex index -> new position, for the vertices that move."""
    if not obj.data.shape_keys:
        obj.shape_key_add(name='Basis', from_mix=False)
        obj.data.shape_keys.animation_data_create()
    key = obj.shape_key_add(name=name, from_mix=False)
    for i, position in moved.items():
        key.data[i].co = position


def shape_key_clip(obj, clip, tracks):
    """Animates morph weights as part of a clip. tracks: morph name -> rows (frame, weight)."""
    keys = obj.data.shape_keys
    action = bpy.data.actions.new(clip)
    keys.animation_data.action = action
    for name, rows in tracks.items():
        for frame, weight in rows:
            keys.key_blocks[name].value = weight
            keys.key_blocks[name].keyframe_insert('value', frame=frame)
        keys.key_blocks[name].value = 0.0
    end_clip(keys)
    keys.animation_data.nla_tracks[-1].name = clip
