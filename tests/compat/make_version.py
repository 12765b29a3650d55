#!/usr/bin/env python3
"""Makes the folder of a version that is being released: its files, their poses and their sums.

    python3 tests/compat/make_version.py VERSION --bendy PROGRAM

VERSION is the program's, such as 0.2. A folder that is there already is left as it is: released bytes never change. Python 3,
nothing else.
"""

import argparse
import hashlib
import json
import math
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / 'tests' / 'cli'), str(ROOT / 'spec')]
from gltf_file import GltfFile  # noqa: E402
from make_bytes import smallest_png  # noqa: E402

MOST_VERTICES = 24  # of each mesh, spread over it


# --- a character of everything, in a small space ---------------------------------------------------------------------

def turn(axis, degrees):
    half = math.radians(degrees) / 2
    return tuple(math.sin(half) * part for part in axis) + (math.cos(half),)


def tube(file, rings, sides):
    """Positions, normals, texture coordinates, joints and weights of a tube along y, and its triangles."""
    points, normals, coords, bones, weights = [], [], [], [], []
    for ring in range(rings + 1):
        y = 2.0 * ring / rings
        upper = min(max(y - 0.5, 0.0), 1.0)
        for side in range(sides + 1):
            angle = 2 * math.pi * side / sides
            x, z = math.cos(angle), math.sin(angle)
            points.append((0.25 * x, y, 0.25 * z))
            normals.append((x, 0.0, z))
            coords.append((side / sides, 1 - y / 2))
            bones.append((0, 1, 0, 0))
            weights.append((1 - upper, upper, 0.0, 0.0))
    triangles = []
    for ring in range(rings):
        for side in range(sides):
            a = ring * (sides + 1) + side
            b = a + sides + 1
            triangles += [(a,), (b,), (a + 1,), (a + 1,), (b,), (b + 1,)]
    count = len(points)
    attributes = {'POSITION': file.add(points, 'VEC3'), 'NORMAL': file.add(normals, 'VEC3'),
                  'TEXCOORD_0': file.add(coords, 'VEC2'), 'JOINTS_0': file.add(bones, 'VEC4', 5121),
                  'WEIGHTS_0': file.add(weights, 'VEC4'),
                  'COLOR_0': file.add([(k / count, 1 - k / count, 0.5, 1.0) for k in range(count)], 'VEC4'),
                  '_HEAT': file.add([(20 + 0.5 * k,) for k in range(count)], 'SCALAR')}
    bulge = [(0.2 * x if 0.8 < y < 1.2 else 0.0, 0.0, 0.2 * z if 0.8 < y < 1.2 else 0.0)
             for (x, _, z), (_, y, _) in zip(normals, points)]
    lift = [(0.0, 0.1 * y, 0.0) for _, y, _ in points]
    targets = [{'POSITION': file.add(bulge, 'VEC3')}, {'POSITION': file.add(lift, 'VEC3')}]
    return attributes, targets, file.add(triangles, 'SCALAR', 5123)


def animations(file):
    step = file.add([(0.0,), (0.5,), (1.5,)], 'SCALAR')
    even = file.add([(k / 10,) for k in range(16)], 'SCALAR')
    two = file.add([(0.25,), (1.25,)], 'SCALAR')
    bend = [turn((1, 0, 0), 40 * math.sin(k / 10 * math.pi)) for k in range(16)]
    cubic = [(0, 0, 0), (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0.5, 0.25), (0, 0, 0)]
    twist = [(0, 0, 0, 0), turn((0, 1, 0), 0), (0, 1, 0, 0), (0, 0.5, 0, -0.5), turn((0, 1, 0), 70), (0, 0, 0, 0)]
    samplers = [{'input': even, 'output': file.add(bend, 'VEC4')},
                {'input': step, 'output': file.add([(0, 0, 0), (0.5, 0, 0), (0, 0, 0.5)], 'VEC3'), 'interpolation': 'STEP'},
                {'input': two, 'output': file.add(cubic, 'VEC3'), 'interpolation': 'CUBICSPLINE'},
                {'input': two, 'output': file.add(twist, 'VEC4'), 'interpolation': 'CUBICSPLINE'},
                {'input': step, 'output': file.add([(1, 1, 1), (1, 1.5, 1), (0.5, 1, 2)], 'VEC3')},
                {'input': step, 'output': file.add([(0.0,), (0.0,), (1.0,), (0.5,), (0.25,), (1.0,)], 'SCALAR')}]
    everything = [(0, 2, 'rotation'), (1, 1, 'translation'), (4, 3, 'scale'), (5, 4, 'weights')]
    smooth = [(2, 1, 'translation'), (3, 2, 'rotation')]

    def clip(name, channels):
        used = [channel[0] for channel in channels]
        return {'name': name, 'samplers': [samplers[k] for k in used],
                'channels': [{'sampler': place, 'target': {'node': node, 'path': path}}
                             for place, (_, node, path) in enumerate(channels)]}
    return [clip('Everything', everything), clip('Smooth', smooth)]


def make_character(path):
    """Two joints that bend a tube with targets, a lamp that one joint carries, materials, textures, extras."""
    file = GltfFile(
        scenes=[{'name': 'tube', 'nodes': [0], 'extras': {'by': 'us'}}],
        nodes=[{'name': 'character', 'children': [1, 4]},
               {'name': 'lower', 'children': [2], 'extras': {'side': 'mid'}},
               {'name': 'upper', 'translation': [0, 1, 0], 'children': [3]},
               {'name': 'lamp', 'translation': [0, 1, 0], 'rotation': list(turn((0, 0, 1), 30)), 'mesh': 1},
               {'name': 'skin', 'mesh': 0, 'skin': 0}],
        materials=[{'name': 'cloth', 'pbrMetallicRoughness': {'baseColorTexture': {'index': 0}, 'roughnessFactor': 0.7},
                    'doubleSided': True},
                   {'name': 'glass', 'alphaMode': 'BLEND', 'emissiveFactor': [1, 0.5, 0],
                    'extensions': {'KHR_materials_unlit': {}}}],
        extensionsUsed=['KHR_materials_unlit'],
        textures=[{'source': 0, 'sampler': 0}], samplers=[{'magFilter': 9728, 'wrapS': 33071}], images=[{'uri': 'red.png'}])
    attributes, targets, triangles = tube(file, 8, 8)
    corners = file.add([(0, 0, 0), (0.2, 0, 0), (0, 0.2, 0), (0, 0, 0.2)], 'VEC3')
    faces = file.add([(0,), (2,), (1,), (0,), (1,), (3,)], 'SCALAR', 5123)
    edges = file.add([(0,), (1,), (0,), (2,)], 'SCALAR', 5123)
    file.document['meshes'] = [
        {'name': 'tube', 'weights': [0.25, 0], 'extras': {'targetNames': ['bulge', 'lift']},
         'primitives': [{'attributes': attributes, 'targets': targets, 'indices': triangles, 'material': 0}]},
        {'name': 'lamp', 'primitives': [{'attributes': {'POSITION': corners}, 'indices': faces, 'material': 1},
                                       {'attributes': {'POSITION': corners}, 'indices': edges, 'mode': 1}]}]
    binds = [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1), (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1)]
    file.document['skins'] = [{'joints': [1, 2], 'inverseBindMatrices': file.add(binds, 'MAT4')}]
    file.document['animations'] = animations(file)
    (path.parent / 'red.png').write_bytes(smallest_png())
    return file.write(path)


RIG = {'bendy_rig': 1,
       'joints': {'upper': [{'model': 'swing_twist_ellipse', 'x': [-30, 30], 'y': [-40, 40], 'z': [-20, 60]},
                            {'model': 'hinge', 'x': [-90, 90], 'scope': 'ik_only'}],
                  'lamp': {'model': 'euler_box', 'x': [-10, 10], 'y': [-20, 20], 'z': [-30, 30]}},
       'chains': [{'name': 'reach', 'start': 'lower', 'effector': 'lamp', 'solver': 'fabrik', 'weights': {'lower': 0.5}}]}


# --- files and poses -------------------------------------------------------------------------------------------------

def run(program, *arguments):
    subprocess.run([program, *map(str, arguments)], check=True)


def numbers(values):
    return [float('%.7g' % value) for value in values]


def pose(program, file, clip, time, scratch):
    out = scratch / 'pose.json'
    run(program, 'pose', file, *([] if clip is None else ['--clip', clip, '--time', time]), '-o', out)
    posed = json.loads(out.read_text(encoding='utf-8'))
    meshes = []
    for mesh in posed['meshes']:
        points = mesh['positions']
        count = len(points) // 3
        chosen = sorted({k * (count - 1) // max(min(count, MOST_VERTICES) - 1, 1) for k in range(min(count, MOST_VERTICES))})
        meshes.append({'vertices': count, 'positions': [[k, *numbers(points[3 * k:3 * k + 3])] for k in chosen]})
    return {'clip': clip, 'time': time, 'joints': [numbers(joint['world']) for joint in posed['joints']], 'meshes': meshes}


def write_poses(program, file, moments, command, scratch):
    poses = [] if moments is None else [pose(program, file, None, 0, scratch)] + [pose(program, file, clip, time, scratch) for clip, time in moments]
    text = json.dumps({'file': file.name, 'command': command, 'tolerance': 1e-5, 'poses': poses}, separators=(',', ':'))
    file.with_suffix('.json').write_text(text.replace('{"clip"', '\n{"clip"').replace(',"meshes"', ',\n"meshes"') + '\n',
                                         encoding='utf-8')


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('version')
    parser.add_argument('--bendy', required=True)
    arguments = parser.parse_args()
    folder = HERE / arguments.version
    if folder.exists():
        sys.exit('%s is there already, and stays as it is' % folder)
    folder.mkdir()
    everything = [(0, 0.33), (0, 0.9), (1, 0.6), (1, 1.25)]
    variants = [('character', [], everything), ('character', ['--keep-order'], everything),
                ('character', ['--compact'], everything), ('character', ['--lod'], everything),
                ('character', ['--compact', '--lod'], everything), ('character', ['--images=link'], everything[:1]),
                ('character', ['--max-error', '1cm'], everything[:1]), ('character', ['--rig'], everything),
                ('tentacle', [], [(0, 0.7), (1, 1.1)]), ('tentacle', ['--compact'], [(0, 0.7), (1, 1.1)]),
                ('tentacle', ['--compact', '--lod'], [(1, 0.5)]), ('mannequin', ['--compact'], [(0, 0.4), (1, 0.3)])]
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        make_character(scratch / 'character.gltf')
        (scratch / 'character.rig.json').write_text(json.dumps(RIG), encoding='utf-8')
        for what, options, moments in variants:
            source = scratch / 'character.gltf' if what == 'character' else ROOT / 'examples' / (what + '.glb')
            words = ''.join('_' + word.strip('-').replace('=', '_').replace('-', '_') for word in options)
            out = folder / (what + words + '.bendy')
            if options == ['--rig']:
                options = ['--rig', scratch / 'character.rig.json', '--compact']
            run(arguments.bendy, 'convert', '-q', source, '-o', out, *options)
            command = ' '.join(['bendy', 'convert', source.name, *(getattr(word, 'name', word) for word in options)])
            write_poses(arguments.bendy, out, moments, command, scratch)
        for example in sorted((ROOT / 'spec' / 'examples').glob('*.bendy')):
            out = folder / ('spec_' + example.name)
            out.write_bytes(example.read_bytes())
            moments = {'every_chunk': [(0, 0.25), (0, 1)], 'one_joint': []}.get(example.stem)  # the others have no object
            write_poses(arguments.bendy, out, moments, 'spec/make_bytes.py', scratch)
    lines = ['%s  %s\n' % (hashlib.sha256(path.read_bytes()).hexdigest(), path.name) for path in sorted(folder.iterdir())]
    (folder / 'SHA256SUMS').write_text(''.join(lines), encoding='utf-8')
    return 0


if __name__ == '__main__':
    sys.exit(main())
