"""A character with all that glTF files say and Blender does not know: VRM of either version, springs, node constraints, cameras, lights,
materials of other programs with pictures of their own, extensions of nobody, extras; and with clips of few keys."""
import base64
import json
import struct
import zlib

from attached import Buffer

BONES = ('hips', 'spine', 'chest', 'head')
CORNERS = [(-0.1, 0, 0), (0.1, 0, 0), (0, 0.5, 0.1), (-0.1, 0.9, 0), (0.1, 0.9, 0.1), (0, 1.4, 0)]
HEADS = {'hips': (0, 0.9, 0), 'spine': (0, 1.0, 0), 'chest': (0, 1.2, 0), 'head': (0, 1.5, 0), 'hair': (0, 1.7, -0.1), 'hairEnd': (0, 1.7, -0.3)}
MTOON = {'specVersion': '1.0', 'shadeMultiplyTexture': {'index': 2}, 'shadeColorFactor': [0.5, 0.25, 0.1], 'outlineWidthMode': 'none'}
IRIDESCENCE = {'iridescenceFactor': 0.75, 'iridescenceTexture': {'index': 3, 'extensions': {'KHR_texture_transform': {'scale': [2, 2]}}}}


def picture(red, green, blue):
    """A PNG of one pixel as a data URI."""
    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    png = b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>2I5B', 1, 1, 8, 2, 0, 0, 0)) \
        + chunk(b'IDAT', zlib.compress(bytes((0, red, green, blue)))) + chunk(b'IEND', b'')
    return 'data:image/png;base64,' + base64.b64encode(png).decode()


def extensions_of(version, node):
    """Those of the root. node: name -> number."""
    if version == 0:
        return {'VRM': {
            'specVersion': '0.0', 'meta': {'title': 'kept', 'texture': 4, 'otherLicenseUrl': ''},
            'humanoid': {'humanBones': [{'bone': bone, 'node': node[bone], 'useDefaultValues': True} for bone in BONES]},
            'firstPerson': {'firstPersonBone': node['head'], 'meshAnnotations': [{'mesh': 1, 'firstPersonFlag': 'Auto'}, {'mesh': 0}]},
            'blendShapeMaster': {'blendShapeGroups': [
                {'name': 'A', 'binds': [{'mesh': 0, 'index': 2, 'weight': 100}, {'mesh': 2, 'index': 1, 'weight': 50}], 'materialValues': []},
                {'name': 'nothing', 'binds': []}]},
            'secondaryAnimation': {
                'boneGroups': [{'bones': [node['hair']], 'center': -1, 'colliderGroups': [1, 0], 'stiffiness': 0.3}],
                'colliderGroups': [{'node': node['hips'], 'colliders': [{'offset': {'x': 0, 'y': 0.1, 'z': 0}, 'radius': 0.07}]},
                                   {'node': node['head'], 'colliders': []}]},
            'materialProperties': [{'name': 'Skin', 'shader': 'VRM/MToon', 'textureProperties': {'_MainTex': 0, '_ShadeTexture': 2}},
                                   {'name': 'Cloth', 'shader': 'VRM_USE_GLTFSHADER', 'textureProperties': {'_MainTex': 1}}]}}
    return {
        'VRMC_vrm': {
            'specVersion': '1.0', 'meta': {'name': 'kept', 'thumbnailImage': 4, 'authors': []},
            'humanoid': {'humanBones': {bone: {'node': node[bone]} for bone in BONES}},
            'firstPerson': {'meshAnnotations': [{'node': node['BodyNode'], 'type': 'auto'}, {'node': node['FaceNode'], 'type': 'both'}]},
            'expressions': {'preset': {'aa': {
                'morphTargetBinds': [{'node': node['FaceNode'], 'index': 2, 'weight': 1}, {'node': node['TeethNode'], 'index': 1, 'weight': 1}],
                'materialColorBinds': [{'material': 1, 'type': 'color', 'targetValue': [0, 0, 0, 1]}]}}},
            'lookAt': {'type': 'bone', 'offsetFromHeadBone': [0, 0.06, 0]}},
        'VRMC_springBone': {
            'specVersion': '1.0', 'colliders': [{'node': node['hips'], 'shape': {'sphere': {'radius': 0.1}}}, {'node': node['head']}],
            'colliderGroups': [{'name': 'low', 'colliders': [0]}, {'name': 'high', 'colliders': [1]}],
            'springs': [{'name': 'hair', 'joints': [{'node': node['hair'], 'stiffness': 1.25}, {'node': node['hairEnd']}],
                         'center': node['hips'], 'colliderGroups': [1, 0]}]}}


def kept_character(version):
    """The document of a .gltf file. version: of VRM, 0 or 1."""
    buffer = Buffer()
    corners = buffer.add('VEC3', CORNERS)
    uv = buffer.add('VEC2', [(0, 0), (1, 0), (0, 1), (1, 1), (0.5, 0), (0, 0.5)])
    bones = buffer.add('VEC4', [(number % 4, 0, 0, 0) for number in range(6)], 5121, 'B')
    weights = buffer.add('VEC4', [(1, 0, 0, 0)] * 6)
    joints = list(HEADS)
    binds = buffer.add('MAT4', [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -z, 1) for x, y, z in HEADS.values()])
    moves = [buffer.add('VEC3', [(0, 0, 0.01 * k)] * 6) for k in (1, 2, 3)]
    nodes = [
        {'name': 'FaceNode', 'mesh': 0, 'skin': 0}, {'name': 'TeethNode', 'mesh': 2, 'translation': [0, 0.1, 0]},
        {'name': 'BodyNode', 'mesh': 1, 'skin': 0, 'extras': {'tailor': [1, {'of': 'Paris'}]}},
        {'name': 'Eye', 'camera': 0, 'translation': [0, 1.5, 3]}, {'name': 'Lamp', 'translation': [1, 2, 3], 'rotation': [0, 0.6, 0, 0.8],
                                                                  'extensions': {'KHR_lights_punctual': {'light': 1}}},
        {'name': 'Sun', 'extensions': {'KHR_lights_punctual': {'light': 0}}},
        {'name': 'Plan', 'camera': 1, 'children': [7]}, {'name': 'OnPlan', 'translation': [0, 0, 1]},
        *({'name': name} for name in HEADS), {'name': 'root', 'children': []}]
    node = {each['name']: number for number, each in enumerate(nodes)}
    for name, above in zip(joints, ('root', 'hips', 'spine', 'chest', 'head', 'hair')):
        nodes[node[above]].setdefault('children', []).append(node[name])
        base = HEADS.get(above, (0, 0, 0))
        nodes[node[name]]['translation'] = [round(a - b, 6) for a, b in zip(HEADS[name], base)]
    nodes[node['head']]['children'] += [node['TeethNode'], node['Eye']]
    nodes[node['Eye']]['translation'] = [0, 0.05, 0.1]
    nodes[node['hips']]['extensions'] = {'ACME_bone': {'tag': 'pelvis', 'list': []}}
    if version == 1:
        nodes[node['hair']]['extensions'] = {'VRMC_node_constraint': {'specVersion': '1.0', 'constraint': {'rotation': {'source': node['chest'], 'weight': 0.5}}}}

    def mesh(name, targets, material):
        primitive = {'attributes': {'POSITION': corners, 'TEXCOORD_0': uv}, 'material': material}
        if name != 'Teeth':
            primitive['attributes'] |= {'JOINTS_0': bones, 'WEIGHTS_0': weights}
        if targets:
            primitive['targets'] = [{'POSITION': move} for move in moves[:targets]]
        return {'name': name, 'primitives': [primitive], 'extras': {'targetNames': [f'{name}_{k}' for k in range(targets)], 'owner': name}
                if targets else {'owner': name}}

    def track(name, path, times, values, interpolation, kind):
        return ({'input': buffer.add('SCALAR', [(time,) for time in times]), 'output': buffer.add(kind, values), 'interpolation': interpolation},
                {'node': node[name], 'path': path})

    def clip(name, *tracks, **more):
        return {'name': name, 'samplers': [sampler for sampler, _ in tracks],
                'channels': [{'sampler': k, 'target': target} for k, (_, target) in enumerate(tracks)], **more}

    turn = (0, 0, 0.0998334, 0.9950042)
    document = {
        'asset': {'version': '2.0'}, 'scene': 0,
        'scenes': [{'name': 'Stage', 'nodes': [node['root'], node['FaceNode'], node['BodyNode'], node['Lamp'], node['Sun'], node['Plan']],
                    'extras': {'act': 3}}],
        'nodes': nodes, 'skins': [{'joints': [node[name] for name in joints], 'inverseBindMatrices': binds}],
        'meshes': [mesh('Face', 3, 0), mesh('Body', 0, 1), mesh('Teeth', 2, 0)],
        'images': [{'uri': picture(10 * k, 20, 30), 'name': name} for k, name in enumerate(('skin', 'cloth', 'shade', 'thin', 'portrait'))],
        'samplers': [{'magFilter': 9728, 'wrapS': 33071}],
        'textures': [{'source': 0}, {'source': 1}, {'source': 2, 'sampler': 0, 'name': 'shadow'}, {'source': 3}]
                    + ([{'source': 4}] if version == 0 else []),
        'materials': [{'name': 'Skin', 'pbrMetallicRoughness': {'baseColorTexture': {'index': 0}},
                       'extensions': {'VRMC_materials_mtoon': MTOON, 'KHR_materials_clearcoat': {'clearcoatFactor': 0.5}},
                       'extras': {'brush': 'soft'}},
                      {'name': 'Cloth', 'pbrMetallicRoughness': {'baseColorTexture': {'index': 1}},
                       'extensions': {'KHR_materials_iridescence': IRIDESCENCE}}],
        'cameras': [{'name': 'eye', 'type': 'perspective', 'perspective': {'yfov': 0.7853981633974483, 'znear': 0.01}, 'extras': {'lens': 'old'}},
                    {'type': 'orthographic', 'orthographic': {'xmag': 2.5, 'ymag': 1.5, 'znear': 0.1, 'zfar': 50}}],
        'animations': [
            clip('Nod', track('head', 'rotation', (0, 1, 2), [(0, 0, 0, 1), turn, (0, 0, 0, 1)], 'LINEAR', 'VEC4'),
                 track('hips', 'translation', (0, 2), [(0, 0.9, 0), (0, 0.9, 0.5)], 'LINEAR', 'VEC3'), extras={'loop': 1, 'mood': 'calm'}),
            clip('Jump', track('hips', 'translation', (0, 0.5, 1), [(0, 0.9, 0), (0, 1.4, 0), (0, 0.9, 0)], 'STEP', 'VEC3'),
                 track('FaceNode', 'weights', (0, 1), [(0,), (0,), (0,), (1,), (0.5,), (0,)], 'LINEAR', 'SCALAR')),
            clip('Swing', track('spine', 'rotation', (0, 1), [(0, 0, 0, 0), (0, 0, 0, 1), (0, 0, 0.2, 0), (0, 0, -0.2, 0), turn, (0, 0, 0, 0)],
                                'CUBICSPLINE', 'VEC4'))],
        'extensions': {**extensions_of(version, node), 'ACME_unknown': {'node': 3, 'empty': [], 'nothing': None, 'deep': {'er': {}}},
                       'KHR_lights_punctual': {'lights': [
                           {'type': 'directional', 'intensity': 3.25, 'color': [1, 0.9, 0.8]},
                           {'type': 'spot', 'name': 'lamp', 'intensity': 40, 'range': 12.5, 'extras': {'bulb': 2},
                            'spot': {'innerConeAngle': 0.3, 'outerConeAngle': 0.6}}]}},
        'extras': {'author': {'name': 'nobody'}},
    }
    document |= {'accessors': buffer.accessors, 'bufferViews': buffer.views,
                 'buffers': [{'byteLength': len(buffer.bytes), 'uri': 'data:;base64,' + base64.b64encode(buffer.bytes).decode()}]}
    used = {'KHR_lights_punctual', 'KHR_materials_clearcoat', 'KHR_texture_transform', 'VRMC_materials_mtoon', 'KHR_materials_iridescence',
            'ACME_bone', *document['extensions'], *(['VRMC_node_constraint'] if version else [])}
    return document | {'extensionsUsed': sorted(used)}


def write(path, version):
    with open(path, 'w', encoding='utf-8') as file:
        json.dump(kept_character(version), file)
