"""Makes the hooks of this add-on known to Blender's glTF importer and exporter."""
import contextlib

from .program import ADDON


@contextlib.contextmanager
def hooks_in_preferences(context):
    """They look for hooks in the preferences, where an add-on is not that was enabled for one run (--addons)."""
    addons = context.preferences.addons
    is_guest = ADDON not in addons
    if is_guest:
        addons.new().module = ADDON
    try:
        yield
    finally:
        if is_guest:
            addons.remove(addons[ADDON])
