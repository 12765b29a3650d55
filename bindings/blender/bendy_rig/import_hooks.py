"""The hooks that Blender's glTF importer calls: they record the object or bone of each joint, and the actions of each clip.

`bendy export` writes joint n as node n.
"""
import bpy

from . import clip_curves
from .cameras_and_lights import keep_cameras_and_lights
from .kept_document import Keeper
from .kept_extras import keep_extras
from .roles import keep_role

NOT_EXPORTED = {'KHR_materials_pbrSpecularGlossiness', 'KHR_materials_variants'}     # that Blender reads
RIG_EXTRAS = ('rig_joint', 'rig_ik')        # of nodes: written by an earlier export, and replaced by the next one


class ImportedClip:
    def __init__(self, animation, track_name, actions):
        self.extras = animation.extras if isinstance(animation.extras, dict) else {}
        self.track_name = track_name        # of the NLA tracks that contain the actions
        self.actions = actions              # (owner, action): of the armature, of objects and of shape keys


class ImportedFile:
    """The objects that the importer made from a file written by `bendy export`."""

    def __init__(self, path='', document=None, binary=b''):
        self.path, self.document, self.binary = path, document, binary       # of the .glb file
        self.keeper = None          # a Keeper, as soon as it is known what the importer knows
        self.meshes = []            # (number in the file, mesh of Blender)
        self.materials = []         # (number in the file, material of Blender)
        self.rig = {}               # the output of `bendy rig`
        self.joints = []            # joint -> (object, name of the bone in it, or None)
        self.names = []             # joint -> its name in the file
        self.locks = {}             # joint -> rig_joint.locks of an earlier export from Blender
        self.twins = []             # (joint, object with its skinned mesh) where the importer made an empty for the joint
        self.rest = {}              # owner of actions -> data path -> the values without a clip
        self.root = None            # an armature that is not a joint: the importer makes it for joints without a parent
        self.clips = []             # from the last to the first
        self.set_rate = None        # called with the times of all keys in seconds, before the importer places them
        self.errors = []            # the importer would only print them


class LastImport:
    """Blender's importer gives its extensions no reference to the caller, so the file is in the class."""
    file = None                     # an ImportedFile while the add-on imports


class ImportHooks:
    """The names are the importer's; the importer's state comes last in every version."""

    def gather_import_gltf_before_hook(self, gltf):
        if LastImport.file:
            guarded(take_extras, gltf, LastImport.file)
            guarded(keep_document, gltf, LastImport.file)
            guarded(LastImport.file.set_rate, key_times(gltf))

    def gather_import_scene_after_nodes_hook(self, *arguments):
        if LastImport.file:
            guarded(note_joints, arguments[-1], LastImport.file)

    def gather_import_material_after_hook(self, material, _vertex_color, made, gltf):
        if LastImport.file:
            guarded(note_material, gltf, LastImport.file, material, made)

    def gather_import_animation_channel_after_hook(self, animation, vnode, path, channel, *rest):
        if LastImport.file:
            guarded(clip_curves.set_tangents, rest[-1], animation, vnode, path, channel, rest[0])

    def gather_import_animation_weight_after_hook(self, vnode, animation, gltf):
        if LastImport.file:
            guarded(note_weights, gltf, vnode, animation)

    def gather_import_animation_after_hook(self, anim_idx, track_name, gltf):
        if LastImport.file:
            guarded(note_clip, gltf, LastImport.file, anim_idx, track_name)


def guarded(work, *arguments):
    try:
        work(*arguments)
    except Exception as error:      # the importer would only print it
        LastImport.file.errors.append(f'{work.__name__}: {type(error).__name__}: {error}')


def take_extras(gltf, file):
    """Removes the rig from the extras: as custom properties, it would be exported again unchanged."""
    for joint, node in enumerate(gltf.data.nodes or []):
        extras = node.extras if isinstance(node.extras, dict) else {}
        record = extras.get('rig_joint')
        if isinstance(record, dict) and isinstance(record.get('locks'), dict):
            file.locks[joint] = record['locks']
        for key in RIG_EXTRAS:
            extras.pop(key, None)


def keep_document(gltf, file):
    managed = set(getattr(gltf, 'extensions_managed', ())) - NOT_EXPORTED
    file.keeper = Keeper(file.path, file.document, file.binary, managed)


def note_material(gltf, file, material, made):
    number = next(number for number, each in enumerate(gltf.data.materials) if each is material)
    file.materials.append((number, made))
    keep_extras(made, material.extras)


def note_extras(gltf, file):
    """Of nodes, meshes and the scene, whose custom properties the importer has made."""
    for (obj, bone), node in zip(file.joints, gltf.data.nodes or []):
        if bone:
            keep_extras(obj.pose.bones[bone], node.extras, obj.data.bones[bone])
        else:
            keep_extras(obj, node.extras)
    for vnode in gltf.vnodes.values():
        if getattr(vnode, 'mesh_node_idx', None) is None or vnode.blender_object.type != 'MESH':
            continue
        number = gltf.data.nodes[vnode.mesh_node_idx].mesh
        file.meshes.append((number, vnode.blender_object.data))
        extras = gltf.data.meshes[number].extras
        keep_extras(vnode.blender_object.data, {key: value for key, value in (extras or {}).items() if key != 'targetNames'})
    if gltf.data.scene is not None:
        keep_extras(bpy.data.scenes[gltf.blender_scene], gltf.data.scenes[gltf.data.scene].extras)


def note_joints(gltf, file):
    root = gltf.vnodes['root']
    if root.is_arma:
        file.root = root.blender_object
    for joint, node in enumerate(gltf.data.nodes or []):
        vnode = gltf.vnodes[joint]
        is_bone = getattr(vnode, 'blender_bone_name', None) is not None
        owner = gltf.vnodes[vnode.bone_arma] if is_bone else vnode
        file.joints.append((owner.blender_object, vnode.blender_bone_name if is_bone else None))
        file.names.append(node.name or '')
        keep_role(owner.blender_object.pose.bones[vnode.blender_bone_name] if is_bone else vnode.blender_object, node)
        skinned = gltf.vnodes.get(f'{joint}.skinned')
        if skinned and not is_bone and not vnode.children and not moves(gltf, node):
            file.twins.append((joint, skinned.blender_object))
    note_extras(gltf, file)
    keep_cameras_and_lights(gltf, file.document)
    note_rest(file)


def note_rest(file):
    """Called before the first clip, because Blender keeps the values that a clip set last."""
    for obj in {obj for obj, _ in file.joints} | {mesh for _, mesh in file.twins}:
        values = file.rest.setdefault(obj, {})
        for place, owner in [('', obj), *((f'{bone.path_from_id()}.', bone) for bone in (obj.pose.bones if obj.pose else ()))]:
            for name in clip_curves.COMPONENTS.values():
                values[place + name] = list(getattr(owner, name))
        keys = obj.data.shape_keys if obj.type == 'MESH' else None
        if keys:
            file.rest[keys] = {f'{block.path_from_id()}.value': [block.value] for block in keys.key_blocks}


def moves(gltf, node):
    """Whether a clip moves the node itself, and not only the weights of its morph targets."""
    return any(gltf.data.animations[clip].channels[channel].target.path != 'weights'
               for clip, channels in getattr(node, 'animations', {}).items() for channel in channels)


def note_clip(gltf, file, clip, track_name):
    actions = [(entry[0], action_of(entry)) for entry in gltf.needs_stash]
    file.clips.append(ImportedClip(gltf.data.animations[clip], track_name, actions))


def action_of(entry):
    """Newer importers also stash an action's slot."""
    return next(part for part in entry if isinstance(part, bpy.types.Action))


def note_weights(gltf, vnode, animation):
    """The last action that the importer made if this node's weights move in the clip; otherwise none."""
    clip = gltf.data.animations.index(animation)
    node = gltf.data.nodes[vnode.mesh_node_idx]
    if any(animation.channels[channel].target.path == 'weights' for channel in node.animations.get(clip, [])):
        clip_curves.set_weight_tangents(gltf, vnode, animation, clip, action_of(gltf.needs_stash[-1]))


def key_times(gltf):
    """The times of all keys of all clips, seconds."""
    inputs = {sampler.input for animation in gltf.data.animations or [] for sampler in animation.samplers}
    return {time for accessor in inputs for time, in clip_curves.read_accessor(gltf, accessor)}
