"""What Blender does not know comes back: VRM, springs, cameras, lights, extensions, extras. Numbers name the same things; what lost its
joint or mesh is named.

blender -b --factory-startup --python check_kept.py -- BENDY FOLDER
"""
import base64
import json
import os
import subprocess
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from posing import arguments, check          # first: it makes the add-on known
from bendy_file import enable_addon
from kept_character import write

OURS = ('BENDY_', 'KHR_lights_punctual', 'KHR_materials_clearcoat')     # compared elsewhere, or Blender's own


def run(bendy, *arguments):
    return subprocess.run([bendy, *arguments], check=True, capture_output=True, text=True).stderr


def document_of(bendy, path):
    """The JSON of a bendy file's export."""
    gltf = path + '.export.gltf'
    run(bendy, 'export', '--force', path, '-o', gltf)
    with open(gltf, encoding='utf-8') as file:
        return json.load(file)


class Said:
    """What a document says, with names in place of numbers."""

    def __init__(self, document):
        self.document = document

    def name(self, kind, number):
        if number == -1:
            return None
        thing = self.document[kind][number]
        if kind == 'textures':
            sampler = self.document['samplers'][thing['sampler']] if 'sampler' in thing else {}
            return self.document['images'][thing['source']]['name'], sampler.get('magFilter') == 9728
        return thing['name']

    def target(self, mesh, number):
        return self.document['meshes'][mesh]['extras']['targetNames'][number]

    def vrm0(self, vrm):
        second = vrm['secondaryAnimation']
        groups = [self.name('nodes', group['node']) for group in second['colliderGroups']]
        return {
            'bones': {each['bone']: self.name('nodes', each['node']) for each in vrm['humanoid']['humanBones']},
            'targets': [self.target(bind['mesh'], bind['index']) for group in vrm['blendShapeMaster']['blendShapeGroups'] for bind in group['binds']],
            'meshes': [self.name('meshes', each['mesh']) for each in vrm['firstPerson']['meshAnnotations']],
            'springs': [([self.name('nodes', bone) for bone in group['bones']], self.name('nodes', group['center']),
                         [groups[number] for number in group['colliderGroups']]) for group in second['boneGroups']],
            'rows': {self.document['materials'][number]['name']: (row['name'], {key: self.name('textures', each)[0]
                                                                                for key, each in row['textureProperties'].items()})
                     for number, row in enumerate(vrm['materialProperties'])},
            'first': self.name('nodes', vrm['firstPerson']['firstPersonBone']), 'portrait': self.name('textures', vrm['meta']['texture'])[0],
            'empty': [len(group['binds']) for group in vrm['blendShapeMaster']['blendShapeGroups']], 'title': vrm['meta']}

    def vrm1(self, vrm, springs):
        aa = vrm['expressions']['preset']['aa']
        groups = [[self.name('nodes', springs['colliders'][number]['node']) for number in group['colliders']] for group in springs['colliderGroups']]
        return {
            'bones': {bone: self.name('nodes', each['node']) for bone, each in vrm['humanoid']['humanBones'].items()},
            'targets': [self.target(self.document['nodes'][bind['node']]['mesh'], bind['index']) for bind in aa['morphTargetBinds']],
            'colours': [self.name('materials', bind['material']) for bind in aa['materialColorBinds']],
            'meshes': [self.name('nodes', each['node']) for each in vrm['firstPerson']['meshAnnotations']],
            'springs': [([self.name('nodes', joint['node']) for joint in spring['joints']], self.name('nodes', spring.get('center', -1)),
                         [groups[number] for number in spring['colliderGroups']]) for spring in springs['springs']],
            'portrait': self.document['images'][vrm['meta']['thumbnailImage']]['name'], 'authors': vrm['meta']['authors'], 'look': vrm['lookAt']}

    def node(self, node):
        extensions = {name: value for name, value in node.get('extensions', {}).items() if not name.startswith(OURS)}
        constraint = extensions.get('VRMC_node_constraint')
        if constraint:
            extensions['VRMC_node_constraint'] = (self.name('nodes', constraint['constraint']['rotation']['source']), constraint['specVersion'])
        light = node.get('extensions', {}).get('KHR_lights_punctual')
        extras = {key: value for key, value in node.get('extras', {}).items() if key not in ('rig_ik', 'rig_joint')}    # of the add-on
        return {'extensions': extensions, 'extras': extras,
                'camera': self.document['cameras'][node['camera']] if 'camera' in node else None,
                'light': self.document['extensions']['KHR_lights_punctual']['lights'][light['light']] if light else None}

    def material(self, material):
        extensions = {name: dict(value) for name, value in material.get('extensions', {}).items() if not name.startswith(OURS)}
        for value in extensions.values():
            for key in [key for key in value if key.endswith('Texture')]:
                value[key] = {**value[key], 'index': self.name('textures', value[key]['index'])}
        return {'extensions': extensions, 'extras': material.get('extras')}

    def all(self):
        root = self.document['extensions']
        said = {'nodes': {node['name']: self.node(node) for node in self.document['nodes']},
                'materials': {each['name']: self.material(each) for each in self.document['materials']},
                'meshes': {mesh['name']: {**mesh['extras'], 'targetNames': sorted(mesh['extras'].get('targetNames', []))} for mesh in self.document['meshes']},
                'clips': {clip['name']: clip.get('extras') for clip in self.document['animations']}, 'extras': self.document['extras'],
                'scene': {key: value for key, value in self.document['scenes'][0].items() if key != 'nodes'},
                'unknown': root['ACME_unknown'], 'used': {name for name in self.document['extensionsUsed'] if not name.startswith('BENDY_')}}
        if 'VRM' in root:
            said['VRM'] = self.vrm0(root['VRM'])
            said['VRM']['title'] = {**said['VRM']['title'], 'texture': None}
        if 'VRMC_vrm' in root:
            said['VRM'] = self.vrm1(root['VRMC_vrm'], root['VRMC_springBone'])
        return said

    def keys(self):
        """Clip -> (joint, path) -> (interpolation, number of keys)."""
        counts = {}
        for clip in self.document['animations']:
            for channel in clip['channels']:
                sampler, target = clip['samplers'][channel['sampler']], channel['target']
                counts.setdefault(clip['name'], {})[self.name('nodes', target['node']), target['path']] = (
                    sampler.get('interpolation', 'LINEAR'), self.document['accessors'][sampler['input']]['count'])
        return counts


def same(what, wanted, found):
    if isinstance(wanted, dict) and isinstance(found, dict):
        for key in {**wanted, **found}:
            same(f'{what}.{key}', wanted.get(key), found.get(key))
    else:
        check(wanted == found, f'{what}: {wanted} is now {found}')


def imported(bendy, *paths):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    enable_addon(bendy)
    for path in paths:
        check(bpy.ops.import_scene.bendy(filepath=path) == {'FINISHED'}, f'{path}: not imported')


def exported(path):
    """The notes of the export."""
    check(bpy.ops.export_scene.bendy(filepath=path) == {'FINISHED'}, f'{path}: not exported')
    return sys.modules['bendy_rig.export_hooks'].LastExport.report.notes


def note_of(notes, text):
    found = [note for note in notes if text in note]
    check(len(found) == 1, f'"{text}" is not in one of {notes}')
    return found[0]


def check_return(bendy, path, folder):
    imported(bendy, path)
    out = os.path.join(folder, 'out.bendy')
    exported(out)
    first, second = Said(document_of(bendy, path)), Said(document_of(bendy, out))
    same(os.path.basename(path), first.all(), second.all())
    check(len(first.document['textures']) == len(second.document['textures']), f'{second.document["textures"]}')
    wanted = first.keys()
    wanted['Swing'] = {key: ('LINEAR', second.keys()['Swing'][key][1]) for key in wanted['Swing']}     # cubic: sampled
    same('keys', wanted, second.keys())
    check(os.path.getsize(out) < 1.25 * os.path.getsize(path), f'{path}: {os.path.getsize(path)} bytes are now {os.path.getsize(out)}')
    # As glTF, read by the program.
    glb = os.path.join(folder, 'out.glb')
    check(bpy.ops.export_scene.bendy_rig(filepath=glb) == {'FINISHED'}, 'not exported as glTF')
    run(bendy, 'convert', '--force', glb, '-o', out)
    same('as glTF', first.all(), Said(document_of(bendy, out)).all())
    check('bendy_' not in json.dumps(document_of(bendy, out)), 'a record of the add-on is in the file')
    # A plain export says that it does not.
    bpy.ops.export_scene.gltf(filepath=os.path.join(folder, 'plain.glb'), export_extras=True)
    with open(os.path.join(folder, 'plain.glb'), 'rb') as file:
        check(b'bendy_mark' not in file.read(), 'a mark is in a plain export')
    note_of(sys.modules['bendy_rig.export_hooks'].LastExport.report.notes, 'returned only by')


def check_lost(bendy, source, folder):
    """What is not kept is named."""
    with open(source, encoding='utf-8') as file:
        document = json.load(file)
    attributes = document['meshes'][1]['primitives'][0]['attributes']
    attributes['_HEAT'] = attributes['POSITION']
    document['materials'][0]['pbrMetallicRoughness']['baseColorTexture']['extras'] = {'from': 'atlas'}
    document['images'][1]['extras'] = {'shot': 1}
    path = os.path.join(folder, 'lost.gltf')
    with open(path, 'w', encoding='utf-8') as file:
        json.dump(document, file)
    run(bendy, 'convert', path, '-o', path.replace('.gltf', '.bendy'))
    hooks, told = sys.modules['bendy_rig.import_operator'].IMPORT_SCENE_OT_bendy, []
    plain, hooks.tell = hooks.tell, lambda operator, path, made: told.append(made)
    try:
        imported(bendy, path.replace('.gltf', '.bendy'))
    finally:
        hooks.tell = plain
    lost = dict(told[0].notes)['an export does not return']
    check(lost == ['images[1].extras', 'materials[0].pbrMetallicRoughness.baseColorTexture.extras', '_HEAT (Body)'], f'{lost}')


def check_changes(bendy, path, folder, version):
    """Renamed things keep what they had; what is gone takes along what names it, and is named."""
    imported(bendy, path)
    rig = next(obj for obj in bpy.data.objects if obj.type == 'ARMATURE')
    rig.pose.bones['spine'].name = 'backbone'
    bpy.data.objects['FaceNode'].name = 'Visage'
    bpy.data.meshes['Face'].name = 'VisageMesh'
    bpy.data.objects['FaceNode' if 'FaceNode' in bpy.data.objects else 'Visage'].data.shape_keys.key_blocks['Face_2'].name = 'Aaa'
    bpy.data.materials['Cloth'].name = 'Linen'
    bpy.data.cameras['eye'].clip_start = 0.5
    bpy.data.materials.new('New')
    bpy.data.objects['BodyNode'].data.materials.append(bpy.data.materials['New'])
    bpy.data.objects['BodyNode'].data.polygons[0].material_index = 1
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode='EDIT')
    rig.data.edit_bones.remove(rig.data.edit_bones['hair'])
    bpy.ops.object.mode_set(mode='OBJECT')
    bpy.data.objects.remove(bpy.data.objects['TeethNode'])
    bpy.data.objects.remove(bpy.data.objects['Lamp'])
    out = os.path.join(folder, 'changed.bendy')
    notes = exported(out)
    check(not run(bendy, 'validate', out), 'not valid')
    document = document_of(bendy, out)
    said = Said(document).all()
    check(said['VRM']['bones']['spine'] == 'backbone', f'{said["VRM"]["bones"]}')
    check(said['VRM']['targets'] == ['Aaa'], f'{said["VRM"]["targets"]}')
    if version == 0:
        check(said['VRM']['springs'] == [([], None, ['head', 'hips'])], f'{said["VRM"]["springs"]}')
        check(said['VRM']['rows'] == {'Skin': ('Skin', {'_MainTex': 'skin', '_ShadeTexture': 'shade'}), 'New': ('New', {}),
                                      'Linen': ('Cloth', {'_MainTex': 'cloth'})}, f'{said["VRM"]["rows"]}')
        check('VRM.secondaryAnimation.boneGroups[0].bones[0]' in note_of(notes, 'is not there any more'), f'{notes}')
    else:
        check(said['VRM']['springs'] == [(['hairEnd'], 'hips', [['head'], ['hips']])], f'{said["VRM"]["springs"]}')
        check(said['VRM']['colours'] == ['Linen'] and said['VRM']['meshes'] == ['BodyNode', 'Visage'], f'{said["VRM"]}')
        check('hair: VRMC_node_constraint' in note_of(notes, 'left out with what had it'), f'{notes}')
    check(said['nodes']['hips']['extensions'] == {'ACME_bone': {'tag': 'pelvis', 'list': []}}, f'{said["nodes"]["hips"]}')
    check(said['materials']['Linen']['extensions']['KHR_materials_iridescence']['iridescenceTexture']['index'][0] == 'thin', 'iridescence')
    eye, plan = (said['nodes'][name]['camera'] for name in ('Eye', 'Plan'))
    check(abs(eye['perspective']['znear'] - 0.5) < 1e-6 and plan['orthographic']['ymag'] == 1.5, f'{eye}, {plan}')
    note_of(notes, 'eye: was changed since the import')
    check(said['nodes']['Sun']['light'] == {'type': 'directional', 'intensity': 3.25, 'color': [1, 0.9, 0.8]}, f'{said["nodes"]["Sun"]}')


def check_two(bendy, paths, folder):
    """Two characters: what both have is the first one's, and that is said; each keeps its own joints' and materials'."""
    imported(bendy, *paths)
    notes = exported(os.path.join(folder, 'two.bendy'))
    document = document_of(bendy, os.path.join(folder, 'two.bendy'))
    note = note_of(notes, 'the file has another one')
    check('ACME_unknown' not in note, f'{note}')        # it is the same in both
    check('VRM' in note and Said(document).vrm0(document['extensions']['VRM'])['bones']['head'] == 'head', f'{note}')
    own = [node['name'] for node in document['nodes'] if 'ACME_bone' in node.get('extensions', {})]
    check(len(own) == 2, f'{own}')


def check_damaged(bendy, path, folder):
    """A property that somebody has edited, or lost, is said, and the rest is written."""
    imported(bendy, path)
    scene, out = bpy.context.scene, os.path.join(folder, 'damaged.bendy')
    documents = json.loads(scene['bendy_documents'])
    for value, said in ((json.dumps({key: {} for key in documents}), 'is damaged'), ('no JSON', 'has no bendy_documents')):
        scene['bendy_documents'] = value
        note_of(exported(out), said)
        document = document_of(bendy, out)
        check('VRM' not in document['extensions'] and len(document['nodes']) == 15, f'{document["extensions"]}')
        check('bendy_' not in json.dumps(document), 'a record of the add-on is in the file')


def check_required(bendy, source, folder):
    """A required extension that Blender does not know does not stop an import, and stays required: a texture of KTX 2 only."""
    with open(source, encoding='utf-8') as file:
        document = json.load(file)
    document['images'][3] = {'uri': 'data:image/ktx2;base64,' + base64.b64encode(b'\xabKTX 20\xbb\r\n\x1a\n' + bytes(80)).decode(), 'name': 'thin'}
    document['textures'][3] = {'extensions': {'KHR_texture_basisu': {'source': 3}}}
    path, out = os.path.join(folder, 'required.gltf'), os.path.join(folder, 'again.bendy')
    with open(path, 'w', encoding='utf-8') as file:
        json.dump({**document, 'extensionsRequired': ['KHR_texture_basisu']}, file)
    converted = path.replace('.gltf', '.bendy')
    run(bendy, 'convert', '--force', path, '-o', converted)
    imported(bendy, converted)
    exported(out)
    for made in (document_of(bendy, converted), document_of(bendy, out)):
        number = made['materials'][-1]['extensions']['KHR_materials_iridescence']['iridescenceTexture']['index']
        texture = made['textures'][number]
        check(made['extensionsRequired'] == ['KHR_texture_basisu'] and 'source' not in texture, f'{texture}')
        check(made['images'][texture['extensions']['KHR_texture_basisu']['source']]['mimeType'] == 'image/ktx2', f'{made["images"]}')


def main():
    bendy, folder = arguments()
    paths = []
    for version in (0, 1):
        source = os.path.join(folder, f'vrm{version}.gltf')
        write(source, version)
        paths.append(source.replace('.gltf', '.bendy'))
        run(bendy, 'convert', source, '-o', paths[-1])
        check_return(bendy, paths[-1], folder)
        check_changes(bendy, paths[-1], folder, version)
    check_two(bendy, [paths[0]] * 2, folder)
    check_damaged(bendy, paths[0], folder)
    check_lost(bendy, os.path.join(folder, 'vrm0.gltf'), folder)
    check_required(bendy, os.path.join(folder, 'vrm1.gltf'), folder)
    print('Import and export: what Blender does not know is kept, and what lost its joint is named')


main()
