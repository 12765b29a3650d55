"""Installs the add-on from its zip, imports a bendy file, and counts the bones that a clip turns:
blender -b --factory-startup --python first_pose_in_blender.py -- ADDON.zip FILE.bendy"""
import sys

import bpy

archive, file = sys.argv[sys.argv.index('--') + 1:]
bpy.ops.preferences.addon_install(filepath=archive)
bpy.ops.preferences.addon_enable(module='bendy_rig')
bpy.ops.import_scene.bendy(filepath=file)

rig = next(thing for thing in bpy.context.scene.objects if thing.type == 'ARMATURE')
bpy.context.scene.frame_set(bpy.context.scene.frame_start + 10)
bpy.context.view_layer.update()
turned = [bone for bone in rig.pose.bones if bone.matrix_basis.to_quaternion().angle > 0.01]
print(f'\nturned {len(turned)} bones')
