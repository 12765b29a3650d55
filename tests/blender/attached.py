"""A skinned character with a badge on a bone whose length an import changes, and two faces that different clips move: glTF and rig."""
import base64
import json
import struct

BODY = [(-0.1, 0, 0), (0.1, 0, 0), (0, 0.5, 0), (-0.1, 0.9, 0), (0.1, 0.9, 0), (0, 1.4, 0)]
BADGE = [(-0.1, 0, -0.1), (0.1, 0, -0.1), (0, 0.2, 0)]
FACE = [(-0.2, 0, 0.3), (0.2, 0, 0.3), (0, 0.3, 0.3)]
HEADS = [(0, 0, 0), (0, 0.5, 0), (0, 1.02, 0), (0.3, 0.6, 0), (-0.3, 0.6, 0)]


class Buffer:
    def __init__(self):
        self.bytes, self.views, self.accessors = b'', [], []

    def add(self, kind, rows, component=5126, code='f'):
        data = b''.join(struct.pack(f'<{len(row)}{code}', *row) for row in rows)
        self.views.append({'buffer': 0, 'byteOffset': len(self.bytes), 'byteLength': len(data)})
        self.bytes += data + bytes(-len(data) % 4)
        accessor = {'bufferView': len(self.views) - 1, 'componentType': component, 'count': len(rows), 'type': kind}
        if component == 5126:
            accessor['min'], accessor['max'] = ([ends(column) for column in zip(*rows)] for ends in (min, max))
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def attached_character():
    """(the text of a .gltf file, the text of its rig file)"""
    buffer = Buffer()
    positions = {name: buffer.add('VEC3', rows) for name, rows in (('body', BODY), ('badge', BADGE), ('face', FACE))}
    smile = buffer.add('VEC3', [(0, 0, 0), (0, 0, 0), (0, 0.1, 0.2)])
    bones = buffer.add('VEC4', [(number // 3, 0, 0, 0) for number in range(6)], 5121, 'B')
    weights = buffer.add('VEC4', [(1, 0, 0, 0)] * 6)
    binds = buffer.add('MAT4', [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -z, 1) for x, y, z in HEADS])
    times = buffer.add('SCALAR', [(0,), (0.5,), (1,)])
    shown = buffer.add('SCALAR', [(0,), (0.4,), (1,)])
    moves = buffer.add('VEC3', [(0, 0.2, 0.1), (0.1, 0.2, 0.1), (0, 0.3, 0.2)])

    def mesh(name, **attributes):
        return {'name': name, 'primitives': [{'attributes': {'POSITION': positions[name], **attributes}}]}

    def face(name):
        return {'name': name, 'primitives': [{'attributes': {'POSITION': positions['face']}, 'targets': [{'POSITION': smile}]}],
                'extras': {'targetNames': ['Smile']}}

    def clip(name, node, path, output):
        return {'name': name, 'samplers': [{'input': times, 'output': output}],
                'channels': [{'sampler': 0, 'target': {'node': node, 'path': path}}]}

    document = {
        'asset': {'version': '2.0'}, 'scenes': [{'nodes': [0, 7, 8, 9]}],
        'nodes': [{'name': 'root', 'children': [1]}, {'name': 'spine', 'children': [2]},
                  {'name': 'chest', 'translation': [0, 0.5, 0], 'children': [3, 4, 5, 6]}, {'name': 'head', 'translation': [0, 0.52, 0]},
                  {'name': 'arm.l', 'translation': [0.3, 0.1, 0]}, {'name': 'arm.r', 'translation': [-0.3, 0.1, 0]},
                  {'name': 'badge', 'mesh': 0, 'translation': [0, 0.2, 0.1]}, {'name': 'body', 'mesh': 1, 'skin': 0},
                  {'name': 'first', 'mesh': 2, 'translation': [1, 0, 0]}, {'name': 'second', 'mesh': 3, 'translation': [-1, 0, 0]}],
        'skins': [{'joints': [1, 2, 3, 4, 5], 'inverseBindMatrices': binds}],
        'meshes': [mesh('badge'), mesh('body', JOINTS_0=bones, WEIGHTS_0=weights), face('first'), face('second')],
        'animations': [clip('First', 8, 'weights', shown), clip('Second', 9, 'weights', shown), clip('Badge', 6, 'translation', moves)],
        'accessors': buffer.accessors, 'bufferViews': buffer.views,
        'buffers': [{'byteLength': len(buffer.bytes), 'uri': 'data:;base64,' + base64.b64encode(buffer.bytes).decode()}],
    }
    rig = {'bendy_rig': 1, 'chains': [{'name': 'Spine', 'start': 'spine', 'effector': 'head', 'solver': 'ccd'}]}
    return json.dumps(document), json.dumps(rig)
