"""The mannequin: an artist's wooden figure with 54 Mixamo-named joints, 8 controls, a face that blinks and smiles, Idle and Walk.

blender -b -t 1 --factory-startup --python-exit-code 1 --python make_mannequin.py -- OUT.glb [OUT.blend]

The figure faces -Y, which is +Z in the glTF file, and its left is at +X. It is built on its left side and mirrored.
"""
import math
import os
import sys

import bpy
from mathutils import Matrix, Quaternion, Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from export_glb import export_glb
from meshkit import MeshBuilder, chain_weights, interpolate, material, other_side, smoothstep, texture
from rigkit import (add_ik, begin_clip, empty_scene, end_clip, limit_ik, limit_rotation, make_armature, rest, script_arguments,
                    shape_key, shape_key_clip)

PREFIX = 'mixamorig:'
FORWARD, BACK, UP, DOWN = (0, -1, 0), (0, 1, 0), (0, 0, 1), (0, 0, -1)
SIDES = ('Left', 'Right')
FINGERS = {'Index': (-0.030, 0.785, (0.040, 0.026, 0.022)), 'Middle': (-0.010, 0.790, (0.044, 0.029, 0.023)),      # y, x, lengths
           'Ring': (0.011, 0.786, (0.041, 0.027, 0.022)), 'Pinky': (0.031, 0.775, (0.032, 0.021, 0.019))}
THUMB_START, THUMB_AXIS, THUMB_LENGTHS = Vector((0.715, -0.022, 1.422)), Vector((0.72, -0.69, -0.05)).normalized(), (0.042, 0.030, 0.024)
WOOD, DARK_WOOD, EYE, IRIS, MOUTH = range(5)        # material slots
IDLE_FRAMES, WALK_FRAMES = 90, 30


def full(joint):
    return joint if joint.startswith('ctl_') else PREFIX + joint


# ---------------------------------------------------------------------------------------------------------- joints

def joints():
    """Rows (name, head, tail, parent, where bone Z turns): the middle, then the left side. Bone X is the axis of flexion."""
    rows = [
        ('Hips', (0, 0, 0.97), (0, 0, 1.07), None, FORWARD),
        ('Spine', (0, 0, 1.07), (0, 0, 1.19), 'Hips', FORWARD),
        ('Spine1', (0, 0, 1.19), (0, 0, 1.32), 'Spine', FORWARD),
        ('Spine2', (0, 0, 1.32), (0, 0, 1.47), 'Spine1', FORWARD),
        ('Neck', (0, 0, 1.47), (0, -0.01, 1.56), 'Spine2', FORWARD),
        ('Head', (0, -0.01, 1.56), (0, -0.01, 1.78), 'Neck', FORWARD),
        ('LeftEye', tuple(EYE_CENTER), tuple(EYE_CENTER + Vector((0, -0.04, 0))), 'Head', UP),
        ('LeftShoulder', (0.03, 0, 1.43), (0.175, 0.005, 1.43), 'Spine2', FORWARD),
        ('LeftArm', (0.175, 0.005, 1.43), (0.44, 0.015, 1.43), 'LeftShoulder', FORWARD),
        ('LeftForeArm', (0.44, 0.015, 1.43), (0.69, 0.005, 1.43), 'LeftArm', FORWARD),
        ('LeftHand', (0.69, 0.005, 1.43), (0.77, 0.003, 1.43), 'LeftForeArm', DOWN),
        ('LeftUpLeg', (0.095, 0, 0.93), (0.098, -0.012, 0.51), 'Hips', BACK),
        ('LeftLeg', (0.098, -0.012, 0.51), (0.100, 0.018, 0.09), 'LeftUpLeg', BACK),
        ('LeftFoot', (0.100, 0.018, 0.09), (0.105, -0.105, 0.030), 'LeftLeg', UP),
        ('LeftToeBase', (0.105, -0.105, 0.030), (0.107, -0.185, 0.026), 'LeftFoot', UP),
    ]
    for finger, (y, x, lengths) in FINGERS.items():
        rows += digit(finger, Vector((x, y, 1.43)), Vector((1, 0, 0)), lengths, DOWN)
    return rows + digit('Thumb', THUMB_START, THUMB_AXIS, THUMB_LENGTHS, (0.69, 0.72, 0))


def digit(finger, start, axis, lengths, z_axis):
    rows, parent = [], 'LeftHand'
    for k, length in enumerate(lengths):
        name, end = f'LeftHand{finger}{k + 1}', start + axis * length
        rows.append((name, tuple(start), tuple(end), parent, z_axis))
        start, parent = end, name
    return rows


def controls():
    """IK targets and poles of the left side, in the same rows."""
    return [
        ('ctl_LeftFoot', (0.100, 0.018, 0.09), (0.105, -0.105, 0.030), None, UP),
        ('ctl_LeftKnee', (0.1, -0.7, 0.5), (0.1, -0.7, 0.6), None, FORWARD),
        ('ctl_LeftHand', (0.69, 0.005, 1.43), (0.77, 0.003, 1.43), None, DOWN),
        ('ctl_LeftElbow', (0.44, 0.6, 1.43), (0.44, 0.6, 1.53), None, FORWARD),
    ]


def make_rig():
    rows = joints() + controls()
    flip = lambda v: (-v[0], v[1], v[2])
    rows += [(other_side(name), flip(head), flip(tail), parent and other_side(parent), flip(z))
             for name, head, tail, parent, z in rows if 'Left' in name]
    rig = make_armature('Mannequin', [dict(name=full(name), head=head, tail=tail, parent=parent and full(parent), z_axis=z,
                                           deform=not name.startswith('ctl_')) for name, head, tail, parent, z in rows])
    limit_joints(rig)
    for side in SIDES:
        add_ik(rig, full(side + 'Leg'), f'IK_{side}Leg', f'ctl_{side}Foot', f'ctl_{side}Knee', pole_angle=-90, length=2, iterations=50)
        turn = rig.pose.bones[full(side + 'Foot')].constraints.new('COPY_ROTATION')
        turn.target, turn.subtarget = rig, f'ctl_{side}Foot'
        rig.pose.bones[full(side + 'Foot')].constraints.move(1, 0)       # the limit comes after it
        arm = add_ik(rig, full(side + 'ForeArm'), f'IK_{side}Arm', f'ctl_{side}Hand', f'ctl_{side}Elbow', pole_angle=-90, length=2,
                     iterations=50)
        arm.influence = 0.0                                              # for a runtime to use; the clips move the arms themselves
    return rig


def limit_joints(rig):
    """Degrees about the bone's own axes; bone Z is mirrored between the sides."""
    def limit(joint, x, y, z, hinge=False, stiffness=(0.0, 0.0, 0.0)):
        for name in {joint, other_side(joint)}:
            limits = dict(x=x, y=y, z=z if 'Right' not in name else (-z[1], -z[0]))
            limit_rotation(rig.pose.bones[full(name)], limits, 'XYZ' if hinge else 'YXZ')
            limit_ik(rig.pose.bones[full(name)], limits, stiffness, locked='yz' if hinge else '')

    for joint in ('Spine', 'Spine1', 'Spine2'):
        limit(joint, (-15, 25), (-15, 15), (-12, 12), stiffness=(0.5, 0.5, 0.5))
    limit('Neck', (-25, 30), (-35, 35), (-20, 20))
    limit('Head', (-25, 25), (-35, 35), (-20, 20))
    limit('LeftEye', (-30, 30), (0, 0), (-40, 40))
    limit('LeftShoulder', (-15, 15), (-5, 5), (-10, 30))
    limit('LeftArm', (-45, 130), (-90, 90), (-90, 90))
    limit('LeftForeArm', (0, 150), (-90, 90), (0, 0))
    limit('LeftHand', (-70, 80), (-10, 10), (-20, 35))
    limit('LeftUpLeg', (-120, 30), (-45, 45), (-45, 30))
    limit('LeftLeg', (0, 145), (0, 0), (0, 0), hinge=True)
    limit('LeftFoot', (-50, 20), (-15, 15), (-20, 30))
    limit('LeftToeBase', (-40, 70), (0, 0), (0, 0), hinge=True)
    for finger in FINGERS:
        limit(f'LeftHand{finger}1', (-20, 90), (0, 0), (-15, 15))
        limit(f'LeftHand{finger}2', (0, 100), (0, 0), (0, 0), hinge=True)
        limit(f'LeftHand{finger}3', (0, 80), (0, 0), (0, 0), hinge=True)


# ---------------------------------------------------------------------------------------------------------- body

TORSO_BOTTOM = 0.84


def torso_weights(position):
    """The spine by height; above the chest, the shoulders pull what is beside the neck."""
    z = position.z
    chain = [('Hips', 0, 0), ('Spine', 1.07, 0.06), ('Spine1', 1.19, 0.06), ('Spine2', 1.32, 0.06), ('Neck', 1.48, 0.03)]
    weights = chain_weights([(full(joint), start, half) for joint, start, half in chain], z)
    pull = 0.7 * smoothstep(0.06, 0.16, abs(position.x)) * smoothstep(1.33, 1.43, z)
    if pull > 0.0:
        weights = {joint: w * (1 - pull) for joint, w in weights.items()}
        weights[full('LeftShoulder' if position.x > 0 else 'RightShoulder')] = pull
    return weights


def make_body(rig, wood):
    left = MeshBuilder()
    chain = lambda *rows: [(full(joint), start, half) for joint, start, half in rows]
    left.limb([(0.095, 0, 1.0), (0.095, 0, 0.93), (0.098, -0.012, 0.51), (0.100, 0.018, 0.09), (0.100, 0.018, 0.04)], (1, 0, 0), FORWARD,
              [(0, 0.080, 0.080, 0.080), (0.08, 0.087, 0.086, 0.095), (0.20, 0.078, 0.083, 0.083), (0.38, 0.058, 0.062, 0.058),
               (0.49, 0.052, 0.060, 0.050), (0.57, 0.050, 0.050, 0.060), (0.67, 0.050, 0.045, 0.066), (0.80, 0.037, 0.038, 0.045),
               (0.90, 0.033, 0.036, 0.038), (0.96, 0.030, 0.032, 0.034)],
              chain(('Hips', 0, 0), ('LeftUpLeg', 0.07, 0.05), ('LeftLeg', 0.49, 0.055), ('LeftFoot', 0.91, 0.03)), (0.07, 0.03), 17, 16)
    left.limb([(0.100, 0.062, 0.032), (0.105, -0.105, 0.030), (0.107, -0.200, 0.022)], (1, 0, 0), UP,
              [(0, 0.028, 0.030, 0.032), (0.05, 0.036, 0.062, 0.031), (0.09, 0.038, 0.056, 0.030), (0.15, 0.045, 0.034, 0.030),
               (0.20, 0.046, 0.024, 0.026), (0.262, 0.036, 0.014, 0.022)],
              chain(('LeftFoot', 0, 0), ('LeftToeBase', 0.167, 0.02)), (0.03, 0.03), 9, 12)
    left.limb([(0.113, 0.003, 1.43), (0.175, 0.005, 1.43), (0.44, 0.015, 1.43), (0.69, 0.005, 1.43), (0.72, 0.005, 1.43)], BACK, UP,
              [(0, 0.056, 0.056, 0.056), (0.062, 0.056, 0.056, 0.056), (0.13, 0.050, 0.051, 0.051), (0.22, 0.044, 0.046, 0.046),
               (0.327, 0.039, 0.040, 0.040), (0.39, 0.042, 0.041, 0.041), (0.50, 0.034, 0.031, 0.031), (0.577, 0.027, 0.022, 0.022),
               (0.605, 0.025, 0.020, 0.020)],
              chain(('LeftShoulder', 0, 0), ('LeftArm', 0.035, 0.03), ('LeftForeArm', 0.327, 0.045), ('LeftHand', 0.577, 0.025)),
              (0.062, 0.02), 17, 12)
    left.limb([(0.690, 0.004, 1.43), (0.800, 0.001, 1.43)], BACK, UP,
              [(0, 0.024, 0.020, 0.020), (0.03, 0.036, 0.017, 0.019), (0.07, 0.043, 0.014, 0.016), (0.11, 0.041, 0.012, 0.013)],
              lambda d: {full('LeftHand'): 1.0}, (0.02, 0.02), 4, 12)
    for finger, (y, x, lengths) in FINGERS.items():
        add_digit(left, finger, Vector((x, y, 1.43)), Vector((1, 0, 0)), lengths, 0.0095)
    add_digit(left, 'Thumb', THUMB_START, THUMB_AXIS, THUMB_LENGTHS, 0.0115)
    left.mirror()

    body = MeshBuilder()
    bottom = TORSO_BOTTOM
    torso = body.limb([(0, 0, bottom), (0, 0, 1.53)], (1, 0, 0), BACK,
                      [(0, 0.105, 0.085, 0.075), (0.92 - bottom, 0.158, 0.108, 0.095), (0.98 - bottom, 0.160, 0.110, 0.098),
                       (1.07 - bottom, 0.138, 0.090, 0.092), (1.14 - bottom, 0.128, 0.082, 0.088), (1.25 - bottom, 0.146, 0.092, 0.102),
                       (1.35 - bottom, 0.165, 0.102, 0.112), (1.41 - bottom, 0.158, 0.096, 0.096), (1.46 - bottom, 0.122, 0.078, 0.072),
                       (1.50 - bottom, 0.055, 0.052, 0.048), (1.53 - bottom, 0.050, 0.048, 0.046)],
                      lambda d: {}, (0.06, 0.02), 20, 22)
    for i in torso:
        body.weights[i] = torso_weights(body.positions[i])
    body.limb([(0, 0.002, 1.44), (0, -0.008, 1.60)], (1, 0, 0), BACK,
              [(0, 0.050, 0.050, 0.050), (0.06, 0.049, 0.050, 0.048), (0.16, 0.047, 0.050, 0.046)],
              chain(('Spine2', 0, 0), ('Neck', 0.04, 0.03), ('Head', 0.125, 0.03)), (0.02, 0.02), 7, 14)
    body.append(left)
    return body.build('Body', rig, [wood])


def add_digit(mesh, finger, start, axis, lengths, radius):
    """A finger that begins inside the palm."""
    inside = 0.012
    ends = [inside + sum(lengths[:k]) for k in range(4)]
    rows = [('LeftHand', 0, 0)] + [(f'LeftHand{finger}{k + 1}', ends[k], 0.006) for k in range(3)]
    up = Vector(UP) - axis * axis.z
    mesh.limb([start - axis * inside, start + axis * sum(lengths)], up.cross(axis), up,
              [(0, radius, radius, radius), (ends[3] * 0.6, radius * 0.92, radius * 0.92, radius * 0.92),
               (ends[3], radius * 0.8, radius * 0.8, radius * 0.8)],
              [(full(joint), distance, half) for joint, distance, half in rows], (radius, radius), 6, 8)


# ---------------------------------------------------------------------------------------------------------- head

HEAD_BOTTOM = Vector((0, -0.005, 1.530))
HEAD_PROFILE = [(0, 0.040, 0.030, 0.060), (0.035, 0.054, 0.055, 0.086), (0.08, 0.066, 0.080, 0.096), (0.12, 0.074, 0.095, 0.098),
                (0.16, 0.078, 0.102, 0.097), (0.20, 0.078, 0.101, 0.094), (0.25, 0.072, 0.090, 0.085)]
EYE_CENTER, EYE_RADIUS, LID_RADIUS = Vector((0.031, -0.086, 1.655)), 0.0180, 0.0208
LID_COLUMNS, LID_ROWS = 10, 3
UPPER_LID_OPEN, UPPER_LID_SHUT, LOWER_LID = 28, -34, -36        # elevation of the edge, degrees


def on_face(x, z, above=0.003):
    """The point of the head's front at x, z, moved out by above metres."""
    side, _, front = interpolate(HEAD_PROFILE, z - HEAD_BOTTOM.z)
    return Vector((x, HEAD_BOTTOM.y - front * math.sqrt(max(0.0, 1 - (x / side) ** 2)) - above, z))


def lid_rows(edge, closed_end):
    """A shell over the left eye from the elevation edge to closed_end, both degrees."""
    low, high = min(edge, closed_end), max(edge, closed_end)
    rows = []
    for r in range(LID_ROWS + 1):
        elevation = math.radians(low + (high - low) * r / LID_ROWS)
        row = []
        for c in range(LID_COLUMNS + 1):
            turn = math.radians(-90 + 180 * c / LID_COLUMNS)
            direction = Vector((math.sin(turn), -math.cos(turn) * math.cos(elevation), math.cos(turn) * math.sin(elevation)))
            row.append(EYE_CENTER + LID_RADIUS * direction)
        rows.append(row)
    return rows


def strip_rows(center_z, half_width, half_height, columns, corner_x=1.0, corner_z=0.0, x=0.0):
    """Three rows that follow the face: a lens around (x, center_z), its ends raised by corner_z, its width scaled by corner_x."""
    rows = []
    for edge in (-1, 0, 1):
        row = []
        for c in range(columns + 1):
            t = 2 * c / columns - 1
            height = half_height * edge * (1 - t * t)
            row.append(on_face(x + half_width * corner_x * t, center_z + corner_z * t * t + height))
        rows.append(row)
    return rows


def mouth_rows(smile):
    """The mouth at rest (0) and in a smile (1)."""
    return strip_rows(1.586 - 0.006 * smile, 0.027, 0.0035 + 0.0035 * smile, 12, corner_x=1 + 0.30 * smile, corner_z=0.017 * smile)


def brow_rows(smile):
    return strip_rows(1.689 + 0.006 * smile, 0.019, 0.003, 6, x=0.031, corner_z=-0.004 - 0.003 * smile)


def make_head(rig, wood):
    head = MeshBuilder()
    skull = head.limb([HEAD_BOTTOM, HEAD_BOTTOM + Vector((0, 0, 0.25))], (1, 0, 0), BACK, HEAD_PROFILE,
                      lambda d: {full('Head'): 1.0}, (0.03, 0.09), 13, 20, WOOD)
    nose_z = 1.622
    head.ellipsoid(on_face(0, nose_z, 0.002), (0.011, 0.014, 0.021), full('Head'), 6, 8, WOOD)
    mouth = head.grid(mouth_rows(0), full('Head'), MOUTH)

    left = MeshBuilder()
    left.ellipsoid((0.078, 0.004, 1.640), (0.010, 0.020, 0.030), full('Head'), 6, 10, WOOD)
    bands = 10                                                   # the last two, around the pole that looks ahead, are the iris
    left.ellipsoid(EYE_CENTER, (EYE_RADIUS,) * 3, full('LeftEye'), bands, 12, [EYE] * (bands - 2) + [IRIS] * 2)
    upper = left.grid(lid_rows(UPPER_LID_OPEN, 100), full('Head'), DARK_WOOD)
    left.grid(lid_rows(LOWER_LID, -100), full('Head'), DARK_WOOD)
    brow = left.grid(brow_rows(0), full('Head'), DARK_WOOD)
    half = len(left.positions)
    left.mirror()
    first = head.append(left).start

    materials = [wood, material('DarkWood', (0.22, 0.11, 0.05)), material('Eye', (0.90, 0.90, 0.88), roughness=0.2),
                 material('Iris', (0.03, 0.10, 0.22), roughness=0.1), material('Mouth', (0.40, 0.07, 0.06))]
    obj = head.build('Head', rig, materials)

    flat = lambda rows: [p for row in rows for p in row]

    def both_sides(part, rows):
        moved = {}
        for i, p in zip(part, flat(rows)):
            moved[first + i] = p
            moved[first + half + i] = Vector((-p.x, p.y, p.z))
        return moved

    shape_key(obj, 'Blink', both_sides(upper, lid_rows(UPPER_LID_SHUT, 100)))
    cheeks = {}
    for i in skull:
        p = head.positions[i]
        swell = max(0.0, 1 - ((abs(p.x) - 0.045)**2 + (p.z - 1.605)**2) / 0.035**2) if p.y < -0.03 else 0.0
        if swell > 0.0:
            cheeks[i] = p + Vector((math.copysign(0.35, p.x), -0.7, 0.5)) * 0.008 * swell
    shape_key(obj, 'Smile', {**dict(zip(mouth, flat(mouth_rows(1)))), **both_sides(brow, brow_rows(1)), **cheeks})
    return obj


def wood_grain(x, y):
    """64 x 64 pixels that tile; the grain runs along v."""
    u, v = 2 * math.pi * x / 64, 2 * math.pi * y / 64
    grain = math.sin(6 * u + 1.5 * math.sin(v) + 0.7 * math.sin(2 * v + 2 * u)) + 0.5 * math.sin(13 * u - 2 * math.sin(v))
    return tuple(c + 0.020 * grain for c in (0.80, 0.64, 0.45))


# ---------------------------------------------------------------------------------------------------------- clips

def rotation(axis, degrees):
    return Matrix.Rotation(math.radians(degrees), 3, axis)


class Poser:
    """Poses joints in the axes of the world instead of the bones' own, and keys them."""

    def __init__(self, rig):
        self.rig = rig
        legs = tuple(side + part for side in SIDES for part in ('UpLeg', 'Leg', 'Foot'))        # these follow their IK
        feet = [f'ctl_{side}Foot' for side in SIDES]
        names = [bone.name for bone in rig.pose.bones]
        self.turning = [n for n in names if n.startswith(PREFIX) and n[len(PREFIX):] not in legs] + feet
        self.moving = [full('Hips')] + feet

    def turn(self, joint, matrix):
        bone = self.rig.pose.bones[full(joint)]
        own = bone.bone.matrix_local.to_3x3()
        bone.rotation_quaternion = (own.inverted() @ matrix @ own).to_quaternion()

    def move(self, joint, offset):
        bone = self.rig.pose.bones[full(joint)]
        bone.location = bone.bone.matrix_local.to_3x3().inverted() @ Vector(offset)

    def flex(self, joint, degrees):
        self.rig.pose.bones[full(joint)].rotation_quaternion = Quaternion((1, 0, 0), math.radians(degrees))

    def arm(self, side, swing, bend):
        """Hangs an arm down: swing forward and bend of the elbow in degrees."""
        sign = 1 if side == 'Left' else -1
        self.turn(side + 'Shoulder', rotation('Y', sign * 6))
        self.turn(side + 'Arm', rotation('X', -swing) @ rotation('Y', sign * 70))
        self.flex(side + 'ForeArm', bend)
        for k, degrees in enumerate((14, 20, 14)):
            for finger in FINGERS:
                self.flex(f'{side}Hand{finger}{k + 1}', degrees)

    def key(self, frame):
        bones = self.rig.pose.bones
        for name in self.turning:
            bones[name].keyframe_insert('rotation_quaternion', frame=frame)
        for name in self.moving:
            bones[name].keyframe_insert('location', frame=frame)


def animate_idle(rig, head):
    """Breathing, a shift of weight, a look to the side, a smile and two blinks."""
    poser = Poser(rig)
    begin_clip(rig, 'Idle')
    for frame in range(0, IDLE_FRAMES + 1, 3):
        phase = 2 * math.pi * frame / IDLE_FRAMES
        breath, sway, look = math.sin(2 * phase), math.sin(phase), math.sin(phase) ** 3
        rest(rig)
        for side in SIDES:
            poser.arm(side, 2 + 1.5 * sway, 12 + 2 * breath)
            poser.turn(side + 'Eye', rotation('Z', 16 * look))
        poser.move('Hips', (0.014 * sway, 0, -0.010 + 0.003 * breath))
        poser.turn('Hips', rotation('Y', -1.2 * sway))
        poser.turn('Spine1', rotation('Y', 1.2 * sway) @ rotation('X', -1.2 * breath))
        poser.turn('Spine2', rotation('X', -0.8 * breath))
        poser.turn('Neck', rotation('X', 1.0 * breath))
        poser.turn('Head', rotation('Z', 9 * look))
        poser.key(frame)
    end_clip(rig)
    rest(rig)
    shape_key_clip(head, 'Idle', {
        'Blink': [(0, 0), (21, 0), (24, 1), (28, 0), (66, 0), (69, 1), (73, 0), (IDLE_FRAMES, 0)],
        'Smile': [(0, 0), (30, 0), (45, 1), (60, 1), (80, 0), (IDLE_FRAMES, 0)],
    })


STANCE = 0.60                           # the part of the clip in which a foot is on the ground
FOOT_FRONT, FOOT_BACK = -0.285, 0.37     # y of the foot, from where it rests, when it lands and when it leaves, metres
LANDING_PITCH, LEAVING_PITCH = -18, 40  # degrees, positive: the heel is up
HEEL = Vector((0, 0.030, -0.090))       # from the ankle
BALL = Vector((0, -0.123, -0.060))


def foot_on_walk(phase):
    """A foot at phase 0 to 1 of its step, which begins when the heel lands. Returns (offset of the ankle, pitch, bend of the toes).

    On the ground the foot goes back at one speed and rolls over heel and ball, so that nothing slides.
    """
    if phase < STANCE:
        t = phase / STANCE
        y, lift = FOOT_FRONT + (FOOT_BACK - FOOT_FRONT) * t, 0.0
        pitch = LANDING_PITCH * (1 - smoothstep(0.0, 0.20, t)) + LEAVING_PITCH * smoothstep(0.60, 1.0, t) ** 1.8
        toes = max(0.0, pitch)                                      # they stay flat
    else:
        t = (phase - STANCE) / (1 - STANCE)
        speed = (FOOT_BACK - FOOT_FRONT) / STANCE * (1 - STANCE)    # as on the ground, where the swing begins and ends
        y = ((2 * t**3 - 3 * t**2 + 1) * FOOT_BACK + (t**3 - 2 * t**2 + t) * speed
             + (3 * t**2 - 2 * t**3) * FOOT_FRONT + (t**3 - t**2) * speed)
        lift = 0.055 * math.sin(math.pi * t) ** 2
        pitch = LEAVING_PITCH + (LANDING_PITCH - LEAVING_PITCH) * smoothstep(0.05, 0.95, t)
        toes = LEAVING_PITCH * (1 - smoothstep(0.0, 0.35, t))
    pivot = HEEL if pitch < 0 else BALL
    return Vector((0, y, lift)) + pivot - rotation('X', pitch) @ pivot, pitch, toes


def animate_walk(rig):
    """One clip of two steps on the spot; the left heel lands at time 0."""
    poser = Poser(rig)
    begin_clip(rig, 'Walk')
    for frame in range(WALK_FRAMES + 1):
        phase = frame / WALK_FRAMES
        turn = 2 * math.pi * phase
        rest(rig)
        height = -0.022 - 0.018 * math.cos(2 * (turn - 0.35))       # lowest on both feet, highest as one passes the other
        forward = math.cos(turn)                                    # +1: the left foot is in front
        over_left = math.sin(turn - 0.2)
        poser.move('Hips', (0.022 * over_left, 0, height))
        poser.turn('Hips', rotation('Z', -5 * forward) @ rotation('Y', 3.0 * over_left) @ rotation('X', 2))
        poser.turn('Spine', rotation('Z', 3 * forward) @ rotation('Y', -1.5 * over_left) @ rotation('X', 1))
        poser.turn('Spine1', rotation('Z', 4 * forward) @ rotation('Y', -1.5 * over_left))
        poser.turn('Spine2', rotation('Z', 4 * forward))
        poser.turn('Neck', rotation('Z', -3 * forward))
        poser.turn('Head', rotation('Z', -3 * forward) @ rotation('X', -2 + 1.5 * math.cos(2 * turn)))
        for side, sign, shift in (('Left', -1, 0.0), ('Right', 1, 0.5)):
            swing = sign * math.cos(turn - 0.25)
            poser.arm(side, 19 * swing, 17 + 10 * swing)
            offset, pitch, toes = foot_on_walk((phase + shift) % 1.0)
            poser.move(f'ctl_{side}Foot', offset)
            poser.turn(f'ctl_{side}Foot', rotation('X', pitch))
            poser.flex(side + 'ToeBase', -toes)
        poser.key(frame)
    end_clip(rig)
    rest(rig)


def main():
    out, *blend = script_arguments()
    empty_scene(IDLE_FRAMES)
    rig = make_rig()
    wood = material('Wood', roughness=0.55, image=texture('wood_grain', 64, 64, wood_grain))
    make_body(rig, wood)
    head = make_head(rig, wood)
    animate_idle(rig, head)
    animate_walk(rig)
    if blend:
        bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(blend[0]))
    export_glb(os.path.abspath(out))


main()
