"""File > Export > Bendy, and > glTF with Bendy rig: both run Blender's glTF exporter with this add-on's hooks."""
import os
import tempfile

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from .export_hooks import LastExport
from .gltf_exporter import check_file, exporter_options, run_exporter, what_failed
from .kept_records import is_imported
from .program import BendyError, find_program, run_program

# A clip is its whole action, at every frame, and vertices keep all their influences.
BENDY_OPTIONS = {'export_format': 'GLB', 'export_frame_range': False, 'export_optimize_animation_size': False,
                 'export_all_influences': True}
KEPT = 'kept as JSON'               # the program warns of what it does not interpret: that is in the file
PARTS = 3                           # of an export, for the progress bar: Blender's exporter takes most of the time


def has_enabled_chain(rig):
    return rig.type == 'ARMATURE' and any(constraint.type == 'IK' and not constraint.mute and is_imported(bone, constraint)
                                          for bone in rig.pose.bones for constraint in bone.constraints)


class ExportOptions:
    """The options of both operators."""
    use_selection: BoolProperty(name='Selected Objects', description='Export selected objects only', default=False)
    use_visible: BoolProperty(name='Visible Objects', description='Export visible objects only', default=False)
    export_apply: BoolProperty(name='Apply Modifiers', description='Apply modifiers other than armatures; shape keys are lost',
                               default=False)
    export_def_bones: BoolProperty(name='Deformation Bones Only', default=False,
                                   description='Leave out bones that deform nothing, and with them targets and poles')
    export_animations: BoolProperty(name='Animations', description='Export actions and NLA tracks as clips', default=True)
    options: StringProperty(name='Further Options', options={'HIDDEN'}, default='',
                            description='Options of the glTF exporter as a JSON object; they count before the ones above')

    def tell(self, path):
        if LastExport.report.notes:
            self.report({'WARNING'}, f'{self.bl_label}: {"; ".join(LastExport.report.notes)}')
        self.report({'INFO'}, f'{os.path.basename(path)}: {LastExport.report.summary()}')

    def warn_of_enabled_chains(self, context):
        """Blender's exporter plays each clip with the constraints as they are now."""
        if self.export_animations and len(bpy.data.actions) > 1 and any(map(has_enabled_chain, context.scene.objects)):
            self.report({'WARNING'}, f'{self.bl_label}: imported IK constraints are enabled, so they act in all {len(bpy.data.actions)} actions: '
                                     'to keep the others as they are, export this one alone and add it with "bendy edit --merge"')

    def fail(self, error):
        self.report({'ERROR'}, f'{self.bl_label}: {what_failed(error)}')
        return {'CANCELLED'}


class EXPORT_SCENE_OT_bendy(bpy.types.Operator, ExportHelper, ExportOptions):
    """Export characters as a Bendy file"""
    bl_idname = 'export_scene.bendy'
    bl_label = 'Export Bendy'
    bl_options = {'PRESET'}

    filename_ext = '.bendy'
    filter_glob: StringProperty(default='*.bendy', options={'HIDDEN'})
    compact: BoolProperty(name='Compact', default=False,
                          description='Minimise the file\'s size, by an error of at most 0.005% of the character\'s height')

    def execute(self, context):
        path, manager = bpy.path.ensure_ext(bpy.path.abspath(self.filepath), '.bendy'), context.window_manager
        self.warn_of_enabled_chains(context)
        manager.progress_begin(0, PARTS)
        try:
            find_program()          # before the long part
            with tempfile.TemporaryDirectory(prefix='bendy') as folder:
                glb = os.path.join(folder, 'scene.glb')
                run_exporter(context, glb, exporter_options(self, context, glb, BENDY_OPTIONS), is_thinned=True)
                check_file(glb, LastExport.report)
                manager.progress_update(PARTS - 1)
                warnings = run_program('convert', glb, '--output', path, *(['--compact'] if self.compact else []))
        except (RuntimeError, OSError, ValueError, BendyError) as error:
            return self.fail(error)
        finally:
            manager.progress_end()
        told = [note.split(': ', 1)[1] for note in LastExport.report.notes]
        for text in warnings:
            if not any(note in text for note in (*told, KEPT)):
                self.report({'WARNING'}, f'{self.bl_label}: {text.removeprefix(glb + ": ")}')
        self.tell(path)
        return {'FINISHED'}


class EXPORT_SCENE_OT_bendy_rig(bpy.types.Operator, ExportHelper, ExportOptions):
    """Export glTF 2.0 with joint limits and IK chains, which "bendy convert" reads"""
    bl_idname = 'export_scene.bendy_rig'
    bl_label = 'Export glTF with Bendy rig'
    bl_options = {'PRESET'}

    filename_ext = '.glb'
    check_extension = None          # .gltf is allowed too
    filter_glob: StringProperty(default='*.glb;*.gltf', options={'HIDDEN'})

    def execute(self, context):
        path = self.filepath
        if os.path.splitext(path)[1].lower() not in ('.glb', '.gltf'):
            path += '.glb'
        self.warn_of_enabled_chains(context)
        try:
            run_exporter(context, path, exporter_options(self, context, path, {}), is_thinned=False)
            check_file(path, LastExport.report)
        except (RuntimeError, OSError, ValueError) as error:
            return self.fail(error)
        self.tell(path)
        return {'FINISHED'}


def draw_menu_entries(menu, _context):
    menu.layout.operator(EXPORT_SCENE_OT_bendy.bl_idname, text='Bendy (.bendy)')
    menu.layout.operator(EXPORT_SCENE_OT_bendy_rig.bl_idname, text='glTF with Bendy rig (.glb/.gltf)')


CLASSES = (EXPORT_SCENE_OT_bendy, EXPORT_SCENE_OT_bendy_rig)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.TOPBAR_MT_file_export.append(draw_menu_entries)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(draw_menu_entries)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
