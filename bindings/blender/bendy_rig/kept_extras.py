"""Extras whose values Blender's custom properties change, or do not hold: an export returns them, unless they were changed."""
import json

from .kept_records import EXTRAS, keep, kept, without_kept


def exported_extras(owner):
    """What Blender's exporter makes of the custom properties."""
    try:
        from io_scene_gltf2.blender.com.gltf2_blender_extras import generate_extras
    except ImportError:             # newer exporters
        from io_scene_gltf2.blender.com.extras import generate_extras
    return generate_extras(owner) or {}


def keep_extras(owner, extras, exported=None):
    """exported: has the custom properties that the importer made of the extras, if that is not the owner itself."""
    if not isinstance(extras, dict):
        return
    now = exported_extras(exported or owner)
    changed = {key: [value, json.loads(json.dumps(now.get(key), default=str))] for key, value in extras.items() if not is_same(now.get(key), value)}
    if changed:
        keep(owner, EXTRAS, changed)


def returned_extras(extras, owner):
    """The extras of an export: the file's where they are as imported, and without the records of this add-on."""
    returned = dict(extras or {})
    for key, (value, then) in (kept(owner, EXTRAS) or {}).items():
        if is_same(returned.get(key), then):
            returned[key] = value
    return without_kept(returned)


def is_same(a, b):
    """As JSON: true is not 1, but 1.0 is 1."""
    a, b = (json.dumps(json.loads(json.dumps(value, default=str), parse_int=float), sort_keys=True) for value in (a, b))
    return a == b
