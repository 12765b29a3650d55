"""Poses bones in Blender and reads what Blender makes of them."""
import json
import math
import os
import struct
import sys

import bpy
from mathutils import Quaternion, Vector

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, '..', '..')
sys.dont_write_bytecode = True
sys.path[:0] = [HERE, os.path.join(ROOT, 'bindings', 'blender'), os.path.join(ROOT, 'examples', 'blender')]
TOLERANCE = 1e-4                    # radians


def arguments():
    return sys.argv[sys.argv.index('--') + 1:]


def check(condition, message):
    if not condition:
        raise AssertionError(message)


def read_glb(path):
    with open(path, 'rb') as file:
        length = struct.unpack('<5I', file.read(20))[3]
        return json.loads(file.read(length))


def joint_records(path):
    """Joint name -> extras.rig_joint of a .glb file."""
    return {node['name']: node['extras']['rig_joint'] for node in read_glb(path)['nodes'] if 'rig_joint' in node.get('extras', {})}


def only_armature():
    rigs = [obj for obj in bpy.context.scene.objects if obj.type == 'ARMATURE']
    check(len(rigs) == 1, f'{len(rigs)} armatures')
    return rigs[0]


def stop_animation(rig):
    """Clips must not move what the test sets."""
    rig.animation_data_clear()


def evaluated(rig):
    bpy.context.view_layer.update()
    return rig.evaluated_get(bpy.context.evaluated_depsgraph_get())


def local_rotation(rig, name):
    """x y z w relative to the rest pose and to the parent's pose; of an evaluated rig."""
    bone = rig.pose.bones[name]
    rest = bone.bone.matrix_local
    if bone.parent:
        rest = bone.parent.matrix @ bone.parent.bone.matrix_local.inverted() @ rest
    return xyzw((rest.inverted() @ bone.matrix).to_quaternion())


def xyzw(q):
    length = math.sqrt(q.x ** 2 + q.y ** 2 + q.z ** 2 + q.w ** 2)
    return (q.x / length, q.y / length, q.z / length, q.w / length)


def blender_quaternion(q):
    return Quaternion((q[3], q[0], q[1], q[2]))


def set_rotation(bone, q):
    """q: x y z w. Returns it as Blender keeps it, in 32 bits."""
    bone.rotation_mode = 'QUATERNION'
    bone.rotation_quaternion = blender_quaternion(q)
    return xyzw(bone.rotation_quaternion)


def random_rotation(random, largest=math.pi):
    """About a random axis by up to largest."""
    axis = Vector([random.gauss(0, 1) for _ in range(3)]).normalized()
    half = random.uniform(-largest, largest) / 2
    return (*(axis * math.sin(half)), math.cos(half))


def mute_all(rig, but):
    """Mutes the constraints of all kinds but one."""
    for bone in rig.pose.bones:
        for constraint in bone.constraints:
            constraint.mute = constraint.type != but


def one_bone_rig(z_axis=(0.3, -1, 0.2), tail=(0.2, 0.1, 1.0)):
    """An armature in an empty scene: base, bone b on it, and t, which hangs on nothing and serves as a target."""
    from rigkit import empty_scene, make_armature
    empty_scene(1)
    rig = make_armature('Rig', [dict(name='base', head=(0, 0, -1), tail=(0, 0, 0), z_axis=(0, -1, 0)),
                                dict(name='b', head=(0, 0, 0), tail=tail, parent='base', connect=True, z_axis=z_axis),
                                dict(name='t', head=tail, tail=Vector(tail) + Vector((0, 0, 0.2)), z_axis=(0, -1, 0))])
    return rig, rig.pose.bones['b']


def move_target(rig, name, matrix):
    """matrix: in the armature's space."""
    rig.pose.bones[name].matrix = matrix
    bpy.context.view_layer.update()
