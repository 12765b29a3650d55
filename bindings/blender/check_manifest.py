"""The rules that Blender 4.2 has for the manifest of an add-on (schema 1.0.0), as its manual states them. Blender itself checks them
only where an extension is built or published: check_manifest.py MANIFEST prints what is wrong."""
import re
import sys
import tomllib
from pathlib import Path

REQUIRED = {'schema_version': str, 'id': str, 'version': str, 'name': str, 'tagline': str, 'maintainer': str, 'type': str,
            'blender_version_min': str, 'license': list}
OPTIONAL = {'blender_version_max': str, 'website': str, 'copyright': list, 'tags': list, 'platforms': list, 'wheels': list,
            'permissions': dict, 'build': dict}
PERMISSIONS = {'files', 'network', 'clipboard', 'camera', 'microphone'}
PLATFORMS = {'windows-x64', 'windows-arm64', 'macos-x64', 'macos-arm64', 'linux-x64'}
TAGS = {'3D View', 'Add Curve', 'Add Mesh', 'Animation', 'Bake', 'Camera', 'Compositing', 'Development', 'Game Engine', 'Geometry Nodes',
        'Grease Pencil', 'Import-Export', 'Lighting', 'Material', 'Mesh', 'Modeling', 'Node', 'Object', 'Paint', 'Physics', 'Pipeline',
        'Render', 'Rigging', 'Scene', 'Sculpt', 'Sequencer', 'System', 'Text Editor', 'Tracking', 'User Interface', 'UV'}
VERSION = re.compile(r'(0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*)')
OLDEST = (4, 2, 0)  # Blender's first version with extensions
MOST = 64  # characters of a tagline, and of the reason for a permission


def field_faults(manifest):
    for key, kind in REQUIRED.items():
        if not manifest.get(key):
            yield f'{key} is missing'
    for key, value in manifest.items():
        kind = REQUIRED.get(key) or OPTIONAL.get(key)
        if kind is None:
            yield f'{key} is not of the schema'
        elif not isinstance(value, kind):
            yield f'{key} is not of type {kind.__name__}'
        elif kind is list and not (value and all(isinstance(item, str) for item in value)):
            yield f'{key} is not a list of strings'


def sentence_faults(key, text):
    """A tagline or a reason: one line, short, without a full stop."""
    if not isinstance(text, str) or text != ' '.join(text.split()) or not text:
        yield f'{key} is not a single line of text'
    elif len(text) > MOST:
        yield f'{key} has {len(text)} characters; {MOST} are allowed'
    elif not (text[-1].isalnum() or text[-1] in ')]}'):
        yield f'{key} ends with {text[-1]}'


def version_faults(manifest):
    for key in ('version', 'blender_version_min', 'blender_version_max'):
        if key in manifest and not VERSION.fullmatch(manifest[key]):
            yield f'{key} is {manifest[key]}, and no version of three numbers'
        elif key == 'blender_version_min' and tuple(map(int, manifest[key].split('.'))) < OLDEST:
            yield f'{key} is before 4.2.0'


def value_faults(manifest):
    if manifest['schema_version'] != '1.0.0':
        yield f'schema_version is {manifest["schema_version"]}'
    if not manifest['id'].isidentifier() or '__' in manifest['id'] or manifest['id'].startswith('_') or manifest['id'].endswith('_'):
        yield f'id is {manifest["id"]}'
    if manifest['type'] != 'add-on':
        yield f'type is {manifest["type"]}'
    if manifest['name'] != manifest['name'].strip():
        yield 'name begins or ends with a space'
    yield from version_faults(manifest)
    yield from sentence_faults('tagline', manifest['tagline'])
    yield from (f'license {name} has no SPDX:' for name in manifest['license'] if not re.fullmatch(r'SPDX:[\w.+-]+', name))
    yield from (f'copyright {text} is not YEAR NAME' for text in manifest.get('copyright', ()) if not re.fullmatch(r'\d{4}(-\d{4})? .+', text))
    yield from (f'tag {tag} is unknown' for tag in manifest.get('tags', ()) if tag not in TAGS)
    yield from (f'platform {name} is unknown' for name in manifest.get('platforms', ()) if name not in PLATFORMS)
    for name, reason in manifest.get('permissions', {}).items():
        if name not in PERMISSIONS:
            yield f'permission {name} is unknown'
        yield from sentence_faults(f'permission {name}', reason)


def faults(text):
    """What is wrong with the text of a manifest: a list of sentences."""
    try:
        manifest = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        return [str(error)]
    return list(field_faults(manifest)) or list(value_faults(manifest))


if __name__ == '__main__':
    found = faults(Path(sys.argv[1]).read_text(encoding='utf-8'))
    print('\n'.join(found), end='\n' if found else '')
    sys.exit(1 if found else 0)
