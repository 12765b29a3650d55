"""Cameras and lights of an imported file: an export returns their records, unless they were changed in Blender."""
from .kept_extras import keep_extras, returned_extras
from .kept_records import RECORD, keep, kept

SETTINGS = {'Camera': ('type', 'lens', 'sensor_width', 'sensor_height', 'sensor_fit', 'ortho_scale', 'clip_start', 'clip_end', 'shift_x', 'shift_y'),
            'Light': ('type', 'color', 'energy', 'spot_size', 'spot_blend')}
CHANGED = (False, 'was changed since the import: written as Blender has it')


def settings(data):
    """Of the data of a camera or a light, as JSON has them."""
    names = SETTINGS['Camera' if data.bl_rna.identifier == 'Camera' else 'Light']
    values = {name: getattr(data, name) for name in names if hasattr(data, name)}
    return {name: value if isinstance(value, (str, float)) else list(value) for name, value in values.items()}


def keep_cameras_and_lights(gltf, document):
    """gltf: the importer's state, in which the objects are made; document: the JSON of its file."""
    lights = document.get('extensions', {}).get('KHR_lights_punctual', {}).get('lights', [])
    for vnode in gltf.vnodes.values():
        data = getattr(getattr(vnode, 'blender_object', None), 'data', None)
        if getattr(vnode, 'camera_node_idx', None) is not None and data is not None:
            keep_record(data, document['cameras'][document['nodes'][vnode.camera_node_idx]['camera']])
        elif getattr(vnode, 'light_node_idx', None) is not None and data is not None:
            keep_record(data, lights[document['nodes'][vnode.light_node_idx]['extensions']['KHR_lights_punctual']['light']])


def keep_record(data, record):
    keep(data, RECORD, {'record': record, 'settings': settings(data)})
    keep_extras(data, record.get('extras'))


def returned_record(data):
    """(the record, or None, notes)"""
    record = kept(data, RECORD)
    if not isinstance(record, dict):
        return None, []
    return (record['record'], []) if record['settings'] == settings(data) else (None, [CHANGED])


def return_camera(camera, data):
    """camera: of the exporter. Returns notes."""
    from io_scene_gltf2.io.com import gltf2_io
    record, notes = returned_record(data)
    if record is not None:
        returned = gltf2_io.Camera.from_dict(record)
        for name in ('name', 'type', 'perspective', 'orthographic', 'extensions'):
            setattr(camera, name, getattr(returned, name))
    return notes


def return_light(node, data):
    """node: of the exporter, that has the light. Returns notes."""
    record, notes = returned_record(data)
    extension = (node.extensions or {}).get('KHR_lights_punctual')
    light = extension and extension.extension['light'].extension
    if light is not None and record is not None:
        extras = light.get('extras')
        light.clear()
        light.update({key: value for key, value in record.items() if key != 'extras'}, extras=extras)
    if light is not None:
        extras = returned_extras(light.pop('extras', None), data)
        light.update({'extras': extras} if extras else {})
        extension.required = extension.extension['light'].required = False
    return notes
