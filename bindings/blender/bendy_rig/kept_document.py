"""What a glTF file says and Blender does not know: an import keeps it as JSON in a custom property of the scene, and an export writes it
into the new file again, where its joints, meshes and materials still are.

Each of these has a mark, which an export finds in the new file's extras, and takes out: FILE:NUMBER, its number in the file.
"""
import copy
import hashlib
import json
import os
import re

import bpy

from .kept_records import DOCUMENTS, MARK, keep, kept
from .references import Renumberer
from .written_file import image_bytes

OWN = 'BENDY_'                      # extensions that the add-on makes of Blender's settings
# Members that Blender's importer and exporter know.
KNOWN = {
    'root': {'asset', 'scene', 'scenes', 'nodes', 'meshes', 'materials', 'textures', 'images', 'samplers', 'skins', 'animations', 'cameras',
             'accessors', 'bufferViews', 'buffers', 'extensionsUsed', 'extensionsRequired'},
    'scenes': {'nodes', 'extras'},
    'nodes': {'name', 'children', 'matrix', 'translation', 'rotation', 'scale', 'mesh', 'skin', 'weights', 'camera', 'extras'},
    'meshes': {'name', 'primitives', 'weights', 'extras'},
    'materials': {'name', 'pbrMetallicRoughness', 'normalTexture', 'occlusionTexture', 'emissiveTexture', 'emissiveFactor', 'alphaMode',
                  'alphaCutoff', 'doubleSided', 'extras'},
}
HOSTS = {'root': 'root', 'nodes': 'node', 'materials': 'material'}
# Objects that Blender creates anew, with the members that it keeps.
MADE_ANEW = {'textures': {'source', 'sampler'}, 'images': {'uri', 'bufferView', 'mimeType', 'name'},
             'samplers': {'magFilter', 'minFilter', 'wrapS', 'wrapT'}, 'skins': {'joints', 'inverseBindMatrices', 'skeleton', 'name'}}
TEXTURE_INFO = {'index', 'texCoord', 'scale', 'strength'}
ATTRIBUTES = re.compile(r'POSITION|NORMAL|(TEXCOORD|COLOR)_[0-7]|(JOINTS|WEIGHTS)_\d+')       # of vertices; Blender makes tangents anew
MOVED = ('POSITION', 'NORMAL')      # by morph targets
WITH_ACCESSORS = ('EXT_mesh_gpu_instancing',)       # their numbers are of data, which is not kept


# ------------------------------------------------------------------------------------------------- an import

def unknown_members(thing, kind, managed):
    """The members of a thing that Blender does not know. managed: the extensions that its importer knows."""
    found = {key: value for key, value in thing.items() if key not in KNOWN[kind] and key != 'extensions'}
    extensions = {name: value for name, value in extensions_of(thing).items() if name not in managed and not name.startswith(OWN)}
    return {**found, 'extensions': extensions} if extensions else found


def extensions_of(thing):
    extensions = thing.get('extensions')
    return extensions if isinstance(extensions, dict) else {}


class Keeper:
    """Takes from a file what Blender does not know, before its importer reads the file."""

    def __init__(self, path, document, binary, managed):
        self.path, self.document, self.binary, self.managed = path, document, binary, managed
        self.lost = []              # what is not kept: places
        self.kept = {'names': {}, 'targets': {}, 'textures': {}, 'images': {}}
        for kind in ('nodes', 'meshes', 'materials'):
            self.kept[kind] = self.take_all(kind)
        self.kept['meshes_of_nodes'] = {str(number): node['mesh'] for number, node in enumerate(document.get('nodes', [])) if 'mesh' in node}
        self.kept['root'] = self.take(document, 'root', '')
        scenes = document.get('scenes', [])
        self.kept['scene'] = self.take(scenes[document.get('scene', 0)], 'scenes', 'scenes') if scenes else {}
        self.kept['used'], self.kept['required'] = document.get('extensionsUsed', []), document.pop('extensionsRequired', [])
        self.note_lost()
        self.note_textures()

    def take_all(self, kind):
        taken = {str(number): self.take(thing, kind, f'{kind}[{number}]') for number, thing in enumerate(self.document.get(kind, []))}
        return {number: members for number, members in taken.items() if members}

    def take(self, thing, kind, place):
        taken = copy.deepcopy(unknown_members(thing, kind, self.managed))
        for name in WITH_ACCESSORS:
            if taken.get('extensions', {}).pop(name, None) is not None:
                self.lost.append(f'{place}.extensions.{name}')
        return taken

    def names(self):
        """What is kept, in words: the extensions, and other members."""
        found = {}
        for things in (self.kept['root'], self.kept['scene'], *(thing for kind in ('nodes', 'meshes', 'materials') for thing in self.kept[kind].values())):
            found |= dict.fromkeys([*things.get('extensions', {}), *(key for key in things if key not in ('extensions', 'name'))])
        return list(found)

    def note_lost(self):
        for kind, known in MADE_ANEW.items():
            for number, thing in enumerate(self.document.get(kind, [])):
                self.lost += [f'{kind}[{number}].{key}' for key in thing if key not in known and not (kind == 'textures' and self.is_images_name(thing, key))]
        for number, material in enumerate(self.document.get('materials', [])):
            known = {key: value for key, value in material.items() if key in KNOWN['materials'] and key != 'extras'}
            known['extensions'] = {name: value for name, value in extensions_of(material).items() if name in self.managed}
            self.note_texture_infos(known, f'materials[{number}]')
        attributes = {}
        for number, mesh in enumerate(self.document.get('meshes', [])):
            for primitive in mesh['primitives']:
                found = [name for name in primitive['attributes'] if not ATTRIBUTES.fullmatch(name)]
                found += [f'{name} of targets' for target in primitive.get('targets', []) for name in target if name not in MOVED]
                for name in found:
                    attributes.setdefault(name, {})[mesh.get('name') or f'meshes[{number}]'] = None
        self.lost += [f'{name} ({", ".join(meshes)})' for name, meshes in attributes.items()]

    def is_images_name(self, texture, key):
        """`bendy convert` gives a texture that an image of an extension has become the image's name."""
        images = self.document.get('images', [])
        return key == 'name' and texture.get('source', -1) in range(len(images)) and images[texture['source']].get('name') == texture['name']

    def note_texture_infos(self, value, place):
        waiting = [(value, place)]
        while waiting:
            value, place = waiting.pop()
            if 'extras' in value and not place.endswith(']'):
                self.lost.append(f'{place}.extras')
            if isinstance(value.get('index'), int):
                self.lost += [f'{place}.{key}' for key in value if key not in TEXTURE_INFO and key not in ('extras', 'extensions')]
                self.lost += [f'{place}.extensions.{name}' for name in extensions_of(value) if name not in self.managed]
            waiting += [(each, f'{place}.{key}') for key, each in value.items() if isinstance(each, dict) and key != 'extras']

    def note_textures(self):
        """The textures and images that extensions name."""
        def note(thing, number, *_):
            if thing == 'texture':
                self.keep_texture(number)
            elif thing == 'image':
                self.keep_image(number)
            return number
        renumber_all(copy.deepcopy(self.kept), Renumberer(note))

    def keep_texture(self, number):
        textures = self.document.get('textures', [])
        if not 0 <= number < len(textures) or str(number) in self.kept['textures']:
            return
        texture = self.kept['textures'][str(number)] = copy.deepcopy(textures[number])
        if 'sampler' in texture:
            texture['sampler'] = self.document['samplers'][texture['sampler']]
        for owner in sources(texture):
            self.keep_image(owner['source'])
        self.lost = [place for place in self.lost if not place.startswith(f'textures[{number}].')]

    def keep_image(self, number):
        if str(number) in self.kept['images'] or not 0 <= number < len(self.document.get('images', [])):
            return
        image = self.document['images'][number]
        data = image_bytes(self.path, self.document, self.binary, image)
        if data is not None:
            record = {key: value for key, value in image.items() if key not in ('uri', 'bufferView')}
            self.kept['images'][str(number)] = {**record, 'sha256': hashlib.sha256(data).hexdigest()}

    def finish(self, scene, joints, meshes, materials):
        """After the import. joints: joint -> (object, name of the bone in it, or None); the others: (number in the file, Blender's)."""
        names = self.names()
        if not names:
            return names
        documents = kept(scene, DOCUMENTS) or {}
        key = hashlib.sha256(json.dumps(self.kept, sort_keys=True).encode()).hexdigest()[:8]
        key = next(name for name in (f'{key}.{number}' for number in range(len(documents) + 1)) if name not in documents)
        self.kept['names'] = {str(number): bone or obj.name for number, (obj, bone) in enumerate(joints)}
        owners = [(number, obj.pose.bones[bone] if bone else obj) for number, (obj, bone) in enumerate(joints)]
        for number, owner in (*owners, *meshes, *materials):
            owner[MARK] = f'{key}:{number}'
        for number, mesh in meshes:
            if mesh.shape_keys:
                self.kept['targets'][str(number)] = [block.name for block in mesh.shape_keys.key_blocks[1:]]
        self.keep_pictures()
        documents[key] = self.kept
        keep(scene, DOCUMENTS, documents)
        return names

    def keep_pictures(self):
        """Blender reads only the pictures that it draws."""
        there = {digest for digest, _ in packed_pictures()}
        for number, record in self.kept['images'].items():
            if record['sha256'] not in there:
                data = image_bytes(self.path, self.document, self.binary, self.document['images'][int(number)])
                image = bpy.data.images.new(record.get('name') or f'image {number}', 1, 1)
                image.pack(data=data, data_len=len(data))
                image.source, image.use_fake_user = 'FILE', True


def sources(texture):
    """What in a texture has an image: itself, and extensions for other kinds of images."""
    return [owner for owner in (texture, *extensions_of(texture).values()) if isinstance(owner, dict) and isinstance(owner.get('source'), int)]


def packed_pictures():
    """(SHA-256, bytes) of the images of Blender that have a file."""
    for image in bpy.data.images:
        data = picture_bytes(image)
        if data:
            yield hashlib.sha256(data).hexdigest(), data


def picture_bytes(image):
    if image.packed_file:
        return bytes(image.packed_file.data)
    path = bpy.path.abspath(image.filepath) if image.filepath else ''
    if not os.path.isfile(path):
        return None
    with open(path, 'rb') as file:
        return file.read()


def renumber_all(kept_document, renumberer):
    """Renumbers all extensions that are kept of a file, in place."""
    renumberer.renumber('root', kept_document['root'].get('extensions', {}))
    for kind in ('nodes', 'materials'):
        for thing in kept_document[kind].values():
            renumberer.renumber(HOSTS[kind], thing.get('extensions', {}))
