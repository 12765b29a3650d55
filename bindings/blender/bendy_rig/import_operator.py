"""File > Import > Bendy."""
import os

import bpy
from bpy.props import BoolProperty, CollectionProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from .import_file import import_file
from .program import BendyError

SHOWN = 3                           # names in a report; the console prints all


class IMPORT_SCENE_OT_bendy(bpy.types.Operator, ImportHelper):
    """Import characters from Bendy files"""
    bl_idname = 'import_scene.bendy'
    bl_label = 'Import Bendy'
    bl_options = {'PRESET', 'UNDO'}

    filename_ext = '.bendy'
    filter_glob: StringProperty(default='*.bendy', options={'HIDDEN'})
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={'HIDDEN', 'SKIP_SAVE'})
    directory: StringProperty(subtype='DIR_PATH', options={'HIDDEN', 'SKIP_SAVE'})
    enable_constraints: BoolProperty(name='Enable Constraints', default=False,
                                     description='Let limits and IK act at once. They are muted otherwise, so that clips play as stored')
    set_frame_rate: BoolProperty(name='Set Frame Rate and Range', default=True,
                                 description='Give the scene a frame rate that puts keys on frames, unless it has animation already')

    def execute(self, context):
        paths = [os.path.join(self.directory, file.name) for file in self.files if file.name] or [self.filepath]
        manager, is_any_read = context.window_manager, False
        if context.mode != 'OBJECT':
            bpy.ops.object.mode_set(mode='OBJECT')
        manager.progress_begin(0, 100)
        try:
            for number, path in enumerate(paths):
                progress = lambda share, number=number: manager.progress_update(round(100 * (number + share) / len(paths)))
                try:
                    self.tell(path, import_file(context, bpy.path.abspath(path), self.enable_constraints, self.set_frame_rate, progress))
                    is_any_read = True
                except (BendyError, OSError) as error:
                    self.report({'ERROR'}, f'Bendy: {error}')
        finally:
            manager.progress_end()
        return {'FINISHED'} if is_any_read else {'CANCELLED'}

    def tell(self, path, imported):
        for text in imported.warnings:
            self.report({'WARNING'}, f'Bendy: {text}')
        if imported.notes:
            print('\n'.join(['Bendy: what Blender does not do as the file says; an export returns the rig as it was:',
                             *(f'  {text}: {", ".join(names)}' for text, names in imported.notes)]))
            notes = '; '.join(f'{text} ({shortened(names)})' for text, names in imported.notes)
            self.report({'WARNING'}, f'Bendy: not as in the file: {notes}')
        if imported.kept:
            self.report({'WARNING'}, f'Bendy: Blender does not know {shortened(imported.kept)}: kept in the scene, and returned by an export')
            print(f'Bendy: kept for an export: {", ".join(imported.kept)}')
        muted = '' if self.enable_constraints or not (imported.limits or imported.chains) else \
            ', muted so that clips play as stored: Pose > Constraints > Enable Imported Constraints'
        self.report({'INFO'}, f'{os.path.basename(path)}: {count(imported.clips, "clip")}, {count(imported.limits, "limit")}, '
                              f'{count(imported.chains, "IK chain")}{muted}')


def count(number, name):
    return f'{number} {name}' + ('' if number == 1 else 's')


def shortened(names):
    return ', '.join(names) if len(names) <= SHOWN else f'{", ".join(names[:SHOWN])} and {len(names) - SHOWN} more'


def draw_menu_entry(menu, _context):
    menu.layout.operator(IMPORT_SCENE_OT_bendy.bl_idname, text='Bendy (.bendy)')


def register():
    bpy.utils.register_class(IMPORT_SCENE_OT_bendy)
    bpy.types.TOPBAR_MT_file_import.append(draw_menu_entry)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(draw_menu_entry)
    bpy.utils.unregister_class(IMPORT_SCENE_OT_bendy)
