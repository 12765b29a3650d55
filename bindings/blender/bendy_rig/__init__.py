"""Imports and exports Bendy files, and writes joint limits and IK chains into the extras of glTF files (Bendy's spec/rig.md)."""
from . import export_operator, import_operator, limits_panel, pose_constraints, preferences
from .export_hooks import finish_export as glTF2_post_export_callback       # the exporter looks for these names
from .export_hooks import RigExtras as glTF2ExportUserExtension
from .import_hooks import ImportHooks as glTF2ImportUserExtension

__all__ = ['glTF2ExportUserExtension', 'glTF2ImportUserExtension', 'glTF2_post_export_callback', 'register', 'unregister']

bl_info = {
    'name': 'Bendy',
    'author': 'The Bendy authors',
    'description': 'Import and export characters with joint limits and IK chains',
    'version': (0, 1, 0),
    'blender': (3, 4, 0),
    'location': 'File > Import, File > Export',
    'category': 'Import-Export',
}
PARTS = (preferences, import_operator, export_operator, pose_constraints, limits_panel)


def register():
    for part in PARTS:
        part.register()


def unregister():
    for part in reversed(PARTS):
        part.unregister()
