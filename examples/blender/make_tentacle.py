"""The tentacle: a tapered tube with suckers on a chain of ten soft-skinned joints.

blender -b -t 1 --factory-startup --python-exit-code 1 --python make_tentacle.py -- OUT.glb [OUT.blend]
"""
import math
import os
import sys

import bpy
from mathutils import Euler, Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from export_glb import export_glb
from meshkit import MeshBuilder, Section, chain_weights, material, texture
from rigkit import add_ik, begin_clip, empty_scene, end_clip, limit_ik, limit_rotation, make_armature, rest, script_arguments

JOINTS = 10
LENGTH = 2.0                        # metres along the curve
BASE_RADIUS, TIP_RADIUS = 0.22, 0.03
# The rest pose is bent towards the pole, because a chain that is straight at rest stays straight in Blender's IK with a pole.
REST_BEND = math.radians(40)
LAST_FRAME = 60
SIDE = Vector((1, 0, 0))
POLE_SIDE = (0, -1, 0)              # bone Z turns here, so that a positive turn about X bends away from it

SEGMENT = LENGTH / JOINTS
SKIN, SUCKER = 0, 1                 # material slots


def segment(i):
    return f'seg_{i:02d}'


def curve(t):
    """The centre line at t, 0 to 1: an arc in the YZ plane. Returns (point, unit tangent)."""
    angle, radius = (0.5 - t) * REST_BEND, LENGTH / REST_BEND
    point = Vector((0, -radius * (math.cos(angle) - math.cos(REST_BEND / 2)), radius * (math.sin(REST_BEND / 2) - math.sin(angle))))
    return point, Vector((0, -math.sin(angle), math.cos(angle)))


def radius(t):
    return BASE_RADIUS + (TIP_RADIUS - BASE_RADIUS) * t ** 0.8


def weights(t):
    """Blends as wide as a segment is long, so that up to three joints pull a vertex."""
    return chain_weights([(segment(i), i * SEGMENT, 0.9 * SEGMENT) for i in range(JOINTS)], t * LENGTH)


def make_rig():
    bones = [dict(name='root', head=(0, 0, -0.15), tail=(0, 0, 0), z_axis=POLE_SIDE, deform=False)]
    for i in range(JOINTS):
        bones.append(dict(name=segment(i), head=curve(i / JOINTS)[0], tail=curve((i + 1) / JOINTS)[0],
                          parent=segment(i - 1) if i else 'root', connect=i > 0, z_axis=POLE_SIDE))
    bones.append(dict(name='ctl_target', head=(0.5, 0.1, 1.5), tail=(0.5, 0.1, 1.7), parent='root', z_axis=POLE_SIDE, deform=False))
    bones.append(dict(name='ctl_pole', head=(0, -2, 0.9), tail=(0, -2, 1.1), parent='root', z_axis=POLE_SIDE, deform=False))
    rig = make_armature('TentacleRig', bones)

    for i in range(JOINTS):
        t = i / (JOINTS - 1)
        bend = 15 + 20 * t                              # the base is stiffer than the tip
        limits = dict(x=(-bend, bend), y=(-8, 8), z=(-bend, bend))
        bone = rig.pose.bones[segment(i)]
        limit_rotation(bone, limits, 'XYZ')
        limit_ik(bone, limits, stiffness=(0.3 * (1 - t), 0.8, 0.3 * (1 - t)), locked='y' if i == 0 else '')
    rig.pose.bones[segment(0)].lock_rotation = (False, True, False)
    add_ik(rig, segment(JOINTS - 1), 'IK_tip', 'ctl_target', 'ctl_pole', pole_angle=90, length=JOINTS - 1, iterations=200)
    return rig


def make_skin(rig):
    mesh = MeshBuilder()
    rings = 40
    sections = [Section(curve(0)[0], SIDE, Vector((0, 1, 0)), 0, 0, 0, weights(0))]
    for r in range(rings + 1):
        t = r / rings
        point, tangent = curve(t)
        sections.append(Section(point, SIDE, tangent.cross(SIDE), radius(t), radius(t), radius(t), weights(t)))
    point, tangent = curve(1)
    sections.append(Section(point + tangent * TIP_RADIUS * 0.6, SIDE, tangent.cross(SIDE), 0, 0, 0, weights(1)))
    mesh.tube(sections, 16, SKIN)

    for k in range(13):                                 # two rows of suckers down the front
        t = 0.08 + 0.86 * k / 12
        for across in (-0.55, 0.55):
            add_sucker(mesh, t, across)

    def bands(x, y):
        wave = 0.5 + 0.5 * math.sin(2 * math.pi * (y / 8 + 0.15 * math.sin(2 * math.pi * x / 16)))
        return tuple(a + (b - a) * wave for a, b in zip((0.50, 0.13, 0.32), (0.80, 0.32, 0.42)))

    skin = material('TentacleSkin', roughness=0.45, image=texture('tentacle_base', 64, 64, bands))
    return mesh.build('Tentacle', rig, [skin, material('Sucker', (0.85, 0.62, 0.55), roughness=0.35)])


def add_sucker(mesh, t, across):
    """A cup on the skin at t along the tentacle, turned by the angle across (radians) from the middle of its front."""
    point, tangent = curve(t)
    front = -tangent.cross(SIDE)
    outward = front * math.cos(across) + SIDE * math.sin(across)
    around = outward.cross(tangent)
    size = 0.26 * radius(t) + 0.004
    sections = []
    for height, width in ((-0.3, 0.0), (0.0, 0.85), (0.25, 1.0), (0.42, 0.8), (0.2, 0.35), (0.12, 0.0)):    # of the cup's outline
        center = point + outward * (radius(t) * 0.97 + size * height)
        sections.append(Section(center, tangent, around * -1, size * width, size * width, size * width, weights(t)))
    mesh.tube(sections, 8, SUCKER)


def animate(rig):
    """Wave: forward kinematics. Reach: only the IK target moves; the exporter bakes the chain."""
    ik = rig.pose.bones[segment(JOINTS - 1)].constraints['IK_tip']

    def key_influence(value, frame):
        ik.influence = value
        ik.keyframe_insert('influence', frame=frame)

    begin_clip(rig, 'Wave')
    for frame in range(0, LAST_FRAME + 1, 3):
        phase = 2 * math.pi * frame / LAST_FRAME
        key_influence(0.0, frame)
        for i in range(JOINTS):
            t = i / (JOINTS - 1)
            bone = rig.pose.bones[segment(i)]
            bend, twist, lean = (6 + 18 * t) * math.sin(phase - 2.2 * math.pi * t), 3 * math.sin(phase + t), 5 * t * math.cos(phase)
            bone.rotation_quaternion = Euler((math.radians(bend), math.radians(twist if i else 0), math.radians(lean))).to_quaternion()
            bone.keyframe_insert('rotation_quaternion', frame=frame)
    end_clip(rig)
    rest(rig)

    begin_clip(rig, 'Reach')
    target = rig.pose.bones['ctl_target']
    for frame in range(0, LAST_FRAME + 1, 6):
        phase = 2 * math.pi * frame / LAST_FRAME
        key_influence(1.0, frame)
        target.location = (0.35 * math.cos(phase), 0.3 * math.sin(2 * phase), 0.35 * math.sin(phase))
        target.keyframe_insert('location', frame=frame)
    end_clip(rig)
    rest(rig)
    ik.influence = 1.0


def main():
    out, *blend = script_arguments()
    empty_scene(LAST_FRAME)
    rig = make_rig()
    make_skin(rig)
    animate(rig)
    if blend:
        bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(blend[0]))
    export_glb(os.path.abspath(out))


main()
