"""Properties > Bone > Bendy Limits: the limits from an imported file, even those without a setting in Blender."""
import bpy

from .joint_settings import bone_settings, described
from .kept_records import CONSTRAINTS, kept, kept_limits


def active_bone(context):
    """The pose bone that the properties editor shows; None if there is none."""
    rig, bone = context.object, getattr(context, 'bone', None) or getattr(context, 'active_bone', None)
    return rig.pose.bones.get(bone.name) if bone and rig and rig.pose else None


def lines_of(bone):
    """(icon, text) of each line."""
    record = kept(bone, CONSTRAINTS)
    lines = [('CON_ROTLIMIT', text) for constraint in record for text in described(constraint)]
    if kept_limits(bone)[1]:
        return [*lines, ('INFO', 'Changed since the import: an export writes what Blender has')]
    return lines + [('INFO', f'Blender: {note}') for note in bone_settings(record)[1]]


class BONE_PT_bendy_limits(bpy.types.Panel):
    bl_label = 'Bendy Limits'
    bl_space_type = 'PROPERTIES'
    bl_region_type = 'WINDOW'
    bl_context = 'bone'

    @classmethod
    def poll(cls, context):
        bone = active_bone(context)
        return bone is not None and bool(kept(bone, CONSTRAINTS))

    def draw(self, context):
        column = self.layout.column(align=True)
        for icon, text in lines_of(active_bone(context)):
            column.label(text=text, icon=icon)


def register():
    bpy.utils.register_class(BONE_PT_bendy_limits)


def unregister():
    bpy.utils.unregister_class(BONE_PT_bendy_limits)
