"""Edit > Preferences > Add-ons > Bendy: the path of the program."""
import bpy
from bpy.props import StringProperty

from .program import ADDON, BendyError, find_program


class BendyPreferences(bpy.types.AddonPreferences):
    bl_idname = ADDON

    program: StringProperty(name='Program', subtype='FILE_PATH', default='',
                            description='The program bendy. If empty, the one on the PATH is used')

    def draw(self, _context):
        self.layout.prop(self, 'program')
        try:
            self.layout.label(text=f'Uses {find_program()}')
        except BendyError as error:
            self.layout.label(text=str(error), icon='ERROR')


def register():
    bpy.utils.register_class(BendyPreferences)


def unregister():
    bpy.utils.unregister_class(BendyPreferences)
