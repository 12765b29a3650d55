"""File > Export > glTF with Bendy rig: runs Blender's glTF exporter with this add-on's hooks."""
import json
import os

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from .export_hooks import LastExport
from .written_file import count_records, read_document

ADDON = __package__
# What a rig needs of the exporter; an option that this version of it does not have is left away.
ALWAYS = {'export_yup': True, 'export_extras': True, 'export_skins': True, 'export_force_sampling': True}


class EXPORT_SCENE_OT_bendy_rig(bpy.types.Operator, ExportHelper):
    """Export glTF 2.0 with joint limits and IK chains, which "bendy convert" reads"""
    bl_idname = 'export_scene.bendy_rig'
    bl_label = 'Export glTF with Bendy rig'
    bl_options = {'PRESET'}

    filename_ext = '.glb'
    check_extension = None          # .gltf is as good
    filter_glob: StringProperty(default='*.glb;*.gltf', options={'HIDDEN'})
    use_selection: BoolProperty(name='Selected Objects', description='Export selected objects only', default=False)
    use_visible: BoolProperty(name='Visible Objects', description='Export visible objects only', default=False)
    export_apply: BoolProperty(name='Apply Modifiers', description='Apply modifiers other than armatures; shape keys are lost',
                               default=False)
    export_def_bones: BoolProperty(name='Deformation Bones Only', default=False,
                                   description='Leave out bones that deform nothing, and with them targets and poles')
    export_animations: BoolProperty(name='Animations', description='Export actions and NLA tracks as clips', default=True)
    options: StringProperty(name='Further Options', options={'HIDDEN'}, default='',
                            description='Options of the glTF exporter as a JSON object; they count before the ones above')

    def execute(self, context):
        try:
            path, options = exporter_options(self, context)
            run_exporter(context, path, options)
            check_file(path, LastExport.report)
        except (RuntimeError, OSError, ValueError) as error:
            self.report({'ERROR'}, f'Bendy rig: {what_failed(error)}')
            return {'CANCELLED'}
        if LastExport.report.notes:
            self.report({'WARNING'}, 'Bendy rig: ' + '; '.join(LastExport.report.notes))
        self.report({'INFO'}, f'{os.path.basename(path)}: {LastExport.report.summary()}')
        return {'FINISHED'}


def exporter_options(operator, context):
    """The file to write and the exporter's options: what the scene remembers, this dialogue's, the script's, a rig's needs."""
    known = exporter_properties()
    path = operator.filepath
    if os.path.splitext(path)[1].lower() not in ('.glb', '.gltf'):
        path += '.glb'
    remembered = context.scene.get('glTF2ExportSettings')
    options = {name: value for name, value in (remembered.to_dict() if remembered else {}).items() if name in known}
    for name in ('use_selection', 'use_visible', 'export_apply', 'export_def_bones', 'export_animations'):
        if operator.properties.is_property_set(name) or name not in options:
            options[name] = getattr(operator, name)
    further = json.loads(operator.options or '{}')
    unknown = sorted(set(further) - known)
    if unknown:
        raise ValueError(f'the glTF exporter has no option {", ".join(unknown)}')
    options.update(further)
    options.update({name: value for name, value in ALWAYS.items() if name in known})
    is_glb = path.lower().endswith('.glb')
    if is_glb or options.get('export_format', 'GLB') == 'GLB':
        options['export_format'] = 'GLB' if is_glb else 'GLTF_SEPARATE'
    return path, {**options, 'filepath': path, 'check_existing': False}


def exporter_properties():
    if 'gltf' not in dir(bpy.ops.export_scene):
        raise ValueError('the add-on "glTF 2.0 format" is not enabled')
    return set(bpy.ops.export_scene.gltf.get_rna_type().properties.keys())


def run_exporter(context, path, options):
    """The exporter looks for hooks in the preferences, where an add-on is not that was enabled for one run (--addons)."""
    addons = context.preferences.addons
    is_guest = ADDON not in addons
    if is_guest:
        addons.new().module = ADDON
    frame, influences = context.scene.frame_current, constraint_influences()
    LastExport.must_succeed = True
    try:
        if 'FINISHED' not in bpy.ops.export_scene.gltf(**options):
            raise RuntimeError(f'{path} was not written')
    finally:
        LastExport.must_succeed = False
        if context.scene.frame_current != frame:
            context.scene.frame_set(frame)
        for constraint, influence in influences:
            constraint.influence = influence
        if is_guest:
            addons.remove(addons[ADDON])


def constraint_influences():
    """Where clips animate an influence, the exporter leaves the last clip's value behind, and a second export would write that."""
    return [(c, c.influence) for obj in bpy.data.objects if obj.pose for bone in obj.pose.bones for c in bone.constraints]


def check_file(path, report):
    """The exporter goes on when something goes wrong in a hook, so look at what it wrote."""
    found = count_records(read_document(path))
    if found != (len(report.joints), len(report.chains)):
        raise RuntimeError(f'{path} is incomplete: {found[0]} joints with limits and {found[1]} chains are in it, '
                           f'{report.summary()} should be')


def what_failed(error):
    """An operator's exception holds a traceback; its last line says what it was."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip() and not line.startswith('Location:')]
    return lines[-1].split('RigError: ')[-1] if lines else type(error).__name__


def draw_menu_entry(menu, context):
    menu.layout.operator(EXPORT_SCENE_OT_bendy_rig.bl_idname, text='glTF with Bendy rig (.glb/.gltf)')


def register():
    bpy.utils.register_class(EXPORT_SCENE_OT_bendy_rig)
    bpy.types.TOPBAR_MT_file_export.append(draw_menu_entry)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(draw_menu_entry)
    bpy.utils.unregister_class(EXPORT_SCENE_OT_bendy_rig)
