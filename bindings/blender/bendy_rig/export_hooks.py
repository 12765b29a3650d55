"""The hooks that Blender's glTF exporter calls, and what they put into the nodes.

The exporter makes one RigExtras for each export. It prints what goes wrong in a hook and goes on; so nothing goes wrong
in these: errors are kept, and finish_export stops an export that wanted the rig.
"""
import functools
import traceback

import bpy
from mathutils import Matrix

from .axes import FileAxes
from .export_report import ExportReport
from .chain_settings import chain_joints, is_helper
from .ik_chains import chain_record, ik_constraints
from .joint_limits import joint_record, says_a_limit
from .cameras_and_lights import return_camera, return_light
from .kept_extras import returned_extras
from .kept_records import CLIP, CONSTRAINTS, CURVES, DOCUMENTS, MARK, in_radians, kept, kept_chains, kept_markers
from .roles import add_role
from .shortcomings import all_curves, bone_notes, chain_notes, object_notes
from .thin_keys import restore_steps, thin_animations


class LastExport:
    """Blender's exporter gives its extensions no reference to the caller, so the state is in the class."""
    report = ExportReport()
    must_succeed = False            # if true, errors stop the export before it writes a file
    is_thinned = False              # if true, clips are written without the keys that nothing needs


class RigError(Exception):
    """The export was stopped because all or part of the rig is missing from the file."""


def kept_error(hook):
    """A hook whose exceptions become errors in the report, each once."""
    @functools.wraps(hook)
    def wrapped(self, *arguments):
        try:
            hook(self, *arguments)
        except Exception as error:      # the exporter would only print it
            text = f'{hook.__name__}: {type(error).__name__}: {error}'
            if text not in self.report.errors:
                traceback.print_exc()
                self.report.errors.append(text)
    return wrapped


class RigExtras:
    """The exporter's hooks; the names are the exporter's, and the settings come last in every version."""

    def __init__(self):
        self.report = LastExport.report = ExportReport()
        self.rigs = {}              # armature object's name -> the object
        self.rig_nodes = {}         # armature object's name -> its node, unless the exporter leaves armatures out
        self.joint_nodes = {}       # armature object's name -> bone's name -> its nodes; of the scene that is being exported
        self.done = set()           # armature objects whose chains are written
        self.chain_names = set()
        self.joint_names = set()    # of the rigs whose chains are written
        self.curves = []            # from an import
        self.clips = {}             # id of the exporter's animation -> number of the imported clip

    @kept_error
    def gather_tree_filter_tag_hook(self, tree, *_):
        """Leaves out the bones that an import has made for tips, targets and poles."""
        for node in tree.nodes.values():
            if node.blender_bone is not None and node.keep_tag and is_helper(node.blender_bone):
                node.keep_tag = False

    @kept_error
    def gather_joint_hook(self, node, bone, *_):
        if not isinstance(bone, bpy.types.PoseBone) or node.name != bone.name:
            return                  # an added leaf
        node.extras = marked_extras(node, bone)
        self.report.add_notes(bone.name, add_role(node, bone))
        self.rigs[bone.id_data.name] = bone.id_data
        self.joint_nodes.setdefault(bone.id_data.name, {}).setdefault(bone.name, []).append(node)

    @kept_error
    def gather_node_hook(self, node, obj, *_):
        if not isinstance(obj, bpy.types.Object):
            return                  # a collection
        node.extras = marked_extras(node, obj)
        self.curves += kept(obj, CURVES) or []
        limits = kept(obj, CONSTRAINTS)
        if limits is not None:
            node.extras = {**(node.extras or {}), 'rig_joint': {'limits': in_radians(limits)}}
            self.report.joints.append(obj.name)
        if obj.type == 'ARMATURE':
            self.rigs[obj.name] = obj
            self.rig_nodes.setdefault(obj.name, node)
        lights = return_light(node, obj.data) if obj.type == 'LIGHT' else []
        self.report.add_notes(obj.name, object_notes(obj) + add_role(node, obj) + lights)

    @kept_error
    def gather_mesh_hook(self, mesh, made, *_):
        mesh.extras = {**({'targetNames': mesh.extras['targetNames']} if 'targetNames' in (mesh.extras or {}) else {}),
                       **(marked_extras(mesh, made) or {})} or None

    @kept_error
    def gather_material_hook(self, material, made, *_):
        material.extras = marked_extras(material, made)

    @kept_error
    def gather_camera_hook(self, camera, data, *_):
        camera.extras = returned_extras(camera.extras, data)
        self.report.add_notes(data.name, return_camera(camera, data))

    @kept_error
    def gather_scene_hook(self, scene, made, *rest):
        """All nodes of the scene exist now, so it is known which joints are in the file."""
        scene.extras = returned_extras(scene.extras, made)
        if DOCUMENTS in made and not LastExport.must_succeed:
            self.report.add_notes(made.name, [(False, 'what an import has kept (VRM and the like) is returned only by the entries of this add-on '
                                                      'in File > Export')])
        axes = FileAxes(rest[-1].get('gltf_yup', True))
        for name, rig in self.rigs.items():
            nodes = self.joint_nodes.pop(name, {})
            self.add_joints(rig, axes, nodes)
            if name not in self.done:
                self.done.add(name)
                rig_node = self.rig_nodes.get(name)
                put_bones_first(rig_node or scene, nodes)
                if is_helper(rig) and stands_still(rig):
                    put_in_place_of(rig_node, scene)
                    rig_node = None
                add_chains(rig_node or scene, self.chains(rig, axes, nodes, rig_node is not None))
        if self.curves:
            scene.extras = {**(scene.extras or {}), 'bendy_rig': {'bendy_rig': 1, 'curves': self.curves}}
        self.report.is_finished = True

    @kept_error
    def gather_animation_hook(self, animation, action, *rest):
        """The exporter does not write the markers of an action."""
        if isinstance(action.get(CLIP), int):
            self.clips[id(animation)] = action[CLIP]
        markers = kept_markers(action, bpy.context.scene.render.fps)
        if LastExport.is_thinned and rest[0].type == 'ARMATURE':
            restore_steps(animation, action, rest[0])
        animation.extras = returned_extras(animation.extras, action)
        if markers:
            animation.extras = {**(animation.extras or {}), 'markers': markers}

    @kept_error
    def gather_gltf_hook(self, _scene, scenes, animations, *_):
        """Puts imported clips first, in the file's order; the exporter has sorted all clips by name."""
        if LastExport.is_thinned:
            thin_animations(animations, scenes)
        animations.sort(key=lambda animation: self.clips.get(id(animation), len(animations) + len(self.clips)))

    def add_joints(self, rig, axes, nodes):
        """nodes: bone's name -> its nodes, which are several where a collection has instances."""
        missing = []
        for bone in rig.pose.bones:
            if is_helper(bone):
                continue
            record, notes = joint_record(bone, axes), bone_notes(bone)
            if bone.name in nodes:
                if rig.name not in self.done:
                    self.report.add_notes(bone.name, notes)
            elif says_a_limit(record):
                missing.append(bone.name)
            for node in nodes.get(bone.name, []) if record or notes else []:
                self.report.joints += [bone.name] if says_a_limit(record) else []
                node.extras = {**(node.extras or {}), 'rig_joint': with_notes(dict(record or {}), notes)}
        if missing and rig.name not in self.done:
            self.report.add_notes(rig.name, [(False, f'not in the file, nor their limits: {", ".join(missing)}')])

    def chains(self, rig, axes, exported, has_node):
        records, done, changed = kept_chains(rig, exported)
        twice = sorted(set(exported) & self.joint_names)
        self.joint_names.update(exported)
        if records and twice:
            self.report.add_notes(rig.name, [(False, f'another armature has bones of the same names, and its chains may be taken for that '
                                              f'one\'s: {", ".join(twice)}')])
        for record in records:
            self.chain_names.add(record['name'])
            self.report.chains.append(record['name'])
        self.report.add_notes(rig.name, [(False, f'IK chain {name} was changed since the import: written as Blender has it')
                                         for name in changed])
        for bone, constraint in ik_constraints(rig):
            if (bone.name, constraint.name) in done:
                continue
            joints = chain_joints(bone, constraint)
            if not any(joint in exported for joint in joints):
                self.report.add_notes(constraint.name, [(False, f'IK on {bone.name}: its bones are not in the file: left out')])
                continue
            name = self.unique_name(constraint.name, bone.name)
            notes = chain_notes(bone, constraint, joints, exported)
            if name != constraint.name:
                notes.append((False, f'one of several chains named {constraint.name}'))
            self.report.chains.append(name)
            self.report.add_notes(name, notes)
            records.append(with_notes(chain_record(name, joints, bone, constraint, axes, has_node), notes))
        return records

    def unique_name(self, name, bone):
        """Chains are identified by name, and Blender calls every new one IK."""
        wanted, number = name, 1
        while wanted in self.chain_names:
            wanted = f'{name}.{bone}' if number == 1 else f'{name}.{bone}.{number}'
            number += 1
        self.chain_names.add(wanted)
        return wanted


def marked_extras(thing, owner):
    """For one of this add-on's exports, also with the number that the thing has in an imported file: returned_document.py."""
    extras = returned_extras(thing.extras, owner)
    if LastExport.must_succeed and isinstance(owner.get(MARK), str):
        extras = {**(extras or {}), MARK: owner[MARK]}
    return extras


def stands_still(rig):
    """Whether an armature contributes only its bones."""
    return rig.parent is None and rig.matrix_world == Matrix.Identity(4) and not any(
        not curve.data_path.startswith('pose.') for curve in all_curves(rig.animation_data))


def put_bones_first(owner, joint_nodes):
    """If a bone and an object have the same name, a chain's joint is the first one."""
    joints = {id(node) for nodes in joint_nodes.values() for node in nodes}
    children = owner.nodes if hasattr(owner, 'nodes') else owner.children
    children.sort(key=lambda node: id(node) not in joints)


def put_in_place_of(node, scene):
    """The importer puts joints without a parent below an armature; they become roots again."""
    if node in scene.nodes:
        at = scene.nodes.index(node)
        scene.nodes[at:at + 1] = node.children


def add_chains(owner, chains):
    """owner: the node of the rig, or the scene where the exporter leaves armatures out."""
    if not chains:
        return
    extras = dict(owner.extras or {})
    before = extras.get('rig_ik', {}).get('chains', [])
    extras['rig_ik'] = {'up': '+Y', 'order_rule': 'XYZ means Rz*Ry*Rx', 'chains': before + chains}
    owner.extras = extras


def with_notes(record, notes):
    if any(approximated for approximated, _ in notes):
        record['approximated'] = True
    if notes:
        record['notes'] = [text for _, text in notes]
    return record


def finish_export(export_settings):
    """Called by the exporter before it writes the file."""
    report = LastExport.report
    if not report.is_finished and not report.errors:
        report.errors.append('the exporter called no hook')
    print('\n'.join(report.lines()))
    if report.errors and LastExport.must_succeed:
        raise RigError(report.errors[0])
