"""Turns the rig of an imported file into Blender's constraints, and keeps its records."""
import contextlib
import json
import re

import bpy
from mathutils import Matrix, Vector

from . import chain_settings, joint_settings
from .chain_settings import CONTROL, HELPER, TIP
from .kept_records import CHAINS, CONSTRAINTS, CURVES, MARKERS, keep

SHORTEST_BONE = 1e-3                # metres; Blender removes bones without a length
LOCKED = ('rotation', 'location', 'scale')


class RigMaker:
    """file: an ImportedFile."""

    def __init__(self, file, is_muted):
        self.file, self.is_muted = file, is_muted
        self.found = {}             # difference from the file -> names of the joints or chains
        self.by_name = {}
        for joint, name in enumerate(file.names):
            self.by_name.setdefault(name, joint)
        self.count = 0              # of Limit Rotation, Limit Location and IK constraints
        self.chains = 0             # of IK constraints

    def note(self, name, *texts):
        for text in texts:
            self.found.setdefault(text, []).append(name)

    def make(self):
        for key, constraints in self.file.rig.get('joints', {}).items():
            for joint in self.joints_of(key):
                self.add_limits(joint, constraints if isinstance(constraints, list) else [constraints])
        for joint, locks in self.file.locks.items():
            self.add_locks(joint, locks)
        self.add_chains()

    def joints_of(self, key):
        """A key of `bendy rig`: #number, or a name with a backslash before special characters."""
        if re.fullmatch(r'#\d+', key):
            return [int(key[1:])]
        name = key[1:] if key.startswith('=') else re.sub(r'\\(.)', r'\1', key)
        return [joint for joint, other in enumerate(self.file.names) if other == name]

    def joint_of(self, name):
        return int(name[1:]) if re.fullmatch(r'#\d+', name) else self.by_name.get(name)

    def add_limits(self, joint, constraints):
        obj, name = self.file.joints[joint]
        if name is None:
            keep(obj, CONSTRAINTS, constraints)
            self.note(obj.name, 'only bones have limits')
            return
        bone = obj.pose.bones[name]
        keep(bone, CONSTRAINTS, constraints)
        settings, notes = joint_settings.bone_settings(constraints)
        joint_settings.apply_settings(bone, settings, self.is_muted)
        self.count += sum(settings[kind] is not None for kind in ('limit_rotation', 'limit_location'))
        self.note(name, *notes)

    def add_locks(self, joint, locks):
        obj, name = self.file.joints[joint]
        for kind in LOCKED:
            values = locks.get(kind)
            if name is not None and isinstance(values, list) and len(values) == 3:
                setattr(obj.pose.bones[name], f'lock_{kind}', [bool(value) for value in values])

    # ------------------------------------------------------------------------------------------------- chains

    def add_chains(self):
        plans = {}                  # armature object -> [(record, settings)]
        for record in self.file.rig.get('chains', []):
            rig, record = self.in_blenders_names(record)
            if rig is None:
                continue
            settings, notes = chain_settings.chain_settings(rig, record)
            self.note(record['name'], *notes)
            plans.setdefault(rig, []).append((record, settings))
        for rig, chains in plans.items():
            tips = make_bones(rig, chains)
            keep(rig, CHAINS, [self.add_chain(rig, *chain, *tip) for chain, tip in zip(chains, tips)])

    def in_blenders_names(self, record):
        """(armature, the chain with its bones' names); no armature if its joints are not bones of one: the record is kept."""
        record = json.loads(json.dumps(record))
        joints = {key: self.joint_of(record[key]) for key in ('start', 'effector', 'target', 'pole') if key in record}
        places = {key: self.file.joints[joint] for key, joint in joints.items() if joint is not None}
        rig = places.get('effector', (None, None))[0]
        for key, (_, bone) in places.items():
            record[key] = bone or record[key]
        if any(places.get(key, (None, None))[1] is None or places[key][0] != rig for key in ('start', 'effector')):
            obj = rig or self.file.joints[0][0]
            others = json.loads(obj.get(CHAINS, '[]'))
            keep(obj, CHAINS, others + [{'record': record, 'bone': None, 'constraint': None}])
            self.note(record['name'], 'only bones of one armature are a chain')
            return None, record
        if 'weights' in record:
            record['weights'] = {escaped(self.bone_of(key)): value for key, value in record['weights'].items()}
        return rig, record

    def bone_of(self, key):
        joints = self.joints_of(key)
        return (self.file.joints[joints[0]][1] if joints else None) or key

    def add_chain(self, rig, record, settings, bone, helpers):
        constraint = chain_settings.apply_constraint(rig, record['name'] or 'IK', bone, settings, helpers, self.is_muted)
        self.count += 1
        self.chains += 1
        return {'record': record, 'bone': bone, 'constraint': constraint.name}


def escaped(name):
    return re.sub(r'([*?\[\\])', r'\\\1', name)


def make_bones(rig, chains):
    """Sets the lengths of chains' last bones, or makes bones for tips; makes controls. Returns (owner, helpers) of each chain."""
    made, lengths, found = [], {}, []           # made: (bone, kind)
    lengths_before = {}
    with edit_mode(rig):
        bones = rig.data.edit_bones
        for record, settings in chains:
            owner, tip, helpers = settings['joints'][-1], settings['tip'], {}
            is_along = tip.y > SHORTEST_BONE and Vector((tip.x, 0.0, tip.z)).length <= chain_settings.ALONG_BONE * tip.y
            if is_along and abs(lengths.setdefault(owner, tip.y) - tip.y) <= chain_settings.TOLERANCE:
                lengths_before.setdefault(owner, bones[owner].length)
                bones[owner].length = tip.y
            else:
                owner = add_bone(bones, f'{record["name"]} tip', bones[owner].head, settings['target_place'], bones[owner])
                made.append((owner, TIP))
            size = max(0.1 * (settings['target_place'] - bones[settings['joints'][0]].head).length, SHORTEST_BONE)
            for what in ('target', 'pole'):
                place = settings[f'{what}_place']
                if place is not None and not settings[what]:
                    helpers[what] = add_bone(bones, f'{record["name"]} {what}', place, place + Vector((0.0, 0.0, size)))
                    made.append((helpers[what], CONTROL))
            found.append((owner, helpers))
    keep_places(rig, lengths_before)
    for name, kind in made:
        bone = rig.pose.bones[name]
        bone[HELPER], bone.rotation_mode = kind, 'QUATERNION'
        if kind == TIP:
            bone.lock_ik_x = bone.lock_ik_y = bone.lock_ik_z = True
    return found


def keep_places(rig, lengths):
    """Objects parented to a bone are attached to its tail. lengths: name of a bone -> its previous length."""
    for obj in bpy.data.objects:
        if obj.parent == rig and obj.parent_type == 'BONE' and obj.parent_bone in lengths:
            longer = rig.data.bones[obj.parent_bone].length - lengths[obj.parent_bone]
            obj.matrix_parent_inverse = Matrix.Translation((0.0, -longer, 0.0)) @ obj.matrix_parent_inverse


def add_bone(bones, name, head, tail, parent=None):
    """Makes a bone. If the tip is at the head, the bone gets the shortest length."""
    bone = bones.new(name)
    bone.head, bone.tail, bone.parent, bone.use_deform = head, tail, parent, False
    if bone.length < SHORTEST_BONE:
        bone.tail = bone.head + Vector((0.0, SHORTEST_BONE, 0.0))
    return bone.name


@contextlib.contextmanager
def edit_mode(rig):
    layer = bpy.context.view_layer
    active = layer.objects.active
    layer.objects.active = rig
    bpy.ops.object.mode_set(mode='EDIT')
    try:
        yield
    finally:
        bpy.ops.object.mode_set(mode='OBJECT')
        layer.objects.active = active


# ------------------------------------------------------------------------------------------------- clips

def add_markers(clip, markers, rate):
    """As pose markers, which are at whole frames; the times are kept."""
    for owner, action in clip.actions:
        if isinstance(owner, bpy.types.Object) and markers:
            keep(action, MARKERS, markers)
            for marker in markers:
                action.pose_markers.new(marker['name']).frame = round(marker['time'] * rate)
            return


def keep_curves(file):
    """Blender has no place for curves that exporters read."""
    if file.rig.get('curves') and file.joints:
        keep(file.joints[0][0], CURVES, file.rig['curves'])
        return [('there are no curves for what is neither transform nor morph target', [curve.get('name') or curve.get('path', '')
                                                                                      for curve in file.rig['curves']])]
    return []
