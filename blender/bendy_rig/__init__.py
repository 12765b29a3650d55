"""Writes a rig's joint limits and IK chains into the extras of a glTF file, in the layout of Bendy's spec/rig.md."""
from . import export_operator
from .export_hooks import finish_export as glTF2_post_export_callback       # the exporter looks for these two names
from .export_hooks import RigExtras as glTF2ExportUserExtension

__all__ = ['glTF2ExportUserExtension', 'glTF2_post_export_callback', 'register', 'unregister']

bl_info = {
    'name': 'Bendy rig',
    'author': 'The Bendy authors',
    'description': 'Joint limits and IK chains in the extras of glTF files',
    'version': (0, 1, 0),
    'blender': (3, 4, 0),
    'location': 'File > Export > glTF with Bendy rig',
    'category': 'Import-Export',
}


def register():
    export_operator.register()


def unregister():
    export_operator.unregister()
