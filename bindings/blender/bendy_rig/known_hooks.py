"""Registers this add-on's hooks with Blender's glTF importer and exporter."""
import contextlib

from .program import ADDON


@contextlib.contextmanager
def hooks_in_preferences(context):
    """They look for hooks in the preferences, which do not list an add-on enabled for one run (--addons)."""
    addons = context.preferences.addons
    is_guest = ADDON not in addons
    if is_guest:
        addons.new().module = ADDON
    try:
        yield
    finally:
        if is_guest:
            addons.remove(addons[ADDON])
