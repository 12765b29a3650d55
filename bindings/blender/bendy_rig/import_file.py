"""Reads a .bendy file: the program writes it as glTF, for Blender's importer, and its rig as JSON, for constraints."""
import contextlib
import json
import os
import re
import tempfile

import bpy

from . import import_rig
from .chain_settings import HELPER, ROOT
from .clip_curves import action_curves, at_rest, complete, fitting_rate, is_on_frame, put_on_frames, turn_evenly
from .import_hooks import ImportedFile, LastImport
from .kept_extras import keep_extras
from .kept_records import CLIP, REST, keep
from .known_hooks import hooks_in_preferences
from .program import BendyError, run_program
from .written_file import read_file, write_document

# Bones get the joints' own axes, which limits and exports require, and the file's rest pose.
IMPORTER_OPTIONS = {'bone_heuristic': 'BLENDER', 'guess_original_bind_pose': False, 'merge_vertices': False, 'disable_bone_shape': True}
MOST_ACTIONS = 10000                # limit for the actions made for clips and the objects that a clip does not move
COLLECTIONS = ('objects', 'armatures', 'meshes', 'shape_keys', 'actions', 'materials', 'images', 'textures', 'cameras', 'lights',
               'collections', 'node_groups')


class Imported:
    """For the report."""

    def __init__(self):
        self.warnings = []          # from the program, about what glTF cannot express
        self.notes = []             # (text, names): about what Blender cannot express
        self.kept = []              # names of what Blender does not know and an export returns
        self.clips = 0
        self.limits = 0
        self.chains = 0


def import_file(context, path, enable_constraints, set_frame_rate, progress):
    """progress: called with the fraction done, 0 to 1. Leaves nothing behind on failure."""
    imported = Imported()
    with tempfile.TemporaryDirectory(prefix='bendy') as folder:
        stem = os.path.splitext(os.path.basename(path))[0] or 'character'
        glb = os.path.join(folder, f'{stem}.glb')
        rig = os.path.join(folder, 'rig.json')
        imported.warnings = run_program('export', path, '--output', glb)
        run_program('rig', path, '--output', rig)
        progress(0.3)
        with nothing_left_behind(context):
            file = read_glb(context, glb, set_frame_rate)
            with open(rig, encoding='utf-8') as text:
                file.rig = json.load(text)
            progress(0.8)
            join_twins(file)
            if file.root:
                file.root[HELPER] = ROOT
            note_scales(file, imported)
            finish_clips(context, file, imported)
            maker = import_rig.RigMaker(file, not enable_constraints)
            maker.make()
            keep_unknown(context.scene, file, imported)
            imported.notes += [*maker.found.items(), *import_rig.keep_curves(file)]
            imported.limits, imported.chains = maker.count - maker.chains, maker.chains
    progress(1.0)
    return imported


@contextlib.contextmanager
def nothing_left_behind(context):
    """Removes everything that a failed import made."""
    before = {name: set(getattr(bpy.data, name)) for name in COLLECTIONS}
    scene = context.scene
    properties = {key: scene[key] for key in scene.keys()}
    render = (scene.render.fps, scene.render.fps_base, scene.render.engine, scene.frame_start, scene.frame_end)
    active, selected = context.view_layer.objects.active, list(context.selected_objects)
    try:
        yield
    except Exception:
        if context.mode != 'OBJECT':
            bpy.ops.object.mode_set(mode='OBJECT')
        for name in COLLECTIONS:
            if name != 'shape_keys':            # shape keys are removed with their meshes
                made = [block for block in getattr(bpy.data, name) if block not in before[name]]
                bpy.data.batch_remove(made)
        for key in set(scene.keys()) - set(properties):
            del scene[key]
        for key, value in properties.items():
            if isinstance(value, str):
                scene[key] = value
        scene.render.fps, scene.render.fps_base, scene.render.engine, scene.frame_start, scene.frame_end = render
        context.view_layer.objects.active = active
        for obj in selected:
            obj.select_set(True)
        raise


def read_glb(context, glb, set_frame_rate):
    """Runs Blender's importer with this add-on's hooks."""
    if 'gltf' not in dir(bpy.ops.import_scene):
        raise BendyError('the add-on "glTF 2.0 format" is not enabled')
    may_set = set_frame_rate and not any(action.users for action in bpy.data.actions)
    document, binary = read_file(glb)
    if 'extensionsRequired' in document:        # the file can be read without, or `bendy export` would have failed
        write_document(glb, {key: value for key, value in document.items() if key != 'extensionsRequired'})
    file = ImportedFile(glb, document, binary)
    file.set_rate = lambda times: set_rate(context.scene, times, may_set)
    known = bpy.ops.import_scene.gltf.get_rna_type().properties.keys()
    options = {name: value for name, value in IMPORTER_OPTIONS.items() if name in known}
    LastImport.file = file
    try:
        with hooks_in_preferences(context), old_numpy_names():
            result = bpy.ops.import_scene.gltf(filepath=glb, **options)
    except RuntimeError as error:
        raise BendyError(f'Blender\'s glTF importer failed: {what_failed(error)}') from error
    finally:
        LastImport.file = None
    if 'FINISHED' not in result:
        raise BendyError('Blender\'s glTF importer failed')
    if file.errors:
        raise BendyError(f'the import hooks failed: {file.errors[0]}')
    if not file.joints:
        raise BendyError('Blender\'s glTF importer called no hook')
    return file


@contextlib.contextmanager
def old_numpy_names():
    """The importer of Blender 3.4 needs numpy.bool, which numpy 1.24 removed; Debian 12 has both versions."""
    import numpy
    if 'bool' in vars(numpy):
        yield
        return
    numpy.bool = bool
    try:
        yield
    finally:
        del numpy.bool


def set_rate(scene, times, may_set):
    """Chooses a frame rate at which all keys are on frames, and a playback range from the first key to the last."""
    rate = fitting_rate(times, scene.render.fps)
    if times and may_set:
        if rate:
            scene.render.fps, scene.render.fps_base = rate, 1.0
        scene.frame_start, scene.frame_end = int(min(times) * scene.render.fps), max(1, round(max(times) * scene.render.fps))


def keep_unknown(scene, file, imported):
    """Keeps what Blender does not know for an export, and notes it."""
    names = file.keeper.finish(scene, file.joints, file.meshes, file.materials)
    if names:
        imported.kept = names
    if file.keeper.lost:
        imported.notes.append(('an export does not return', file.keeper.lost))


def note_scales(file, imported):
    """Blender's bones have no scale at rest: the importer put it into the pose, and clips have it as keys."""
    scaled = [bone or obj.name for obj, bone in file.joints
              if bone and max(abs(s - 1.0) for s in file.rest[obj][f'{obj.pose.bones[bone].path_from_id()}.scale']) > 1e-5]
    if scaled:
        imported.notes.append(('a joint that is scaled at rest is scaled in clips only', scaled))


def join_twins(file):
    """Merges the two objects that the importer makes of a skinned mesh with moving morph targets: an empty, and the mesh."""
    for joint, mesh in file.twins:
        empty = file.joints[joint][0]
        name = empty.name
        bpy.data.objects.remove(empty)
        mesh.name = name
        file.joints[joint] = (mesh, None)


def finish_clips(context, file, imported):
    """file.clips: from the last to the first, as the importer made them."""
    rate, between_frames, by_owner = context.scene.render.fps, [], {}
    imported.clips = len(file.clips)
    for number, clip in enumerate(reversed(file.clips)):
        is_between = False
        for owner, action in clip.actions:
            action[CLIP] = number
            by_owner.setdefault(owner, []).append(action)
            put_on_frames(action_curves(action))
            is_between |= not all(is_on_frame(point.co.x) for curve in action_curves(action) for point in curve.keyframe_points)
            turn_evenly(action)
            extras = {key: value for key, value in clip.extras.items() if key != 'markers'}
            for key, value in extras.items():
                try:
                    action[key] = value
                except (TypeError, OverflowError, ValueError):
                    action[key] = str(value)    # as the importer does it; the value is kept
            keep_extras(action, extras)
        if is_between:
            between_frames.append(clip.track_name)
        import_rig.add_markers(clip, clip.extras.get('markers', []), rate)
    add_still_actions(file, by_owner, imported)
    for owner, actions in by_owner.items():
        complete(actions, file.rest.get(owner, {}))
        moving = {curve.data_path for curve in action_curves(actions[0]) if not curve.data_path.startswith('pose.')}
        if moving:
            keep(owner, REST, {path: values for path, values in file.rest.get(owner, {}).items() if path in moving})
    if between_frames:
        imported.notes.append((f'keys are between frames, and an export samples {rate} frames a second', between_frames))


def add_still_actions(file, by_owner, imported):
    """Adds an action that holds an object at rest for each clip that does not move it: Blender would keep the last clip's pose."""
    clips = [(number, clip) for number, clip in enumerate(reversed(file.clips)) if clip.actions]
    if len(clips) * len(by_owner) > MOST_ACTIONS:
        imported.notes.append(('objects that a clip does not move stay as the previous clip left them', [f'{len(by_owner)} objects']))
        return
    for owner, actions in by_owner.items():
        moving = {action[CLIP] for action in actions}
        for number, clip in clips:
            if number in moving:
                continue
            first = min(action.frame_range[0] for _, action in clip.actions)
            action = at_rest(actions[0], f'{clip.track_name}_{owner.name}', first, file.rest.get(owner, {}))
            action[CLIP] = number
            stash(owner, clip.track_name, action)
            actions.append(action)


def stash(owner, track_name, action):
    """As the importer does it."""
    track = owner.animation_data.nla_tracks.new()
    track.name = track_name
    track.strips.new(action.name, bpy.context.scene.frame_start, action)
    track.lock = track.mute = True


def what_failed(error):
    """An operator's exception contains a traceback and more; the exception's own line is the message."""
    lines = str(error).splitlines()
    return next((line for line in lines if re.match(r'\w*(Error|Exception)\b', line) and 'Python: Traceback' not in line), lines[0])
