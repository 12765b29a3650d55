"""Writes the open scene as a .glb file, with its limits and chains in it."""
import json
import os
import sys

import addon_utils
import bpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'bindings', 'blender'))


def export_glb(path):
    """Every NLA track becomes an animation, sampled at each frame; extras are written; Y is up."""
    addon_utils.enable('bendy_rig')
    options = dict(export_image_format='AUTO', export_all_influences=False, export_morph=True, export_morph_normal=True,
                   export_optimize_animation_size=True)
    options.update({'export_nla_strips': True} if bpy.app.version < (3, 6) else {'export_animation_mode': 'NLA_TRACKS'})
    bpy.ops.export_scene.bendy_rig(filepath=path, options=json.dumps(options))
