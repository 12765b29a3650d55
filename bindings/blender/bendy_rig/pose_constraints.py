"""Pose > Constraints: enables or mutes the constraints that an import made."""
import bpy
from bpy.props import BoolProperty

from .kept_records import is_imported

KINDS = ('LIMIT_ROTATION', 'LIMIT_LOCATION', 'IK')


class POSE_OT_bendy_constraints(bpy.types.Operator):
    """Let the imported limits and IK chains of the armature act, or mute them so that clips play as stored"""
    bl_idname = 'pose.bendy_constraints'
    bl_label = 'Imported Constraints'
    bl_options = {'REGISTER', 'UNDO'}

    enable: BoolProperty(name='Enable', default=True)

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == 'ARMATURE'

    def execute(self, context):
        found = [constraint for bone in context.object.pose.bones for constraint in bone.constraints
                 if constraint.type in KINDS and is_imported(bone, constraint)]
        for constraint in found:
            constraint.mute = not self.enable
        self.report({'INFO'}, f'{len(found)} constraints {"enabled" if self.enable else "muted"}')
        return {'FINISHED'} if found else {'CANCELLED'}


def draw_menu_entries(menu, _context):
    menu.layout.separator()
    menu.layout.operator(POSE_OT_bendy_constraints.bl_idname, text='Enable Imported Constraints').enable = True
    menu.layout.operator(POSE_OT_bendy_constraints.bl_idname, text='Mute Imported Constraints').enable = False


def register():
    bpy.utils.register_class(POSE_OT_bendy_constraints)
    bpy.types.VIEW3D_MT_pose_constraints.append(draw_menu_entries)


def unregister():
    bpy.types.VIEW3D_MT_pose_constraints.remove(draw_menu_entries)
    bpy.utils.unregister_class(POSE_OT_bendy_constraints)
