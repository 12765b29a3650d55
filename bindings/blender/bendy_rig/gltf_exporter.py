"""Runs Blender's glTF exporter with this add-on's hooks, and checks what it wrote."""
import contextlib
import json

import bpy

from .export_hooks import LastExport
from .kept_records import REST, kept
from .known_hooks import hooks_in_preferences
from .returned_document import return_documents
from .written_file import count_records, read_document

# The exporter's options that a rig requires; options unknown to this version of the exporter are skipped.
ALWAYS = {'export_yup': True, 'export_extras': True, 'export_skins': True, 'export_force_sampling': True}
WANTED = {'export_cameras': True, 'export_lights': True}     # otherwise their objects would go, too
DIALOGUE = ('use_selection', 'use_visible', 'export_apply', 'export_def_bones', 'export_animations')   # what an operator offers


def exporter_options(operator, context, path, always):
    """The exporter's options: the scene's, the operator's, the script's, the required ones; later ones win."""
    known = exporter_properties()
    remembered = context.scene.get('glTF2ExportSettings')
    options = {**WANTED, **(remembered.to_dict() if remembered else {})}
    options = {name: value for name, value in options.items() if name in known}
    for name in DIALOGUE:
        if operator.properties.is_property_set(name) or name not in options:
            options[name] = getattr(operator, name)
    further = json.loads(operator.options or '{}')
    unknown = sorted(set(further) - known)
    if unknown:
        raise ValueError(f'the glTF exporter has no option {", ".join(unknown)}')
    options.update(further)
    options.update({name: value for name, value in {**ALWAYS, **always}.items() if name in known})
    is_glb = path.lower().endswith('.glb')
    if is_glb or options.get('export_format', 'GLB') == 'GLB':
        options['export_format'] = 'GLB' if is_glb else 'GLTF_SEPARATE'
    return {**options, 'filepath': path, 'check_existing': False}


def exporter_properties():
    if 'gltf' not in dir(bpy.ops.export_scene):
        raise ValueError('the add-on "glTF 2.0 format" is not enabled')
    return set(bpy.ops.export_scene.gltf.get_rna_type().properties.keys())


def run_exporter(context, path, options, is_thinned):
    """Writes the file, or raises RigError if the rig is not in it."""
    frame, influences = context.scene.frame_current, constraint_influences()
    LastExport.must_succeed, LastExport.is_thinned = True, is_thinned
    try:
        with hooks_in_preferences(context), objects_at_rest():
            if 'FINISHED' not in bpy.ops.export_scene.gltf(**options):
                raise RuntimeError(f'{path} was not written')
        for note in return_documents(context.scene, path):
            LastExport.report.add_notes('Kept', [note])
            print(f'  Kept: {note[1]}')
    finally:
        LastExport.must_succeed = LastExport.is_thinned = False
        if context.scene.frame_current != frame:
            context.scene.frame_set(frame)
        for constraint, influence in influences:
            constraint.influence = influence


@contextlib.contextmanager
def objects_at_rest():
    """The exporter writes objects where they are in the current frame. Imported objects that clips move are put at rest."""
    moved = []                      # (owner, its action, data path -> values before)
    try:
        for owner in (*bpy.data.objects, *bpy.data.shape_keys):
            animation, rest = owner.animation_data, kept(owner, REST)
            if not (animation and isinstance(rest, dict)) or not is_in_track(animation):
                continue
            rest = {path: values for path, values in rest.items() if value_of(owner, path) is not None}
            moved.append((owner, animation.action, {path: value_of(owner, path) for path in rest}))
            animation.action = None
            for path, values in rest.items():
                set_value(owner, path, values)
        yield
    finally:
        for owner, action, before in moved:
            for path, values in before.items():
                set_value(owner, path, values)
            owner.animation_data.action = action


def is_in_track(animation):
    """Whether the exporter finds the active action even if it is not active."""
    return animation.action is None or any(strip.action == animation.action for track in animation.nla_tracks for strip in track.strips)


def value_of(owner, path):
    """The value as a list of floats, or None if the path no longer exists."""
    try:
        value = owner.path_resolve(path)
    except ValueError:
        return None
    return [value] if isinstance(value, float) else list(value)


def set_value(owner, path, values):
    place, _, name = path.rpartition('.')
    part = owner.path_resolve(place) if place else owner
    setattr(part, name, values[0] if len(values) == 1 else values)


def constraint_influences():
    """If clips animate an influence, the exporter leaves the last clip's value behind, and a second export would write it."""
    return [(c, c.influence) for obj in bpy.data.objects if obj.pose for bone in obj.pose.bones for c in bone.constraints]


def check_file(path, report):
    """The exporter continues after an error in a hook, so this checks the file."""
    found = count_records(read_document(path))
    if found != (len(report.joints), len(report.chains)):
        raise RuntimeError(f'{path} is incomplete: {found[0]} joints with limits and {found[1]} chains are in it, '
                           f'{report.summary()} should be')


def what_failed(error):
    """An operator's exception contains a traceback; its last line is the message."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip() and not line.startswith('Location:')]
    return lines[-1].split('RigError: ')[-1] if lines else type(error).__name__
