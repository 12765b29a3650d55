"""Reads .glb and .gltf files, checks what the add-on put there, and writes their JSON again."""
import base64
import json
import os
import struct
import urllib.parse

from .joint_limits import says_a_limit

GLB, JSON = b'glTF', b'JSON'


def read_document(path):
    """The JSON of a .glb or .gltf file."""
    return read_file(path)[0]


def read_file(path):
    """(the JSON, the bytes of the buffer in a .glb file)"""
    with open(path, 'rb') as file:
        data = file.read()
    if data[:4] != GLB:
        return json.loads(data.decode('utf-8')), b''
    length, = struct.unpack_from('<I', data, 12)
    return json.loads(data[20:20 + length].decode('utf-8')), data[28 + length:]


def write_document(path, document):
    """Replaces the JSON of a file. It keeps its buffers."""
    with open(path, 'rb') as file:
        data = file.read()
    text = json.dumps(document, ensure_ascii=False, separators=(',', ':')).encode('utf-8')
    if data[:4] == GLB:
        length, = struct.unpack_from('<I', data, 12)
        text += b' ' * (-len(text) % 4)
        rest = data[20 + length:]
        text = struct.pack('<4s3I4s', GLB, 2, 20 + len(text) + len(rest), len(text), JSON) + text + rest
    with open(path, 'wb') as file:
        file.write(text)


def image_bytes(path, document, binary, image):
    """The bytes of an image of a file that was read; None if they are not there."""
    if 'bufferView' in image:
        view = document['bufferViews'][image['bufferView']]
        start, uri = view.get('byteOffset', 0), document['buffers'][view['buffer']].get('uri')
        data = binary if uri is None else linked_bytes(path, uri)
        return data and data[start:start + view['byteLength']]
    return linked_bytes(path, image.get('uri', ''))


def linked_bytes(path, uri):
    if uri.startswith('data:'):
        return base64.b64decode(uri.partition(',')[2])
    try:
        with open(os.path.join(os.path.dirname(path), urllib.parse.unquote(uri)), 'rb') as file:
            return file.read()
    except OSError:
        return None


def count_records(document):
    """(joints with limits, chains) in a glTF document."""
    nodes, scenes = document.get('nodes', []), document.get('scenes', [])
    joints = [node for node in nodes if says_a_limit(node.get('extras', {}).get('rig_joint'))]
    rigs = [owner['extras']['rig_ik'] for owner in nodes + scenes if 'rig_ik' in owner.get('extras', {})]
    return len(joints), sum(len(rig['chains']) for rig in rigs)
