"""Writes the open scene as a .glb file, with rig_extras' limits and chains in it."""
import json
import struct

import addon_utils
import bpy


def export_glb(path):
    """Every NLA track becomes an animation, sampled at each frame; extras are written; Y is up."""
    addon_utils.enable('rig_extras', default_set=True)      # --addons would not do: the exporter reads the preferences
    bpy.ops.export_scene.gltf(
        filepath=path, export_format='GLB', export_yup=True, export_extras=True, export_image_format='AUTO',
        export_skins=True, export_all_influences=False, export_morph=True, export_morph_normal=True,
        export_animations=True, export_nla_strips=True, export_force_sampling=True, export_optimize_animation_size=True)
    require_rig_extras(path)


def require_rig_extras(path):
    """The exporter prints what goes wrong in a hook and goes on, so look at what it wrote."""
    with open(path, 'rb') as file:
        _, _, _, length, _ = struct.unpack('<5I', file.read(20))
        nodes = json.loads(file.read(length))['nodes']
    if not any('rig_ik' in node.get('extras', {}) for node in nodes):
        raise RuntimeError(f'{path}: the rig is not in the extras')
